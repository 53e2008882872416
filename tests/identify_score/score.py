#!/usr/bin/python3
"""How well `mpm identify` finds models in closed-loop data whose truth is known.

Usage: score.py --bin build/release/bin [--plants P ...] [--seeds 1-10] [--samples 5000]
                [--json FILE] [--bounds]

Four plants, all in closed loop with set-point moves: Shell 3x3, Wood-Berry and Ogunnaike-Ray by
mpmsim (config/plants); sparse_4x6 (4 CVs, 6 MVs, a DV, 16 of 28 channels) by tests/foreign, another
implementation with a controller of its own. The unit file that `mpm identify` gets has no model.
Seeds below 1000 are for scores, from 100001 on for tuning.

found: relations of the plant that are in the model. invented: relations in the model that are not
in the plant, of those that are not. gain: |identified - true| / |true| of the relations found.
right size: within 5 %. step: |identified - true| / |true| of the step responses up to settling,
Euclidean norms. covered: true gains in their 95 % interval.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "foreign"))
SIMULATED = ["shell3x3", "wood_berry", "ogunnaike_ray"]
FOREIGN = ["sparse_4x6"]
POINTS = 400
CLAIMED = {"found": 0.98, "invented": 0.01, "gain": 0.05}


def step_of(channel, time):
    """Step response of a transfer function as in model.json."""
    t = np.maximum(0.0, time - channel["dead_time"])
    poles = list(channel["time_constants"])
    if channel.get("integrating"):
        rest = t - sum(T * -np.expm1(-t / T) for T in poles)
        return channel["gain"] * rest
    if not poles:
        return channel["gain"] * (time > channel["dead_time"])
    if len(poles) > 1 and abs(poles[0] / poles[1] - 1) < 1e-6:
        poles[1] *= 1 + 1e-5
    y = np.ones_like(t)
    for i, T in enumerate(poles):
        weight = (T - channel.get("lead", 0.0)) * T ** (len(poles) - 2)
        for j, other in enumerate(poles):
            if j != i:
                weight /= T - other
        y -= weight * np.exp(-t / T)
    return channel["gain"] * np.where(time > channel["dead_time"], y, 0.0)


def without_model(text):
    """A unit file's text with neither model nor operating point."""
    kept, inside = [], False
    for line in text.splitlines():
        if line and line[0] not in " #-":
            inside = line.startswith(("model:", "operating_point:"))
        if not inside:
            kept.append(line)
    return "\n".join(kept) + "\n"


def true_channels(mpm_text):
    """Channels of a shipped unit file: flat lines, one channel each."""
    channels = {}
    for line in mpm_text.splitlines():
        if not line.strip().startswith("- {cv:") or "gain:" not in line:
            continue
        body = line[line.index("{") + 1:line.index("}")]
        fields, rest = {}, body
        while rest:
            key, rest = rest.split(":", 1)
            rest = rest.strip()
            if rest.startswith("["):
                value, rest = rest[1:].split("]", 1)
                fields[key.strip()] = [float(v) for v in value.split(",") if v.strip()]
                rest = rest.lstrip(", ")
            else:
                value, _, rest = rest.partition(",")
                fields[key.strip()] = value.strip()
        channel = {"gain": float(fields["gain"]), "dead_time": float(fields.get("dead_time", 0)),
                   "time_constants": fields.get("time_constants", []),
                   "lead": float(fields.get("lead", 0)),
                   "integrating": fields.get("integrating") == "true"}
        channels[fields["cv"], fields.get("mv") or fields["dv"]] = channel
    return channels


def make_case(plant, seed, samples, bin_folder, folder):
    """Writes unit.yaml (no model) and data.csv; returns the true channels."""
    if plant in FOREIGN:
        import loop
        truth = loop.write("stationary", plant, "none", seed, samples, folder)
        text = (folder / "unit.yaml").read_text()
        channels = true_channels(text)
        for entry in truth["channels"]:  # the plant is off its controller's model by some percent
            channel = channels[entry["cv"], entry["input"]]
            channel["gain"] *= entry["plant"][-1] / entry["model"][-1]
    else:
        text = (ROOT / "config" / "plants" / f"{plant}.yaml").read_text()
        channels = true_channels(text)
        subprocess.run([bin_folder / "mpmsim", "--config",
                        ROOT / "config" / "plants" / f"{plant}.yaml", "--scenario", "none",
                        "--samples", str(samples), "--seed", str(seed), "--csv",
                        folder / "data.csv"], check=True, capture_output=True)
    (folder / "unit.yaml").write_text(without_model(text))
    return channels


