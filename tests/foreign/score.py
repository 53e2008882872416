#!/usr/bin/python3
"""How well `mpm diagnose` does on foreign plants, in regimes where it is hard.

Usage: score.py --mpm build/release/bin/mpm --seeds 100001-100006 [--regime R ...] [--plant P ...]
                [--effect E ...] [--per-seed 3] [--detect] [--jobs 1] [--keep DIR]
                [--markdown FILE] [--json FILE] [--add FILE ...]

loop.py makes the recordings. For each regime and seed `--per-seed` plants come by turns; each runs
healthy and with one effect, by turns too (--effect: with each of these instead). Seeds below 1000
are for scores, from 100001 on for tuning. --keep leaves each case in DIR/REGIME-PLANT-EFFECT-SEED:
what loop.py wrote, and the report in out/. --add takes in the cases of earlier --json files. A
run may take 60 s of CPU time.

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
import math
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
except ImportError:
    raise SystemExit("score.py: needs numpy (python3-numpy)") from None

import loop
from effects import EFFECTS
from model_reader import model_steps
from plants import PLANTS
from regimes import REGIMES

ACCUSES = {"gain", "dead_time", "time_constant", "dynamics", "input_scale", "output_scale",
           "input_nonlinearity", "stiction", "state_nonlinearity", "input_stuck", "input_offset"}
IN_CHANNEL = {"gain": "gain_ratio", "dead_time": "dead_time_error",
              "time_constant": "time_constant_ratio"}
OF_INPUT = {"input_scale", "stiction", "input_stuck", "input_offset"}
SLIGHT_GAIN, SLIGHT_TIME, SLIGHT_DEAD = 0.05, 0.10, 1.0  # ratios; samples
SEEN = 100.0  # noncentrality
FARTHER, FAR = 0.05, 0.25
TIME_LIMIT = 60  # s of CPU time, and ten times that on the clock
CONFIDENCE = [(0.9, 0.99), (0.99, 0.999), (0.999, 1.01)]
# Turns of 13, so that every plant meets every effect; gain and dead time twice.
TURNS = ["gain", "dead_time", "output_scale", "time_constant", "input_scale", "stiction", "gain",
         "aux", "input_stuck", "output_step", "dead_time", "input_offset", "output_drift"]


def wilson(hits, runs):
    if runs == 0:
        return 0.0, 1.0
    z, share = 1.96, hits / runs
    middle = (share + z * z / (2 * runs)) / (1 + z * z / runs)
    half = z / (1 + z * z / runs) * math.sqrt(share * (1 - share) / runs + z * z / (4 * runs**2))
    return max(0.0, middle - half), min(1.0, middle + half)


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


def only_channel(truth, key, tag):
    return sum(channel[key] == tag for channel in truth["channels"]) == 1


def reaches(truth, mv, cv):
    return any(c["cv"] == cv and c["input"] == mv for c in truth["channels"])


def slight(finding, truth):
    numbers = finding.get("parameters", {})
    known = {"gain_ratio": SLIGHT_GAIN, "time_constant_ratio": SLIGHT_TIME}
    if not numbers or not set(numbers) <= {*known, "dead_time_error"}:
        return False
    return all(abs(value) <= SLIGHT_DEAD * truth["sample_time"] if key == "dead_time_error" else
               abs(value - 1.0) <= known[key] for key, value in numbers.items())


def judge(finding, truth):
    """right, place, slight, wrong or else."""
    cause, cv, mv = finding["cause"], finding.get("cv"), finding.get("mv")
    tag = finding.get("tag")
    true, true_cv, true_mv = truth["cause"], truth["cv"], truth["mv"]
    for other in truth["others"] + [truth]:
        if cause == other["cause"] and cause not in ACCUSES:
            if cv == other["cv"] and tag == other["tag"]:
                return "right"
    if cause not in ACCUSES:
        moved = true in ("input_stuck", "input_offset") and cause == "output_disturbance"
        return "place" if moved and reaches(truth, true_mv, cv) else "else"
    # An input's or a CV's only channel is the whole of it.
    if mv is None and cv is not None and only_channel(truth, "cv", cv):
        mv = next(c["input"] for c in truth["channels"] if c["cv"] == cv)
    if cv is None and mv is not None and only_channel(truth, "input", mv):
        cv = next(c["cv"] for c in truth["channels"] if c["input"] == mv)
    if true in IN_CHANNEL:
        if true_cv == cv and true_mv == mv:
            same = cause == true or (cause == "dynamics" and
                                     IN_CHANNEL[true] in finding["parameters"])
            scale = true == "gain" and cause in ("input_scale", "output_scale")
            return "right" if same or scale else "place"
        if cause == "state_nonlinearity" and true_cv == cv and mv is None:
            return "place"
    elif true in OF_INPUT and true_mv == mv:
        deadband = true == "stiction" and finding.get("parameters", {}).get("kind",
                   finding.get("kind")) == "deadband"
        one = true == "input_scale" and cause == "gain" and only_channel(truth, "input", mv)
        return "right" if cause == true or deadband or one else "place"
    elif true == "output_scale" and true_cv == cv:
        return "right" if cause == true else "place"
    return "slight" if slight(finding, truth) else "wrong"


def gains_make_scale(findings, truth):
    """Gains of all channels of an input or a CV are its scale."""
    if truth["cause"] not in ("input_scale", "output_scale"):
        return False
    wanted = {(c["cv"], c["input"]) for c in truth["channels"]
              if (c["input"] == truth["mv"] or c["cv"] == truth["cv"])}
    named = {(f.get("cv"), f.get("mv")) for f in findings if f["cause"] in ("gain", "dynamics")}
    return wanted <= named


def distances(folder, truth, extended):
    """Of the given and of the repaired model from the true plant."""
    table = np.genfromtxt(folder / "data.csv", delimiter=",", names=True)
    inputs = {name: table[name] for name in table.dtype.names}
    stride = truth["stride"]
    points = len(truth["channels"][0]["plant"])
    steps = model_steps(extended, truth["sample_time"], (points - 1) * stride + 1, inputs)
    before = after = 0.0
    for channel in truth["channels"]:
        ratio = truth["input_gains"].get(channel["input"], 1.0)
        true = ratio * np.array(channel["plant"])
        size = np.linalg.norm(true)
        before += np.linalg.norm(np.array(channel["model"]) - true) / size
        key = channel["cv"], channel["input"]
        repaired = steps[key][::stride] if key in steps else np.zeros(points)
        after += np.linalg.norm(repaired - true) / size
    return float(before), float(after)


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
    false, found, healthy = [], False, 0
    for channel in json.loads(output)["channels"]:
        mine = {**truth, "others": []}
        finding = {"cause": "gain", "cv": channel["cv"], "mv": channel["mv"], "parameters": {}}
        guilty = judge(finding, mine) in ("right", "place")
        healthy += not guilty
        if channel["verdict"] == "mismatch":
            found = found or guilty
            if not guilty:
                false.append([channel["mv"], channel["cv"], channel["p_value"]])
    return {"healthy_channels": healthy, "false": false, "found": found}


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
                                          str(out)])
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
            {**{k: f.get(k) for k in ("cause", "cv", "mv", "tag", "parameters", "confidence")},
             "is": judge(f, truth)} for f in report["findings"]]
        if gains_make_scale(report["findings"], truth):
            result["findings"][0]["is"] = "right"
        extended = (out / report["extended_model"]).read_text()
        result["before"], result["after"] = distances(folder, truth, extended)
        return result


def describe(result):
    if "failed" in result:
        return "failed: " + result["failed"].strip().splitlines()[-1]
    named = [f"{f['cause']}({','.join(filter(None, (f['cv'], f['mv'], f['tag'])))}) "
             f"{f['confidence']:.3g} {f['is']}" for f in result["findings"]]
    return (f"{result['verdict']}: {'; '.join(named) or 'nothing'}; distance "
            f"{result['before']:.2f} -> {result['after']:.2f}")


def outcome(result):
    """Which columns a faulty run counts in."""
    is_ = [finding["is"] for finding in result["findings"]]
    mine = [f["is"] for f in result["findings"] if not of_regime(f, result)]
    columns = set()
    if "wrong" in is_:
        columns.add("wrong")
    if "right" in mine:
        columns.add("right")
        if mine[0] == "right":
            columns.add("first")
    elif "place" in mine:
        columns.add("place")
    elif result["verdict"] == "undetermined":
        columns.add("undetermined")
    elif "wrong" not in is_:
        columns.add("silent")
    return columns


def of_regime(finding, result):
    """Right, but not what the effect is."""
    truth = result["truth"]
    return finding["is"] == "right" and finding["cause"] not in ACCUSES and not (
        finding["cause"] == truth["cause"] and finding["cv"] == truth["cv"])


def share(hits, runs):
    low, high = wilson(hits, runs)
    return f"{hits}/{runs} ({100 * low:.0f}-{100 * high:.0f})"


def summary(results):
    """One row of the table."""
    ran = [r for r in results if r.get("made")]
    good = [r for r in ran if "failed" not in r]
    healthy = [r for r in good if r["effect"] == "none"]
    strong = [r for r in good if r["effect"] != "none" and r["noncentrality"] > SEEN]
    columns = [outcome(r) for r in strong]
    seconds = [r["seconds"] for r in ran] or [0.0]
    row = {"healthy": len(healthy), "strong": len(strong), "runs": len(good),
           "accused": sum(any(f["is"] == "wrong" for f in r["findings"]) for r in healthy),
           "farther": sum(r["after"] > r["before"] + FARTHER for r in good),
           "far": sum(r["after"] > r["before"] + FAR for r in good),
           "nearer": sum(r["after"] < r["before"] - FARTHER for r in good),
           "failed": len(ran) - len(good), "not_made": len(results) - len(ran),
           "cpu_median": statistics.median(seconds), "cpu_max": max(seconds)}
    for name in ("right", "first", "place", "undetermined", "silent", "wrong"):
        row[name] = sum(name in c for c in columns)
    row["wrong_any"] = sum(any(f["is"] == "wrong" for f in r["findings"]) for r in good)
    return row


def reliability(results):
    rows = []
    for low, high in CONFIDENCE:
        row = {"confidence": f"{low} .. {min(high, 1.0)}"}
        for name, causes in (("accusing", ACCUSES), ("all", None)):
            of = [f["is"] for r in results for f in r.get("findings", [])
                  if low <= f["confidence"] < high and f["is"] != "slight" and
                  (causes is None or f["cause"] in causes)]
            row[name] = {"right": of.count("right"), "place": of.count("place"), "of": len(of)}
        rows.append(row)
    return rows


def detect_row(results):
    seen = [r for r in results if r.get("detect")]
    strong = [r for r in seen if r["effect"] not in ("none", "aux", "output_step", "output_drift")
              and r["noncentrality"] > SEEN]
    false = sum(bool(r["detect"]["false"]) for r in seen)
    found = sum(r["detect"]["found"] for r in strong)
    return f"{share(false, len(seen))} | {share(found, len(strong))}"


def tables(results, detect):
    groups = [(regime, [r for r in results if r["regime"] == regime]) for regime in REGIMES]
    groups = [(name, group) for name, group in groups if group] + [("all", results)]
    lines = ["| regime | healthy accused | strong: right | first | place | undetermined | silent |"
             " wrong | all runs: farther | far | nearer | CPU s median, max | failed |",
             "|---" * 13 + "|"]
    for name, group in groups:
        s = summary(group)
        lines.append(
            f"| {name} | {share(s['accused'], s['healthy'])} | {share(s['right'], s['strong'])} | "
            f"{s['first']} | {s['place']} | {s['undetermined']} | {s['silent']} | "
            f"{share(s['wrong'], s['strong'])} | {share(s['farther'], s['runs'])} | {s['far']} | "
            f"{s['nearer']} | {s['cpu_median']:.1f}, {s['cpu_max']:.1f} | {s['failed']} |")
    lines += ["", "| effect (all regimes) | strong: right | first | place | undetermined | silent |"
              " wrong |", "|---" * 7 + "|"]
    for effect in EFFECTS[1:]:
        s = summary([r for r in results if r["effect"] == effect])
        lines.append(f"| {effect} | {share(s['right'], s['strong'])} | {s['first']} | {s['place']} "
                     f"| {s['undetermined']} | {s['silent']} | {share(s['wrong'], s['strong'])} |")
    lines += ["", "| confidence | accusing: right | or of the place | all: right |",
              "|---" * 4 + "|"]
    for row in reliability(results):
        a, b = row["accusing"], row["all"]
        lines.append(f"| {row['confidence']} | {share(a['right'], a['of'])} | "
                     f"{share(a['right'] + a['place'], a['of'])} | {share(b['right'], b['of'])} |")
    if detect:
        lines += ["", "| detect | runs with a healthy channel called wrong | strong effects seen |",
                  "|---" * 3 + "|"]
        lines += [f"| {name} | {detect_row(group)} |" for name, group in groups]
    return "\n".join(lines) + "\n"


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
    args = parser.parse_args()
    todo = cases(args.regime, args.seeds, args.plant, args.effect, args.per_seed)
    started, results = time.monotonic(), []
    for file in args.add:
        results += json.loads(pathlib.Path(file).read_text())["cases"]
    with concurrent.futures.ProcessPoolExecutor(args.jobs) as pool:
        waiting = [pool.submit(score_case, case, args.mpm, args.keep, args.detect) for case in todo]
        for case, future in zip(todo, waiting):
            results.append(future.result())
            print(f"{' '.join(map(str, case))} ({results[-1].get('noncentrality', 0):.0f}) "
                  f"{describe(results[-1])}", file=sys.stderr, flush=True)
    text = tables(results, args.detect)
    print(text)
    print(f"{len(todo)} cases, {time.monotonic() - started:.0f} s")
    if args.markdown:
        pathlib.Path(args.markdown).write_text(text)
    if args.json:
        whole = {"cases": results, "reliability": reliability(results),
                 "regimes": {r: summary([c for c in results if c["regime"] == r])
                             for r in REGIMES}, "all": summary(results)}
        pathlib.Path(args.json).write_text(json.dumps(whole, indent=1) + "\n")


if __name__ == "__main__":
    main()
