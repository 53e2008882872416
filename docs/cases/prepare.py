#!/usr/bin/env python3
"""Cuts the public recordings of docs/cases.md to what the unit files in config/cases read.

    prepare.py DATA_FOLDER OUTPUT_FOLDER

Writes a CSV per episode (run, day, house, loop, room), and <case>_<name>.csv where a case has
unseen recordings beside it. The recordings keep their own column names but for `time`, and their
head line with origin and licence.
"""

import csv
import pathlib
import sys


# Cut recording and its number in refinery_loops_A.csv: of each loop the first and the last that has
# no samples in common with it.
REFINERY_A = {
    "refinery_sticking": "20", "refinery_sticking_first": "18",
    "refinery_sound": "3", "refinery_sound_2": "4",
    "refinery_fic10201": "0", "refinery_fic10201_last": "2",
    "refinery_fic40102e": "5", "refinery_fic40102e_last": "6",
    "refinery_lic31102b": "7", "refinery_lic31102b_last": "15",
    "refinery_pic23001": "16",
    "refinery_fic20502": "17",
    "refinery_fic20102": "21", "refinery_fic20102_last": "33",
}


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

    def time(self):
        return self.column("t_s" if "t_s" in self.names else "time")

    def where(self, name, value, first=0, last=None):
        """Rows of the episode whose column `name` is `value`, of these the first..last."""
        return [k for k, of in enumerate(self.column(name)) if of == value][first:last]


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
    time = recording.time()
    columns = [[time[k] if sample_time is None else repr(round(i * sample_time, 9))
                for i, k in enumerate(rows)]]
    for tag in tags:
        values = recording.column(tag)
        columns.append([values[k] for k in rows])
    write(path, recording.comments, tags, columns)


def resample(recording, path, inputs, outputs, sample_time):
    """Inputs as last set, outputs on the line between their neighbours."""
    time = [float(text) for text in recording.time()]
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
    for run in ("mpc_arx", "mpc_ann", "mpc_physics", "pid", "pid2"):
        resample(Recording(data / f"tclab_byu_{run}.csv"), out / f"tclab_{run}.csv", inputs,
                 outputs, 1.0)
    for run in ("steps_3s", "steps_3s_b"):
        resample(Recording(data / f"tclab_byu_{run}.csv"), out / f"tclab_{run}.csv", inputs,
                 outputs, 3.0)
    resample(Recording(data / "tclab_byu_siso_oldfw.csv"), out / "tclab_siso.csv", ["Q1_pwm"],
             ["T1_K"], 1.0)


def tclab_points(data, out):
    """Points at rest have no time: they are counted, and each output stands one row below its
    inputs, for that is where a model sampled once per point has it."""
    recording = Recording(data / "tclab_byu_steadystate.csv")
    inputs, outputs = ["Q1_pct", "Q2_pct"], ["T1_degC", "T2_degC"]
    columns = [[str(k) for k in range(len(recording.rows) + 1)]]
    columns += [recording.column(tag) + [""] for tag in inputs]
    columns += [[""] + recording.column(tag) for tag in outputs]
    comment = "# time counts points; outputs one row below their inputs"
    write(out / "tclab_points.csv", recording.comments + [comment], inputs + outputs, columns)


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
    for name, file in REFINERY_A.items():
        copy(recording, out / f"{name}.csv", ["OP_pct", "PV", "SP"],
             only=recording.where("file", file))


def refinery_2(data, out):
    recording = Recording(data / "refinery_loops.csv")
    for file in range(13):
        copy(recording, out / f"refinery2_{file:02d}.csv", ["OP_pct", "PV", "SP"],
             only=recording.where("file", str(file)))


def hairdryer(data, out):
    copy(Recording(data / "daisy_hairdryer.csv"), out / "hairdryer.csv", ["u_heater_V", "T_air"])


def ahu(data, out):
    """Occupied hours (6 to 18 h) of each day: the fan runs all the time then."""
    recording = Recording(data / "ahu_flexlab.csv")
    occupied = set(recording.where("occupied", "1"))
    for day in range(15):
        copy(recording, out / f"ahu_day{day:02d}.csv",
             ["HC_valve", "CC_valve", "MA_temp_degF", "SA_temp_degF"],
             only=[k for k in recording.where("day", str(day)) if k in occupied])


