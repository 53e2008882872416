#!/usr/bin/python3
"""Whether the gains that `mpm identify` finds in sound runs of the plants of physical.py hold.

Usage: physical_gains.py --mpm build/release/bin/mpm --seeds 100101-100102 [--plant P ...]

From tags alone, under feedback. The truth is the plant's gain at the mean inputs of the recording,
by steps there. Seeds below 1000 are for scores, from 100001 on for tuning.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from physical import HORIZON, Run
from physical_plants import PHYSICAL, responses
from score import seed_list


def identified(mpm, folder):
    """(cv, mv): 95 % interval of the gain."""
    unit = folder / "unit.yaml"
    unit.write_text(unit.read_text().split("model:\n")[0])
    done = subprocess.run(
        [mpm, "identify", "--config", unit, "--data", folder / "data.csv", "--out",
         folder / "new.yaml", "--threads", "1", "--json"], capture_output=True, text=True)
    if done.returncode > 1:
        raise RuntimeError(done.stderr[-400:])
    return {(c["cv"], c["mv"]): c["interval"]["gain"]
            for c in json.loads(done.stdout)["channels"] if c["in_model"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mpm", required=True)
    parser.add_argument("--seeds", default="100101-100102")
    parser.add_argument("--plant", nargs="+", default=["four_tanks", "reactor", "evaporator",
                                                       "heater", "column"])
    options = parser.parse_args()
    told = held = turned = 0
    for make in PHYSICAL:
        plant = make()
        if plant.name not in options.plant:
            continue
        for seed in seed_list(options.seeds):
            for case in ("healthy", "far"):
                run = Run(plant, case, seed, "reduced")
                true, _ = responses(plant, run.inputs.mean(axis=0), plant.numbers, HORIZON)
                with tempfile.TemporaryDirectory() as scratch:
                    run.write(pathlib.Path(scratch))
                    gains = identified(options.mpm, pathlib.Path(scratch))
                words = []
                for (cv, mv), (low, high) in gains.items():
                    gain = true[-1, plant.cvs.index(cv), (plant.mvs + plant.dvs).index(mv)]
                    told += 1
                    held += low <= gain <= high
                    turned += low * gain < 0.0 and high * gain < 0.0
                    words.append(f"{cv}/{mv} {low / gain:.2f}..{high / gain:.2f}")
                print(f"{plant.name} {case} {seed}: {', '.join(words) or 'nothing'}", flush=True)
    print(f"{told} gains, {held} in their interval, {turned} of the wrong sign for sure")


if __name__ == "__main__":
    main()
