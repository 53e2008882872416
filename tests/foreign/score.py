#!/usr/bin/python3
"""How well `mpm diagnose` does on foreign plants, in regimes where it is hard.

Usage: score.py --mpm build/release/bin/mpm --seeds 100001-100006 [--regime R ...] [--plant P ...]
                [--effect E ...] [--per-seed 3] [--detect] [--jobs 1] [--keep DIR]
                [--markdown FILE] [--json FILE] [--add FILE ...] [--bounds]
                [--diagram FILE.svg]

loop.py makes the recordings. For each regime and seed `--per-seed` plants come by turns; each runs
healthy and with one effect, by turns too (--effect: with each of these instead). Seeds below 1000
are for scores, from 100001 on for tuning. --keep leaves each case in DIR/REGIME-PLANT-EFFECT-SEED:
what loop.py wrote, and the report in out/. --add takes in the cases of earlier --json files. A
run may take 60 s of CPU time. --bounds: exit 1 where the scores lie beyond what is claimed (tables.py).

A finding is
* right: right family of cause and right signals. `dynamics` with the wrong parameter among its own
  is right; so is input_scale (output_scale) for the gain of an input's (a CV's) only channel, and
  the other way round; a deadband for stiction; gains of all channels of an input (a CV) for its
  scale. What the regime itself does (a disturbance, a measured input that the model leaves out)
  may be named rightly too.
* of the right place: accuses what is wrong, of something else; or names a disturbance of a CV that
  a stuck or shifted input drives.
* slight: errors of at most 5 % of gain, 10 % of time and one sample. All channels are off by up to
  2 and 3 %, so that this is neither right nor wrong.
* wrong: accuses (gain, dead_time, time_constant, dynamics, input_scale, output_scale,
  input_nonlinearity, stiction, state_nonlinearity, input_stuck, input_offset) a channel, an input
  or a CV with which nothing is wrong.
* else: names a disturbance, noise or input that is not there.

Tables, per regime and in all; shares with the 95 % interval of Wilson (1927):
* healthy: accused = runs with a wrong finding.
* faulty, of effects that the best possible test would see (noncentrality > 100; what that flatters
  is said in loop.py): right (any finding), first (the first one), place (none right but the place),
  undetermined (that verdict, none right or of the place), silent (the rest but for wrong ones),
  wrong (a wrong finding among them, whatever else is right: so shares may sum to more than 1).
* farther: the repaired model is farther from the true plant than the given one, by more than 0.05:
  sum over channels of |step - true| / |true|, Euclidean norms up to settling; blocks count by their
  slope over the recording. Far: by more than 0.25. Of all runs, healthy, weak and strong.
* stated: of the findings with confidence in a range, how many are right: those that accuse; all.
* CPU seconds of a run.
"""
import argparse
import concurrent.futures
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
except ImportError:
    raise SystemExit("score.py: needs numpy (python3-numpy)") from None

import loop
from diagram import diagram
from effects import EFFECTS
from judge import gains_make_scale, judge
from model_reader import model_steps
from plants import PLANTS
from regimes import REGIMES
from tables import FARTHER, beyond, reliability, summary, tables

UNEXCITED = ("not_excited", "collinear", "constrained", "controller_off")
TIME_LIMIT = 60  # s of CPU time, and ten times that on the clock
# Turns of 13, so that every plant meets every effect; gain and dead time twice.
TURNS = ["gain", "dead_time", "output_scale", "time_constant", "input_scale", "stiction", "gain",
         "aux", "input_stuck", "output_step", "dead_time", "input_offset", "output_drift"]


