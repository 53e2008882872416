#!/usr/bin/python3
"""How soon `mpm detect` alarms of an error that begins, or comes and goes, on foreign plants.

Usage: change.py --mpm build/release/bin/mpm --seeds 100001-100004 [--plant P ...] [--effect E ...]
                 [--regime R] [--jobs 1] [--markdown FILE] [--json FILE]

loop.py makes recordings of 9000 samples in which one channel's gain, dead time or time constants
are off as effects.py draws them (by what one would notice). With `begins` the channel is off from
sample 4000 on; with `comes and goes` from 3000 to 4500 and from 6000 to 7500. What the channel
reads changes at once. Seeds below 1000 are for scores, from 100001 on for tuning. Every other
channel is exactly the model's.

* found: runs with an alarm on the wrong channel while the error is there or up to 1500 samples
  after; with the interval of Wilson (1927).
* samples to it: from the first sample with the error; median and quartiles.
* cleared: of the alarms on it, those that were cleared before the end, where the error goes.
* before: alarms before there was any error. On others: alarms on right channels from then on.
"""
import argparse
import concurrent.futures
import json
import pathlib
import statistics
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    raise SystemExit("change.py: needs numpy (python3-numpy)") from None

import loop
from plants import PLANTS
from regimes import REGIMES
from score import run, seed_list
from tables import replace_part, wilson

SAMPLES = 9000
KINDS = {"begins": ((4000, SAMPLES),), "comes and goes": ((3000, 4500), (6000, 7500))}
LATE = 1500  # samples after its end in which an error is still found


def one(mpm, regime, plant, effect, kind, seed):
    stretches = KINDS[kind]
    present = np.zeros(SAMPLES, bool)
    for first, end in stretches:
        present[first:end] = True
    with tempfile.TemporaryDirectory() as folder:
        truth = loop.write(regime, plant, effect, seed, SAMPLES, folder, 0.0, present=present)
        folder = pathlib.Path(folder)
        code, output, _ = run(mpm, ["detect", "--config", folder / "unit.yaml", "--data",
                                    folder / "data.csv", "--json"])
    case = {"plant": plant, "effect": effect, "kind": kind, "seed": seed,
            "failed": code not in (0, 1), "found": None, "before": 0, "others": 0, "raised": 0,
            "cleared": 0}
    if case["failed"]:
        return case
    for alarm in json.loads(output)["alarms"]:
        at = alarm["time"] / truth["sample_time"]
        mine = (alarm["mv"], alarm["cv"]) == (truth["mv"], truth["cv"])
        if alarm["to"] != "active":
            case["cleared"] += mine and at >= stretches[0][0]
        elif at < stretches[0][0]:
            case["before"] += 1
        elif not mine:
            case["others"] += 1
        else:
            case["raised"] += 1
            in_time = any(first <= at < end + LATE for first, end in stretches)
            if in_time and case["found"] is None:
                case["found"] = at - stretches[0][0]
    return case


def row(name, kind, cases):
    found = [c["found"] for c in cases if c["found"] is not None]
    low, high = wilson(len(found), len(cases))
    quartiles = statistics.quantiles(found, n=4) if len(found) > 1 else found * 3
    delay = (f"{statistics.median(found):.0f} ({quartiles[0]:.0f} to {quartiles[2]:.0f})"
             if found else "")
    total = {key: sum(c[key] for c in cases) for key in ("before", "others", "raised", "cleared")}
    cleared = f"{total['cleared']} of {total['raised']}" if kind != "begins" else ""
    return (f"| {name} | {kind} | {len(found)} of {len(cases)} ({100 * low:.0f}-{100 * high:.0f} %)"
            f" | {delay} | {cleared} | {total['before']} | {total['others']} |")


def rows(cases):
    yield ("| plant | error | found | samples to it | cleared | alarms before | alarms on others |")
    yield "|---|---|---|---|---|---|---|"
    for kind in KINDS:
        of_kind = [c for c in cases if c["kind"] == kind]
        for plant in dict.fromkeys(c["plant"] for c in of_kind):
            yield row(plant, kind, [c for c in of_kind if c["plant"] == plant])
        for effect in dict.fromkeys(c["effect"] for c in of_kind):
            yield row(f"all, {effect.replace('_', ' ')}", kind,
                      [c for c in of_kind if c["effect"] == effect])
        yield row("all", kind, of_kind)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mpm", required=True)
    parser.add_argument("--seeds", type=seed_list, required=True)
    parser.add_argument("--regime", choices=REGIMES, default="stationary")
    parser.add_argument("--plant", nargs="+", choices=list(PLANTS), default=list(PLANTS))
    parser.add_argument("--effect", nargs="+", choices=["gain", "dead_time", "time_constant"],
                        default=["gain", "dead_time", "time_constant"])
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--markdown")
    parser.add_argument("--json")
    args = parser.parse_args()
    wanted = [(args.mpm, args.regime, plant, effect, kind, seed) for seed in args.seeds
              for plant in args.plant for effect in args.effect for kind in KINDS]
    cases = []
    with concurrent.futures.ProcessPoolExecutor(args.jobs) as pool:
        for case in pool.map(one, *zip(*wanted)):
            cases.append(case)
            print(f"\rforeign plants: {len(cases)} of {len(wanted)} runs", end="", file=sys.stderr)
    print(file=sys.stderr)
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps(cases, indent=1) + "\n")
    table = list(rows([c for c in cases if not c["failed"]]))
    print("\n".join(table))
    if args.markdown:
        path = pathlib.Path(args.markdown)
        path.write_text(replace_part(path.read_text(), "foreign_changes", table))
    failed = [c for c in cases if c["failed"]]
    if failed:
        sys.exit(f"change.py: {len(failed)} runs failed, the first: {failed[0]}")


if __name__ == "__main__":
    main()
