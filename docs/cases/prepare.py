#!/usr/bin/env python3
"""Cuts the public recordings of docs/cases.md to what the unit files in config/cases read.

    prepare.py DATA_FOLDER OUTPUT_FOLDER

Writes <case>.csv, and <case>_<name>.csv where a case has unseen recordings beside it. The recordings
keep their own column names but for `time`, and their head line with origin and licence.
"""

import csv
import pathlib
import sys


class Recording:
    """Columns of numbers by name, and the comment lines above them."""

    def __init__(self, path):
        with open(path, newline="") as file:
            lines = file.read().splitlines()
        self.comments = [line for line in lines if line.startswith("#")]
        rows = csv.reader(line for line in lines if line and not line.startswith("#"))
        self.names = next(rows)
        self.rows = list(rows)

    def column(self, name):
        at = self.names.index(name)
        return [row[at] for row in self.rows]


def write(path, comments, names, columns):
    with open(path, "w", newline="") as file:
        for comment in comments:
            file.write(comment + "\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["time"] + names)
        writer.writerows(zip(*columns))


def copy(recording, path, tags, first=0, last=None, sample_time=None, only=None):
    """Rows first..last, or those that `only` takes, at their own or at regular times."""
    rows = range(len(recording.rows))[first:last] if only is None else only
    time = recording.column("t_s")
    columns = [[time[k] if sample_time is None else repr(round(i * sample_time, 9))
                for i, k in enumerate(rows)]]
    for tag in tags:
        values = recording.column(tag)
        columns.append([values[k] for k in rows])
    write(path, recording.comments, tags, columns)


def resample(recording, path, inputs, outputs, sample_time):
    """Inputs as last set, outputs on the line between their neighbours."""
    time = [float(text) for text in recording.column("t_s")]
    count = int(time[-1] / sample_time) + 1
    grid = [k * sample_time for k in range(count)]
    before = []
    at = 0
    for t in grid:
        while at + 1 < len(time) and time[at + 1] <= t + 1e-9:
            at += 1
        before.append(at)
    columns = [[repr(round(t, 9)) for t in grid]]
    for tag in inputs:
        values = recording.column(tag)
        columns.append([values[i] for i in before])
    for tag in outputs:
        values = [float(text) for text in recording.column(tag)]
        line = []
        for t, i in zip(grid, before):
            j = min(i + 1, len(time) - 1)
            share = (t - time[i]) / (time[j] - time[i]) if j > i else 0.0
            line.append(f"{values[i] + share * (values[j] - values[i]):.4f}")
        columns.append(line)
    comment = f"# resampled to {sample_time} s: inputs held, outputs interpolated"
    write(path, recording.comments + [comment], inputs + outputs, columns)


def tclab(data, out):
    inputs, outputs = ["Q1_pct", "Q2_pct"], ["T1_degC", "T2_degC"]
    copy(Recording(data / "tclab_byu_steps_1s.csv"), out / "tclab_steps.csv", inputs + outputs)
    copy(Recording(data / "tclab_byu_validation.csv"), out / "tclab.csv", inputs + outputs)
    for run in ("arx", "ann", "physics"):
        resample(Recording(data / f"tclab_byu_mpc_{run}.csv"), out / f"tclab_mpc_{run}.csv", inputs,
                 outputs, 1.0)


def heating_lamp(data, out):
    copy(Recording(data / "daisy_heating_lamp.csv"), out / "heating_lamp.csv",
         ["u_drive_V", "T_plate_degC"])


def silverbox(data, out):
    """The multisine, of which the model saw the first 16000 samples here; one further on; the sweep
    with growing amplitude, which reaches beyond what either covers. Their times are rounded."""
    recording = Recording(data / "silverbox.csv")
    tags, sample_time = ["u_V", "y_V"], 0.0016384
    copy(recording, out / "silverbox.csv", tags, 41000, 57000, sample_time)
    copy(recording, out / "silverbox_multisine.csv", tags, 110000, 127000, sample_time)
    copy(recording, out / "silverbox_arrow.csv", tags, 0, 40400, sample_time)


def cascaded_tanks(data, out):
    for name, part in (("cascaded_tanks", "est"), ("cascaded_tanks_val", "val")):
        copy(Recording(data / f"cascaded_tanks_{part}.csv"), out / f"{name}.csv", ["u_V", "y_V"])


def varennes(data, out):
    copy(Recording(data / "varennes_building.csv"), out / "varennes.csv",
         ["heating_total", "T_int", "T_ext", "GHI", "DNI", "DHI", "cons_noHVAC"])


def refinery(data, out):
    """One recording of a loop each; the file holds them one below the other."""
    recording = Recording(data / "refinery_loops_A.csv")
    files = recording.column("file")
    for name, file in (("refinery_sticking", "20"), ("refinery_sound", "3"),
                       ("refinery_sound_2", "4")):
        copy(recording, out / f"{name}.csv", ["OP_pct", "PV", "SP"],
             only=[k for k, of in enumerate(files) if of == file])


def hairdryer(data, out):
    copy(Recording(data / "daisy_hairdryer.csv"), out / "hairdryer.csv", ["u_heater_V", "T_air"])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if not data.is_dir():
        sys.exit(f"{data}: no such folder")
    out.mkdir(parents=True, exist_ok=True)
    for case in (tclab, heating_lamp, silverbox, cascaded_tanks, varennes, refinery, hairdryer):
        try:
            case(data, out)
        except FileNotFoundError as missing:
            print(f"{case.__name__}: skipped, {missing.filename} is not there", file=sys.stderr)


if __name__ == "__main__":
    main()
