#!/usr/bin/python3
"""What `mpm identify` makes of plants that it was not made with: DaISy (De Moor, Database for the
Identification of Systems, KU Leuven), which is no part of the project.

Usage: daisy.py --bin build/release/bin FOLDER

FOLDER holds the .dat files as they are published; those that are missing are skipped, loudly. Each
plant is identified from tags alone and its first three quarters. On the last quarter, which
`mpm identify` has not been given, the free run of its model stands beside that of the best of 25
linear models fitted to the same rows: ridge regressions on past inputs and one-CV ARX models, of
which the one that does best on that last quarter is taken: what such a model could know at most.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from responses import answer

# name: sample time in s, first column, inputs, CVs, rows that the inputs are moved up by
PLANTS = {
    "steamgen": (3, 1, ["fuel", "air", "level_ref", "load"],
                 ["pressure", "o2", "level", "steam"], 0),
    "cstr": (6, 1, ["coolant"], ["concentration", "temperature"], 0),
    "glassfurnace": (60, 1, ["u1", "u2", "u3"], ["y1", "y2", "y3", "y4", "y5", "y6"], 1),
    "powerplant": (1228.8, 1, ["gas", "turbine", "superspray", "dampers", "airflow"],
                   ["steam_pressure", "main_steam_temp", "reheat_temp"], 0),
    "pHdata": (10, 1, ["acid", "base"], ["pH"], 0),
}
UNSEEN = 0.25


def lagged(values, first, last):
    rows = len(values)
    return np.hstack([np.vstack([np.zeros((lag, values.shape[1])), values[:rows - lag]])
                      for lag in range(first, last + 1)])


def rms(values):
    return float(np.sqrt(np.mean(values ** 2)))


def best_linear(inputs, cv, cut):
    inputs, cv = inputs - inputs[:cut].mean(0), cv - cv[:cut].mean()
    errors = []
    for lags in (10, 20, 40, 80):
        past = lagged(inputs, 1, lags)
        if cut < 3 * past.shape[1]:
            break
        seen = past[lags:cut]
        for ridge in (0.1, 1, 10, 100, 1000):
            weight = ridge * seen.std() ** 2 * np.eye(past.shape[1])
            found = np.linalg.solve(seen.T @ seen + weight, seen.T @ cv[lags:cut])
            errors.append(rms(cv[cut:] - past[cut:] @ found))
    for order in (1, 2, 3, 5, 8):
        past = np.hstack([lagged(cv[:, None], 1, order), lagged(inputs, 1, order)])
        found = np.linalg.lstsq(past[order:cut], cv[order:cut], rcond=None)[0]
        free = np.zeros(len(cv))
        for k in range(order, len(cv)):
            row = np.concatenate([free[k - order:k][::-1], past[k, order:]])
            free[k] = np.clip(row @ found, -1e9, 1e9)
        errors.append(rms(cv[cut:] - free[cut:]))
    return min(errors)


def identify(name, inputs, cvs, plant, binary):
    sample_time, _, input_tags, cv_tags, _ = plant
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        table = np.column_stack([sample_time * np.arange(len(inputs)), inputs, cvs])
        np.savetxt(folder / "data.csv", table, delimiter=",", fmt="%.10g", comments="",
                   header=",".join(["time", *input_tags, *cv_tags]))
        (folder / "unit.yaml").write_text(
            f"unit: {name}\nsample_time: {sample_time}\nsignals:\n"
            f"  mv: [{', '.join(input_tags)}]\n  cv: [{', '.join(cv_tags)}]\n")
        done = subprocess.run([binary / "mpm", "identify", "--config", folder / "unit.yaml",
                               "--data", folder / "data.csv", "--out", folder / "new.yaml",
                               "--json"], capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            sys.exit(f"{name}: {done.stderr}")
        return json.loads(done.stdout)


def free_run(found, cv, input_tags, inputs, sample_time):
    """From rest at the operating point, as deviations."""
    result = np.zeros(len(inputs))
    for channel in found["channels"]:
        if channel["cv"] == cv and channel["in_model"]:
            moved = inputs[:, input_tags.index(channel["mv"])] - \
                found["operating_point"][channel["mv"]]
            result += answer(channel, np.diff(moved, prepend=0.0), sample_time)
    return result


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--bin", type=pathlib.Path, required=True)
    arguments.add_argument("folder", type=pathlib.Path)
    options = arguments.parse_args()
    print("| plant | CV | s.d. unseen | best linear | identified | channels |")
    print("|---|---|---|---|---|---|")
    for name, plant in PLANTS.items():
        path = options.folder / f"{name}.dat"
        if not path.exists():
            print(f"SKIPPED: {path} is not there", file=sys.stderr)
            continue
        _, first, input_tags, cv_tags, up = plant
        data = np.loadtxt(path)[:, first:]
        inputs, cvs = data[up:, :len(input_tags)], data[:, len(input_tags):]
        inputs, cvs = inputs, cvs[:len(inputs), :len(cv_tags)]
        cut = int(round((1 - UNSEEN) * len(cvs)))
        found = identify(name, inputs[:cut], cvs[:cut], plant, options.bin)
        for cv in range(len(cv_tags)):
            own = [each for each in found["channels"] if each["cv"] == cv_tags[cv]]
            said = [each["mv"] for each in own if each["in_model"]]
            error = "left out"
            if said:
                run = free_run(found, cv_tags[cv], input_tags, inputs, plant[0])
                left = cvs[:, cv] - run
                error = f"{rms(left[cut:] - left[:cut].mean()):.3g}"  # at the level of the rest
            print(f"| {name} | {cv_tags[cv]} | {cvs[cut:, cv].std():.3g} "
                  f"| {best_linear(inputs, cvs[:, cv], cut):.3g} | {error} "
                  f"| {', '.join(said) or '-'} |")


if __name__ == "__main__":
    main()
