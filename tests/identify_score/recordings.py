#!/usr/bin/python3
"""What `mpm identify` makes of measured plants, beside the models that docs/cases/fit_first.py fits.

Usage: recordings.py --bin build/release/bin CUT_FOLDER [UNIT...]

CUT_FOLDER holds what docs/cases/prepare.py wrote. Each unit of docs/cases/units.py is identified
from the part of its recordings that fit_first.py sees, from a unit file without a model; the free
run is judged on the part that neither sees, as fit_first.py does (first state fitted on the first
50 samples, or on a window's first). `first` is the error in the head of config/cases.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs" / "cases"))
import fit_first  # noqa: E402
from responses import step_of  # noqa: E402
from units import UNITS  # noqa: E402


def first_errors(unit):
    text = (ROOT / "config" / "cases" / f"{unit.name}.yaml").read_text()
    head = " ".join(line[2:] for line in text.splitlines() if line.startswith("# "))
    return {tag: float(value)
            for tag, value in re.findall(r"(\S+) [-\d.e]+ there, ([-\d.e]+) unseen", head)}


def write_part(cut, name, share, out):
    lines = [line for line in (cut / f"{name}.csv").read_text().splitlines()
             if not line.startswith("#")]
    out.write_text("\n".join(lines[:1 + int(share * (len(lines) - 1))]) + "\n")


def identify(unit, cut, bin_folder):
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "unit.yaml").write_text("\n".join(
            [f"unit: {unit.name}", f"sample_time: {unit.sample_time:g}"] +
            [line for line in fit_first.signal_lines(unit)]) + "\n")
        data = []
        for number, (name, share) in enumerate(unit.fit):
            data.append(folder / f"{number}.csv")
            write_part(cut, name, share, data[-1])
        done = subprocess.run([bin_folder / "mpm", "identify", "--config", folder / "unit.yaml",
                               "--data", *data, "--out", folder / "new.yaml", "--json"],
                              capture_output=True, text=True)
        if done.returncode not in (0, 1):
            return None, done.stderr.strip()
        origin = {}
        if done.returncode == 0:
            point = re.search(r"operating_point: \{(.*)\}", (folder / "new.yaml").read_text())[1]
            origin = {k.strip(): float(v) for k, v in
                      (entry.rsplit(":", 1) for entry in point.split(","))}
        return (json.loads(done.stdout), origin), ""


def free_run(unit, cv, channels, origin, episode):
    """Each input's moves times the step response; at rest at its first value."""
    n = len(episode.output)
    time = np.arange(n) * unit.sample_time
    y = np.full(n, origin[cv])
    for i, tag in enumerate(unit.inputs_of(cv)):
        for channel in channels:
            if channel["cv"] != cv or channel["mv"] != tag:
                continue
            u = episode.inputs[:, i] + unit.centre[tag] - origin[tag]
            step = step_of(channel, time)
            moves = np.diff(u, prepend=u[0])
            size = 1 << (2 * n - 1).bit_length()
            y += np.fft.irfft(np.fft.rfft(step, size) * np.fft.rfft(moves, size), size)[:n]
            if not channel["integrating"]:
                y += channel["gain"] * u[0]
    return y


def error_of(unit, cv, channels, origin, episodes):
    found = []
    lags = [t for c in channels if c["cv"] == cv for t in c["time_constants"]]
    lags += [c["damped_pair"]["time"] / c["damped_pair"]["damping"] for c in channels
             if c["cv"] == cv and "damped_pair" in c]
    lags = sorted(set(lags), reverse=True)[:2] or [unit.sample_time]
    for episode in episodes:
        error = episode.output - free_run(unit, cv, channels, origin, episode)
        transients = episode.transients(lags, unit.sample_time)
        head = np.flatnonzero(episode.known)[:1 if unit.window else fit_first.SETTLING_SAMPLES]
        state = np.linalg.lstsq(transients[head], error[head], rcond=1e-6)[0]
        found.append((error - transients @ state)[episode.known])
    return float(np.sqrt(np.mean(np.concatenate(found) ** 2)))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("cut", type=pathlib.Path)
    parser.add_argument("units", nargs="*")
    args = parser.parse_args()
    print("| unit | CV | s.d. unseen | first | identified | channels, what was left out |")
    print("|---|---|---|---|---|---|")
    for unit in UNITS:
        if args.units and unit.name not in args.units:
            continue
        answer, problem = identify(unit, args.cut, args.bin.resolve())
        if answer is None:
            print(f"| {unit.name} | | | | | {problem} |", flush=True)
            continue
        report, origin = answer
        recordings = [fit_first.read(args.cut / f"{name}.csv") for name, _ in unit.fit]
        unit.centre = {tag: np.nanmean(np.concatenate([c[tag] for c in recordings]))
                       for tag in unit.inputs}
        first = first_errors(unit)
        for cv in unit.cv:
            mine = [c for c in report["channels"] if c["cv"] == cv]
            kept = [c for c in mine if c["in_model"]]
            said = "; ".join(
                f"{c['mv']}: " + (f"{c['gain']:.3g}, {c['form']} T {[round(t, 1) for t in c['time_constants']]}"
                                  f" L {c['dead_time']:.3g}" + (" lead" if c["lead"] else "") +
                                  (" integrates" if c["integrating"] else "")
                                  if c["in_model"] else c["reason"]) for c in mine)
            unseen = fit_first.episodes_of(unit, args.cut, cv, unit.unseen)
            error, spread = "-", "-"
            if unseen:
                everything = np.concatenate([e.output[e.known] for e in unseen])
                spread = f"{np.std(everything):.3g}"
                if kept:
                    error = f"{error_of(unit, cv, kept, origin, unseen):.3g}"
            print(f"| {unit.name} | {cv} | {spread} | {first.get(cv, float('nan')):.3g} | {error} "
                  f"| {said} |", flush=True)


if __name__ == "__main__":
    main()