def cases(regimes, seeds, plants, effects, per_seed):
    result = []
    for regime in regimes:
        number = REGIMES.index(regime)
        for seed in seeds:
            for turn in range(min(per_seed, len(plants))):
                plant = plants[(seed + number + 2 * turn + (seed + turn) // 6) % len(plants)]
                chosen = effects
                if not chosen:
                    chosen = ["none", TURNS[(per_seed * seed + turn + 5 * number) % len(TURNS)]]
                for effect in chosen:
                    if effect == "aux" and regime == "aux_disturbance":
                        effect = "gain"  # that regime's signal acts already
                    if (regime, plant, effect, seed) not in result:
                        result.append((regime, plant, effect, seed))
    return result


def distances(folder, truth, extended):
    """Of the given and of the repaired model from the true plant; the channel that got worst."""
    table = np.genfromtxt(folder / "data.csv", delimiter=",", names=True)
    inputs = {name: table[name] for name in table.dtype.names}
    stride = truth["stride"]
    points = len(truth["channels"][0]["plant"])
    steps = model_steps(extended, truth["sample_time"], (points - 1) * stride + 1, inputs)
    before = after = most = 0.0
    worst = None
    for channel in truth["channels"]:
        ratio = truth["input_gains"].get(channel["input"], 1.0)
        true = ratio * np.array(channel["plant"])
        size = np.linalg.norm(true)
        given = np.linalg.norm(np.array(channel["model"]) - true) / size
        key = channel["cv"], channel["input"]
        repaired = steps[key][::stride] if key in steps else np.zeros(points)
        now = np.linalg.norm(repaired - true) / size
        before, after = before + given, after + now
        if now - given > most:
            most, worst = now - given, [*key, float(given), float(now)]
    return float(before), float(after), worst


def limit_cpu_time():
    resource.setrlimit(resource.RLIMIT_CPU, (TIME_LIMIT, TIME_LIMIT))


def run(mpm, arguments):
    """Return code (negative or None: took too long), output, CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([mpm] + arguments, capture_output=True, text=True, check=False,
                              timeout=10 * TIME_LIMIT, preexec_fn=limit_cpu_time)
        code, output = done.returncode, done.stdout + (done.stderr if done.returncode else "")
    except subprocess.TimeoutExpired:
        code, output = None, "ran out of time"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return code, output, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def detected(mpm, unit, data, truth):
    """Healthy channels called wrong, and whether one that is wrong was seen."""
    code, output, _ = run(mpm, ["detect", "--config", unit, "--data", data, "--json"])
    if code not in (0, 1):
        return None
    false, found, healthy, unexcited = [], False, 0, []
    for channel in json.loads(output)["channels"]:
        mine = {**truth, "others": []}
        finding = {"cause": "gain", "cv": channel["cv"], "mv": channel["mv"], "parameters": {}}
        guilty = judge(finding, mine) in ("right", "place")
        healthy += not guilty
        if channel["verdict"] == "mismatch":
            found = found or guilty
            if not guilty:
                false.append([channel["mv"], channel["cv"], channel["p_value"]])
        elif not guilty and channel.get("reason", "").split(" ")[0] in UNEXCITED:
            unexcited.append(channel["p_value"])
    return {"healthy_channels": healthy, "false": false, "found": found, "unexcited": unexcited}


def score_case(case, mpm, keep, detect):
    regime, plant, effect, seed = case
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(keep or scratch) / "-".join(map(str, case))
        result = {"regime": regime, "plant": plant, "effect": effect, "seed": seed}
        try:
            truth = loop.write(regime, plant, effect, seed, 3000, folder)
        except SystemExit as no_draw:
            return {**result, "failed": str(no_draw), "made": False}
        unit, data = str(folder / "unit.yaml"), str(folder / "data.csv")
        out = folder / "out"
        code, output, seconds = run(mpm, ["diagnose", "--config", unit, "--data", data, "--out",
                                          str(out), "--threads", "1"])
        result.update(noncentrality=truth["noncentrality"], seconds=seconds, made=True,
                      truth={k: truth[k] for k in ("cause", "cv", "mv", "tag", "parameters",
                                                   "onset")})
        if detect:
            result["detect"] = detected(mpm, unit, data, truth)
        if code != 0:
            return {**result, "failed": output[-400:] or f"exit {code}"}
        report = json.loads((out / "report.json").read_text())
        result["verdict"] = report["verdict"]
        result["reason"] = report.get("reason", "")
        result["findings"] = [
            {**{k: f.get(k) for k in ("cause", "cv", "mv", "tag", "parameters", "confidence",
                                   "in_model", "explains")},
             "is": judge(f, truth)} for f in report["findings"]]
        if gains_make_scale(report["findings"], truth):
            result["findings"][0]["is"] = "right"
        extended = (out / report["extended_model"]).read_text()
        result["before"], result["after"], result["worst"] = distances(folder, truth, extended)
        return result


def describe(result):
    if "failed" in result:
        return "failed: " + result["failed"].strip().splitlines()[-1]
    named = [f"{f['cause']}({','.join(filter(None, (f['cv'], f['mv'], f['tag'])))}) "
             f"{f['confidence']:.3g} {f['is']}" for f in result["findings"]]
    worst = ""
    if result["after"] > result["before"] + FARTHER:
        cv, tag, before, after = result["worst"]
        worst = f" ({cv},{tag} {before:.2f} -> {after:.2f})"
    return (f"{result['verdict']}: {'; '.join(named) or 'nothing'}; distance "
            f"{result['before']:.2f} -> {result['after']:.2f}{worst}")


def save(file, results):
    whole = {"cases": results, "reliability": reliability(results),
             "regimes": {r: summary([c for c in results if c["regime"] == r]) for r in REGIMES},
             "all": summary(results)}
    pathlib.Path(file).write_text(json.dumps(whole, indent=1) + "\n")


def seed_list(text):
    seeds = []
    for part in text.split(","):
        low, _, high = part.partition("-")
        seeds += range(int(low), int(high or low) + 1)
    return seeds


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mpm", required=True)
    parser.add_argument("--seeds", type=seed_list, default=[])
    parser.add_argument("--regime", choices=REGIMES, nargs="+", default=REGIMES)
    parser.add_argument("--plant", choices=list(PLANTS), nargs="+", default=list(PLANTS))
    parser.add_argument("--effect", choices=EFFECTS, nargs="+")
    parser.add_argument("--per-seed", type=int, default=3)
    parser.add_argument("--detect", action="store_true")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("--markdown")
    parser.add_argument("--json")
    parser.add_argument("--add", nargs="+", default=[])
    parser.add_argument("--bounds", action="store_true")
    parser.add_argument("--diagram")
    args = parser.parse_args()
    wanted = cases(args.regime, args.seeds, args.plant, args.effect, args.per_seed)
    started, results = time.monotonic(), []
    for file in args.add:
        results += json.loads(pathlib.Path(file).read_text())["cases"]
    with concurrent.futures.ProcessPoolExecutor(args.jobs) as pool:
        waiting = [pool.submit(score_case, case, args.mpm, args.keep, args.detect) for case in wanted]
        for case, future in zip(wanted, waiting):
            results.append(future.result())
            print(f"{' '.join(map(str, case))} ({results[-1].get('noncentrality', 0):.0f}) "
                  f"{describe(results[-1])}", file=sys.stderr, flush=True)
            if args.json:
                save(args.json, results)  # so far: a long run may be stopped
    if args.json:
        save(args.json, results)
    text = tables(results, args.detect)
    print(text)
    print(f"{len(wanted)} cases, {time.monotonic() - started:.0f} s")
    if args.markdown:
        pathlib.Path(args.markdown).write_text(text)
    if args.diagram:
        pathlib.Path(args.diagram).write_text(diagram(results))
    if args.bounds:
        failed = beyond(results)
        print("\n".join(failed) or "within the bounds")
        sys.exit(bool(failed))


if __name__ == "__main__":
    main()
