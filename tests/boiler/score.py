#!/usr/bin/env python3
"""What `mpm diagnose` names of each hidden change of the recovery boiler, and what `mpm detect`
says of it, over some seeds:

    tests/boiler/score.py --bin build/release/bin --seeds 301-310 [--samples 3000] [--jobs 2]

A change counts as named where a finding that is in the extended model, or that had passed by its
unseen samples, says what RIGHT below takes for right; what was hidden at some moment has to begin
there. Where it is not named, the report may say that the CV's level has moved, or its sensor drifts
(LEVELS): no cause, for a disturbance that wanders does the same. Of an unchanged plant the alarms
are counted, and the findings that are wrong: its answers do bend, and its liquor's solids do wander.
"""
import argparse
import concurrent.futures
import json
import pathlib
import re
import subprocess
import tempfile

UNIT = pathlib.Path(__file__).resolve().parents[2] / "config/plants/recovery_boiler.yaml"
CO, O2, TEMPERATURE, STEAM = "AI-602.PV", "AI-601.PV", "TI-502.PV", "FI-500.PV"
BEGINS = 0.3  # of the run, in the scenarios that begin within it


def begins(finding, samples):
    onset = finding["onset"]
    return onset is not None and abs(onset - BEGINS * samples * 10) < 600


def shifted(cv, sign):
    return lambda f, n: f["cause"] == "output_disturbance" and f["cv"] == cv and \
        f["parameters"]["size"] * sign > 0


def has_passed(finding):
    """What is over has nothing to repair."""
    return finding.get("refused", "").startswith("it had passed")


# Per scenario what is right, in the causes that there are.
RIGHT = {
    # More CO burns: less of it at the same inputs.
    "co_oxidation": shifted(CO, -1),
    # The steam is colder.
    "fouled_superheater": shifted(TEMPERATURE, -1),
    "sticking_spray_valve": lambda f, n: f["cause"] == "stiction" and f["mv"] == "HV-501.SP",
    "o2_analyser_drift": shifted(O2, 1),
    "drier_liquor": lambda f, n: f["cause"] == "unmodelled_input" and f["tag"] == "AI-103.PV",
    # Less burns until the bed has grown: oxygen is left, less turns to CO, steam and its temperature
    # go down.
    "growing_char_bed": lambda f, n: begins(f, n) and any(
        shifted(cv, sign)(f, n)
        for cv, sign in ((CO, -1), (O2, 1), (STEAM, -1), (TEMPERATURE, -1))),
    # More air than is measured.
    "leaking_damper": lambda f, n: begins(f, n) and
    (shifted(O2, 1)(f, n) or f["cause"] == "input_offset" and f["mv"] == "FC-301.SP"),
}
# What moves a level and stays.
LEVELS = {"co_oxidation": (CO, -1), "o2_analyser_drift": (O2, 1)}
# True of the plant whatever is hidden: not counted as wrong.
TRUE_ANYWAY = lambda f: (f["cause"] == "unmodelled_input" and f["tag"] == "AI-103.PV") or (
    f["cause"] == "input_nonlinearity" and f["cv"] == CO)


def run(bin_dir, scenario, seed, samples):
    with tempfile.TemporaryDirectory() as folder:
        data = f"{folder}/data.csv"
        subprocess.run([f"{bin_dir}/mpmsim", "--config", UNIT, "--scenario", scenario, "--samples",
                        str(samples), "--seed", str(seed), "--csv", data], check=True,
                       capture_output=True)
        detected = json.loads(subprocess.run(
            [f"{bin_dir}/mpm", "detect", "--config", UNIT, "--data", data, "--json"], check=True,
            capture_output=True).stdout)
        said = subprocess.run([f"{bin_dir}/mpm", "diagnose", "--config", UNIT, "--data", data, "--threads",
                               "1", "--out", f"{folder}/out"], check=True, capture_output=True,
                              text=True).stdout
        report = json.load(open(f"{folder}/out/report.json"))
    alarms = sorted({f"{a['mv'][:6]}>{a['cv'][:6]}" for a in detected["alarms"] if a["to"] == "active"})
    return scenario, seed, alarms, report["findings"], moved_levels(said)


def moved_levels(said):
    """CVs of which the report says that their level has moved, and which way."""
    found = re.findall(r"(\S+) lies .*? (above|below) its simulation", said)
    found += re.findall(r"The extended model has (\S+) .*? (higher|lower) than", said)
    return {(cv, 1 if way in ("above", "higher") else -1) for cv, way in found}


def short(finding):
    where = " ".join(x for x in (finding["mv"], finding["tag"], finding["cv"]) if x)
    return f"{finding['cause']} {where} ({finding['confidence']:.3f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", required=True)
    parser.add_argument("--seeds", default="301-310")
    parser.add_argument("--samples", type=int, default=3000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--scenarios", nargs="*", default=[*RIGHT, "none"])
    args = parser.parse_args()
    first, last = (int(x) for x in args.seeds.split("-"))
    seeds = range(first, last + 1)
    named = {s: 0 for s in args.scenarios}
    first_named = dict(named)
    wrong = dict(named)
    alarmed = dict(named)
    levels = dict(named)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        futures = [pool.submit(run, args.bin, s, seed, args.samples)
                   for s in args.scenarios for seed in seeds]
        for future in futures:
            scenario, seed, alarms, findings, off = future.result()
            is_right = RIGHT.get(scenario, lambda f, n: False)
            told = [f for f in findings if f["in_model"] is not False or has_passed(f)]
            right = [f for f in told if is_right(f, args.samples)]
            others = [f for f in told if not is_right(f, args.samples) and not TRUE_ANYWAY(f)]
            named[scenario] += bool(right)
            first_named[scenario] += bool(right) and (not others or
                                                      told.index(right[0]) < told.index(others[0]))
            wrong[scenario] += bool(others)
            alarmed[scenario] += bool(alarms)
            level = not right and LEVELS.get(scenario) in off
            levels[scenario] += level
            print(f"  {scenario} {seed}: {'named' if right else 'level' if level else '-'}; alarms {alarms}; "
                  + "; ".join(short(f) for f in findings), flush=True)
    print(f"\n{args.samples} samples, seeds {args.seeds}: runs out of {len(seeds)}")
    print("| hidden | named | before all that is not so | its level only | with something that is not so | alarms |")
    print("|---|---|---|---|---|---|")
    for s in args.scenarios:
        print(f"| {s} | {named[s] if s in RIGHT else ''} | {first_named[s] if s in RIGHT else ''} "
              f"| {levels[s] if s in LEVELS else ''} | {wrong[s]} | {alarmed[s]} |")


if __name__ == "__main__":
    main()
