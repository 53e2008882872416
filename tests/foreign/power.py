#!/usr/bin/python3
"""What `mpm detect` finds on foreign plants, beside what the best possible test could.

Usage: power.py --mpm build/release/bin/mpm --seeds 100001-100004 [--regime R ...] [--plant P ...]
                [--effect E ...] [--samples 3000] [--model-error 1] [--jobs 1] [--keep DIR]
                [--json FILE]

loop.py makes the recordings, and says of each error how much the best possible test would have to
go by (noncentrality, all that errors of the other channels could do taken out). Each plant runs
with each effect (default: none, gain, dead_time, time_constant) at each seed. Seeds below 1000 are
for scores, from 100001 on for tuning. --model-error 0: channels that are not wrong are exactly
what the model says, so that every one called a mismatch is an error of the test. Tables, shares
with Wilson's 95 % interval (1927):
* per noncentrality: found = a channel that is wrong called a mismatch; undetermined = none found,
  and the wrong channel undetermined; missed = it is called a match.
* per plant: healthy channels called a mismatch, undetermined, and their alarms.
"""
import argparse
import concurrent.futures
import json
import pathlib
import sys
import tempfile

import loop
from effects import EFFECTS
from judge import judge
from plants import PLANTS
from regimes import REGIMES
from score import run
from tables import wilson

BINS = ((0, 20), (20, 40), (40, 100), (100, 400), (400, float("inf")))


def one(mpm, regime, plant, effect, seed, samples, model_error, keep):
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(keep or temporary) / f"{regime}-{plant}-{effect}-{seed}"
        truth = loop.write(regime, plant, effect, seed, samples, folder, model_error)
        code, output, seconds = run(mpm, ["detect", "--config", folder / "unit.yaml", "--data",
                                          folder / "data.csv", "--json"])
    case = {"regime": regime, "plant": plant, "effect": effect, "seed": seed,
            "noncentrality": truth["noncentrality"], "seconds": seconds,
            "failed": code not in (0, 1)}
    if case["failed"]:
        return case
    answer = json.loads(output)
    wrong, healthy, accused = [], [], set()
    for channel in answer["channels"]:
        finding = {"cause": "gain", "cv": channel["cv"], "mv": channel["mv"], "parameters": {}}
        guilty = judge(finding, {**truth, "others": []}) in ("right", "place")
        (wrong if guilty else healthy).append(
            [channel["mv"], channel["cv"], channel["verdict"], channel.get("reason", ""),
             channel["p_value"]])
        if not guilty:
            accused.add((channel["mv"], channel["cv"]))
    alarms = {(a["mv"], a["cv"]) for a in answer["alarms"] if a["to"] == "active"}
    case.update(wrong=wrong, healthy=healthy, false_alarms=sorted(alarms & accused),
                right_alarms=sorted(alarms - accused))
    return case


def share(part, whole):
    if whole == 0:
        return "-"
    low, high = wilson(part, whole)
    return f"{part}/{whole} ({100 * low:.0f}-{100 * high:.0f} %)"


def power_rows(cases):
    yield "| noncentrality | found | undetermined | missed | in an alarm |"
    yield "|---|---|---|---|---|"
    for low, high in BINS:
        chosen = [c for c in cases if c["effect"] != "none" and low <= c["noncentrality"] < high]
        count = len(chosen)
        found = [any(w[2] == "mismatch" for w in c["wrong"]) for c in chosen]
        open_ = [not f and any(w[2] == "undetermined" for w in c["wrong"])
                 for f, c in zip(found, chosen)]
        alarmed = sum(bool(c["right_alarms"]) for c in chosen)
        yield (f"| {low:g} to {high:g} | {share(sum(found), count)} | {share(sum(open_), count)} | "
               f"{share(count - sum(found) - sum(open_), count)} | {share(alarmed, count)} |")


def false_rows(cases, key):
    yield f"| {key} | healthy channels | called a mismatch | undetermined | false alarms | runs |"
    yield "|---|---|---|---|---|---|"
    for name in dict.fromkeys(c[key] for c in cases):
        chosen = [c for c in cases if c[key] == name]
        healthy = [h for c in chosen for h in c["healthy"]]
        false = sum(h[2] == "mismatch" for h in healthy)
        open_ = sum(h[2] == "undetermined" for h in healthy)
        alarms = sum(len(c["false_alarms"]) for c in chosen)
        yield (f"| {name} | {len(healthy)} | {share(false, len(healthy))} | "
               f"{share(open_, len(healthy))} | {alarms} | {len(chosen)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mpm", required=True)
    parser.add_argument("--seeds", default="100001-100004")
    parser.add_argument("--regime", nargs="+", choices=REGIMES, default=["stationary"])
    parser.add_argument("--plant", nargs="+", choices=list(PLANTS), default=list(PLANTS))
    parser.add_argument("--effect", nargs="+", choices=EFFECTS,
                        default=["none", "gain", "dead_time", "time_constant"])
    parser.add_argument("--samples", type=int, default=3000)
    parser.add_argument("--model-error", type=float, default=1.0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("--json")
    args = parser.parse_args()
    first, _, last = args.seeds.partition("-")
    wanted = [(args.mpm, regime, plant, effect, seed, args.samples, args.model_error,
               args.keep)
              for seed in range(int(first), int(last or first) + 1) for regime in args.regime
              for plant in args.plant for effect in args.effect
              if not (effect == "aux" and regime == "aux_disturbance")]
    with concurrent.futures.ProcessPoolExecutor(args.jobs) as pool:
        cases = list(pool.map(one, *zip(*wanted)))
    failed = [c for c in cases if c["failed"]]
    cases = [c for c in cases if not c["failed"]]
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps(cases, indent=1) + "\n")
    lines = list(power_rows(cases)) + [""]
    lines += list(false_rows(cases, "plant")) + [""] + list(false_rows(cases, "regime"))
    print("\n".join(lines))
    if failed:
        sys.exit(f"power.py: {len(failed)} runs failed, the first: {failed[0]}")


if __name__ == "__main__":
    main()