def score_case(plant, seed, samples, bin_folder):
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        truth = make_case(plant, seed, samples, bin_folder, folder)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([bin_folder / "mpm", "identify", "--config", folder / "unit.yaml",
                               "--data", folder / "data.csv", "--out", folder / "new.yaml",
                               "--threads", "1", "--json"], capture_output=True, text=True)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        if done.returncode not in (0, 1):
            raise SystemExit(f"{plant} {seed}: {done.stderr}")
        answers = json.loads(done.stdout)["channels"]
    result = {"plant": plant, "seed": seed, "seconds": seconds, "relations": len(truth),
              "absent": len(answers) - len(truth), "found": 0, "invented": 0, "gain_errors": {},
              "step_errors": {}, "covered": 0, "missed": [], "wrong": []}
    for answer in answers:
        place = answer["cv"], answer["mv"]
        name = "/".join(place)
        if not answer["in_model"]:
            if place in truth:
                result["missed"].append(f"{name}: {answer['reason']}")
            continue
        if place not in truth:
            result["invented"] += 1
            result["wrong"].append(f"{name}: gain {answer['gain']:.3g}, p {answer['p_value']:.1g}")
            continue
        true = truth[place]
        result["found"] += 1
        result["gain_errors"][name] = abs(answer["gain"] / true["gain"] - 1)
        low, high = answer["interval"]["gain"]
        result["covered"] += low <= true["gain"] <= high
        end = true["dead_time"] + 6 * sum(true["time_constants"], 0.0)
        time = np.linspace(0, end, POINTS)
        expected = step_of(true, time)
        result["step_errors"][name] = float(np.linalg.norm(step_of(answer, time) - expected) /
                                            np.linalg.norm(expected))
    return result


def summary(results):
    gains = np.concatenate([list(r["gain_errors"].values()) for r in results] or [[]])
    steps = np.concatenate([list(r["step_errors"].values()) for r in results] or [[]])
    total = {key: sum(r[key] for r in results)
             for key in ("relations", "absent", "found", "invented", "covered")}
    return {"found": total["found"] / total["relations"],
            "invented": total["invented"] / max(1, total["absent"]),
            "gain median": float(np.median(gains)), "gain 95 %": float(np.quantile(gains, 0.95)),
            "gain worst": float(gains.max()), "right size": float((gains <= 0.05).mean()),
            "step median": float(np.median(steps)), "step worst": float(steps.max()),
            "covered": total["covered"] / max(1, total["found"]),
            "seconds": float(np.mean([r["seconds"] for r in results]))}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--plants", nargs="+", default=SIMULATED + FOREIGN)
    parser.add_argument("--seeds", default="1-10")
    parser.add_argument("--samples", type=int, default=5000)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--bounds", action="store_true", help="exit 1 beyond what is claimed")
    parser.add_argument("--verbose", action="store_true")
    args = parser.parse_args()
    first, _, last = args.seeds.partition("-")
    seeds = range(int(first), int(last or first) + 1)
    print(f"{'plant':14} {'found':>7} {'invented':>8} {'gain med':>8} {'95 %':>6} {'worst':>6} "
          f"{'in 5 %':>7} {'step med':>8} {'worst':>6} {'covered':>7} {'s':>5}")
    everything = []

    def show(name, results):
        s = summary(results)
        print(f"{name:14} {s['found']:7.1%} {s['invented']:8.1%} {s['gain median']:8.1%} "
              f"{s['gain 95 %']:6.1%} {s['gain worst']:6.1%} {s['right size']:7.1%} "
              f"{s['step median']:8.1%} {s['step worst']:6.1%} {s['covered']:7.1%} "
              f"{s['seconds']:5.1f}", flush=True)
        return s

    for plant in args.plants:
        results = [score_case(plant, seed, args.samples, args.bin.resolve()) for seed in seeds]
        show(plant, results)
        if args.verbose:
            for r in results:
                off = {k: f"{v:.1%}" for k, v in r["gain_errors"].items() if v > 0.05}
                print("   ", r["seed"], "missed", r["missed"], "invented", r["wrong"], "off", off)
        everything += results
    total = show("all", everything)
    if args.json:
        args.json.write_text(json.dumps(everything, indent=1) + "\n")
    if args.bounds and (total["found"] < CLAIMED["found"] or
                        total["invented"] > CLAIMED["invented"] or
                        total["gain 95 %"] > CLAIMED["gain"]):
        raise SystemExit("beyond what is claimed")


if __name__ == "__main__":
    main()