def pump(data, out):
    """Of the short run 4 less before the event, so that it falls into what is fitted."""
    recording = Recording(data / "pump_loop.csv")
    for run in range(7):
        copy(recording, out / f"pump_run{run}.csv",
             ["motor_V", "flow_l_min", "pressure_bar", "motor_A", "T_water_degC"],
             only=recording.where("run", str(run), 300 if run == 4 else 0))


def rooms(data, out):
    """Of the two rooms whose camera counted for more than a day, the days on which it did."""
    recording = Recording(data / "rooms_co2.csv")
    tags = ["CO2_bms_ppm", "vent_valve", "persons_camera", "T_out_degC", "sun_W_m2"]
    for room, first, last in (("917810", 1348, 1934), ("925038", 0, None), ("999169", 1348, 1934)):
        copy(recording, out / f"room_{room}.csv", tags,
             only=recording.where("room", room, first, last))


def houses(data, out):
    recording = Recording(data / "houses_nl.csv")
    for house in ("1", "2", "3"):
        copy(recording, out / f"house_{house}.csv", ["heating", "T_out_degC", "sun", "T_in_degC"],
             only=recording.where("house", house))


def wall(data, out):
    """The heat flow answers the temperatures of its own row; it stands one row below them, for that
    is where a model sampled once per row has it."""
    recording = Recording(data / "wall_heatflow.csv")
    inputs = ["T_inside_degC", "T_outside_degC"]
    columns = [[str(k) for k in range(len(recording.rows))]]
    columns += [recording.column(tag) for tag in inputs]
    columns += [[""] + recording.column("heat_flow")[:-1]]
    comment = "# heat flow one row below its inputs"
    write(out / "wall.csv", recording.comments + [comment], inputs + ["heat_flow"], columns)


def whole(name, *tags):
    """A recording that is one episode."""
    def cut(data, out):
        copy(Recording(data / f"{name}.csv"), out / f"{name}.csv", list(tags))
    cut.__name__ = name
    return cut


def tclab_setpoint(data, out):
    recording = Recording(data / "tclab_uw_setpoint.csv")
    for run in ("0", "4", "7"):
        copy(recording, out / f"tclab_setpoint_{run}.csv",
             ["Q1_pct", "Q2_pct", "T1_degC", "T2_degC", "T1_sp", "T2_sp"],
             only=recording.where("run", run))


def tennessee_eastman(data, out):
    recording = Recording(data / "tep_runs.csv")
    for fault in ("0", "1", "2", "8", "10", "11", "17", "20"):
        copy(recording, out / f"tep_idv{int(fault):02d}.csv",
             ["xmv9", "xmv10", "xmeas18", "xmeas21"], only=recording.where("idv", fault))


def isdb(data, out):
    recording = Recording(data / "isdb_loops.csv")
    for loop in dict.fromkeys(recording.column("loop")):
        copy(recording, out / f"isdb_{loop.lower()}.csv", ["OP", "PV"],
             only=recording.where("loop", loop))


CASES = (
    tclab, tclab_points, heating_lamp, silverbox, cascaded_tanks, varennes, refinery, hairdryer,
    ahu, pump, rooms, houses,
    whole("heat_exchanger", "q_liquid", "T_out_degC"),
    wall,
    whole("evaporator", "u1_feed_flow", "u2_vapour_flow", "u3_cooling_water_flow", "y1_dry_matter",
          "y2_product_flow", "y3_product_temp"),
    whole("industrial_dryer", "u1_fuel_flow", "u2_fan_speed", "u3_raw_material_flow",
          "y1_dry_bulb_temp", "y2_wet_bulb_temp", "y3_moisture"),
    whole("tclab_uw_prbs", "Q1_pct", "Q2_pct", "T1_degC", "T2_degC"),
    tclab_setpoint, tennessee_eastman, isdb, refinery_2)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if not data.is_dir():
        sys.exit(f"{data}: no such folder")
    out.mkdir(parents=True, exist_ok=True)
    for case in CASES:
        try:
            case(data, out)
        except FileNotFoundError as missing:
            print(f"{case.__name__}: skipped, {missing.filename} is not there", file=sys.stderr)


if __name__ == "__main__":
    main()
