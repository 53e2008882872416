#!/usr/bin/python3
"""What `mpm diagnose` says of nonlinear plants from first principles under a linear controller.

Usage: physical.py --mpm build/release/bin/mpm --seeds 100001-100003 [--plant P ...] [--case C ...]
                [--model exact reduced] [--jobs 1] [--keep DIR] [--markdown FILE] [--bounds]
                [--detect-only]

physical_plants.py has the plants, controller.py the controller (Dmc). Its model, and that of the
unit file, are the plant's step responses at its operating point, `exact` or `reduced` to a lag or
two as reduced.py fits them, within 3 % of each step. Each plant (the separator, whose level
integrates, where it is asked for: some take longer than a score allows) runs healthy, healthy
with set-points that move twice as far, with a sensor's span of 0.7, a sensor's bias half-way, a
valve that sticks, and each of its own changes, from the start or half-way. 3000 samples; a load and
coloured noise disturb all of it. Seeds below 1000 are for scores, from 100001 on for tuning.

`detect` reads the same: alarms on the sound plants are counted, and what it says of each channel in
the end, but where a valve sticks: of sound ones (by SOUND), that they are a mismatch; of wrong ones
(by WRONG), that they are one or match. --detect-only: nothing else; --markdown writes that table
then, and what is diagnosed otherwise.

The truth is the changed plant's step responses at the mean inputs of the recording: a channel is
wrong by the norm of its error over the norm of what the model has, until half as long again as that
takes to come within 5 % of its end. A finding that accuses is
* right: of its channels one is wrong by more than WRONG; or it is what was done to the run;
* curve: a nonlinearity, which all of these plants have;
* slight: none is wrong by more than WRONG, one by more than SOUND;
* place: another of the actuator that sticks;
* wrong: all its channels are as the model has them; a valve that is said to stick, to have stuck or
  to be shifted where none is.
Others are `else`, but for the level of a sensor that is biased, which is right.
--bounds: exit 1 where more than one run of 20 has a wrong finding, so surely that a true share
of that would break it in one of 1000 scores.
"""
import argparse
import functools
import json
import multiprocessing
import pathlib
import tempfile

import numpy as np

from controller import Dmc
from judge import ACCUSES
from physical_plants import PHYSICAL, advance, responses, settled
from reduced import reduced, reduced_ramp
from score import run, seed_list
from tables import most, replace_part, share

SAMPLES, HORIZON = 3000, 240
WRONG, SOUND, STRONG = 0.15, 0.08, 0.25
MOST_WRONG = 0.05
CURVES = {"input_nonlinearity", "output_nonlinearity", "state_nonlinearity"}
OF_ACTUATOR = {"stiction", "input_stuck", "input_offset"}
SPAN, STICK = 0.7, 1.0  # factor; band in usual movements of the MV


def cases_of(plant):
    return ["healthy", "far", "span", "bias", "stiction", *plant.changes]


def filtered(rng, samples, columns, pole):
    """s.d. 1."""
    noise = rng.standard_normal((samples, columns))
    for k in range(1, samples):
        noise[k] = pole * noise[k - 1] + np.sqrt(1.0 - pole * pole) * noise[k]
    return noise


def levels(rng, samples, low, high, draw):
    values, k = [], 0
    while k < samples:
        hold = int(rng.integers(low, high))
        values += [draw()] * hold
        k += hold
    return np.array(values[:samples])


@functools.lru_cache
def models(name):
    """Of a plant: its steps and level at rest, what `reduced` makes of the steps (CV by CV), and the
    steps that these have."""
    plant = next(make() for make in PHYSICAL if make.__name__ == name)
    steps, level = responses(plant, plant.rest, plant.numbers, HORIZON)
    fits = [[(reduced_ramp if j in plant.integrating else reduced)(steps[:, j, i])
             if np.any(steps[:, j, i]) else None
             for i in range(steps.shape[2])] for j in range(steps.shape[1])]
    fitted = np.stack([np.stack([fit.steps if fit else 0.0 * steps[:, 0, 0] for fit in of], axis=1)
                       for of in fits], axis=1)
    return steps, level, fits, fitted


class Run:
    """One recording, and the truth about it."""

    def __init__(self, plant, case, seed, model):
        rng = np.random.default_rng([seed, [p().name for p in PHYSICAL].index(plant.name),
                                     cases_of(plant).index(case)])
        self.plant, self.case, self.model = plant, case, model
        exact, self.level, self.fits, fitted = models(plant.name)
        self.steps = exact if model == "exact" else fitted
        self.onset = SAMPLES // 2 if case == "bias" or seed % 2 == 0 else 0
        self.touched = int(rng.integers(len(plant.cvs)))  # the CV of span and bias
        self.sticks = int(rng.integers(len(plant.mvs)))
        self.changed = dict(plant.numbers)
        if case in plant.changes:
            key, factor = plant.changes[case]
            self.changed[key] *= factor
        self.inputs, self.cvs, self.setpoints = self.simulate(rng)
        self.errors = self.judge_channels()

    def simulate(self, rng):
        plant, mvs, cvs = self.plant, len(self.plant.mvs), len(self.plant.cvs)
        reach = 2.0 if self.case == "far" else 1.0
        setpoints = np.column_stack([
            level + levels(rng, SAMPLES, 60, 200, lambda b=band: reach * rng.uniform(-b, b))
            for level, band in zip(self.level, plant.band)])
        dvs = np.column_stack([np.zeros(SAMPLES)] + [
            levels(rng, SAMPLES, 80, 250, lambda m=usual: rng.normal(0.0, m))
            for usual in plant.moves[mvs:]])[:, 1:] + plant.rest[mvs:]
        load = plant.load * filtered(rng, SAMPLES, 1, 0.95)[:, 0]
        noise = plant.band * (0.05 * filtered(rng, SAMPLES, cvs, 0.9)
                              + 0.02 * rng.standard_normal((SAMPLES, cvs)))
        ramps = np.isin(np.arange(cvs), plant.integrating)
        controller = Dmc(self.steps, plant.band, plant.moves[:mvs], ramps, plant.limits)
        state = settled(plant, plant.rest, plant.numbers)
        inputs, measured = np.zeros((SAMPLES, len(plant.rest))), np.zeros((SAMPLES, cvs))
        position = plant.rest[:mvs].copy()
        for k in range(SAMPLES):
            on = k >= self.onset
            value = plant.measured(state) - self.level
            if on and self.case == "span":
                value[self.touched] *= SPAN
            if on and self.case == "bias":
                value[self.touched] += 0.7 * plant.band[self.touched]
            measured[k] = self.level + value + noise[k]
            wanted = controller.move(setpoints[k] - self.level, measured[k] - self.level)
            inputs[k] = np.concatenate([plant.rest[:mvs] + wanted, dvs[k]])
            controller.applied(inputs[k] - plant.rest)
            free = np.ones(mvs, bool)
            if on and self.case == "stiction":
                i = self.sticks
                free[i] = abs(inputs[k, i] - position[i]) > STICK * plant.moves[i]
            position = np.where(free, inputs[k, :mvs], position)
            acting = np.concatenate([position, dvs[k]])
            state = advance(plant, state, acting, self.changed if on else plant.numbers, load[k])
        return inputs, measured, setpoints

    def judge_channels(self):
        """CVs x inputs."""
        model = self.steps.copy()
        mean = self.inputs[self.onset:].mean(axis=0)
        true, _ = responses(self.plant, mean, self.changed, HORIZON)
        if self.case == "span":
            true[:, self.touched] *= SPAN
        away = np.abs(model - model[-1]) > 0.05 * np.abs(model).max(axis=0)
        settling = 1.5 * (HORIZON - np.argmax(away[::-1], axis=0))
        for (j, i), end in np.ndenumerate(settling):
            true[int(end):, j, i] = model[int(end):, j, i] = 0.0
        size = np.linalg.norm(model, axis=0)
        return np.linalg.norm(true - model, axis=0) / np.where(size > 0.0, size, np.inf)

    def dynamics(self, j, i):
        if self.model == "exact":
            return "step_response: [" + ", ".join(f"{v:.6g}" for v in self.steps[:, j, i]) + "]"
        fit, sample = self.fits[j][i], self.plant.sample_time
        times = ", ".join(f"{sample * time:.6g}" for time in fit.times)
        lead = f", lead: {sample * fit.lead:.6g}" if fit.lead else ""
        if fit.ramps:
            lead += ", integrating: true"
        gain = fit.gain / (sample if fit.ramps else 1.0)
        return (f"gain: {gain:.6g}, time_constants: [{times}], "
                f"dead_time: {sample * fit.dead:.6g}{lead}")

    def write(self, folder):
        plant = self.plant
        names = plant.mvs + plant.dvs
        points = [f"SP_{cv}" for cv in plant.cvs]
        lines = [f"unit: {plant.name}", f"sample_time: {plant.sample_time}", "signals:", "  mv:"]
        lines += [f"    - {{tag: {mv}}}" for mv in plant.mvs]
        lines += ["  dv:"] * bool(plant.dvs) + [f"    - {{tag: {dv}}}" for dv in plant.dvs]
        lines += ["  cv:"] + [f"    - {{tag: {cv}, setpoint: SP_{cv}}}" for cv in plant.cvs]
        lines += ["model:", "  channels:"]
        for i, name in enumerate(names):
            for j, cv in enumerate(plant.cvs):
                if self.fits[j][i]:
                    lines.append(f"    - {{cv: {cv}, mv: {name}, {self.dynamics(j, i)}}}")
        rest = dict(zip(names + plant.cvs, [*plant.rest, *self.level]))
        lines.append("  operating_point: {" + ", ".join(f"{k}: {float(v):.9g}"
                                                        for k, v in rest.items()) + "}")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "unit.yaml").write_text("\n".join(lines) + "\n")
        table = np.column_stack([plant.sample_time * np.arange(SAMPLES), self.inputs, self.cvs,
                                 self.setpoints])
        np.savetxt(folder / "data.csv", table, "%.8g", ",", comments="",
                   header=",".join(["time", *names, *plant.cvs, *points]))

    def judge(self, finding):
        names = self.plant.mvs + self.plant.dvs
        cause, cv, mv = finding["cause"], finding["cv"], finding["mv"]
        j = self.plant.cvs.index(cv) if cv else slice(None)
        i = names.index(mv) if mv else slice(None)
        if cause in CURVES:
            return "curve"
        if cause not in ACCUSES:
            level = self.case == "bias" and cause == "output_disturbance" and j == self.touched
            return "right" if level else "else"
        if self.case == "stiction" and i == self.sticks:
            return "right" if cause == "stiction" else "place"
        if cause in OF_ACTUATOR:
            return "wrong"
        error = np.max(self.errors[j, i])
        return "right" if error > WRONG else "slight" if error > SOUND else "wrong"

    def error_of(self, cv, mv):
        names = self.plant.mvs + self.plant.dvs
        return float(self.errors[self.plant.cvs.index(cv), names.index(mv)])

    def is_strong(self):
        return self.case in ("bias", "stiction") or (self.case not in ("healthy", "far")
                                                     and self.errors.max() > STRONG)


def score_case(arguments):
    name, case, seed, model, mpm, keep, limit, detect_only = arguments
    plant = next(make() for make in PHYSICAL if make.__name__ == name)
    this = Run(plant, case, seed, model)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(keep or scratch) / f"{name}-{model}-{case.replace(' ', '_')}-{seed}"
        this.write(folder)
        if limit is not None:
            with open(folder / "unit.yaml", "a", encoding="utf-8") as unit:
                unit.write(f"monitor: {{materiality: {{step_response: {limit}}}}}\n")
        given = ["--config", str(folder / "unit.yaml"), "--data", str(folder / "data.csv")]
        code, output, _ = run(mpm, ["detect", *given, "--json"])
        if code > 1:
            raise RuntimeError(f"{folder.name}: {output[-400:]}")
        detected = json.loads(output)
        alarms = sorted({f"{a['cv']}/{a['mv']}" for a in detected["alarms"]
                         if a["to"] == "active"})
        verdicts = [(this.error_of(c["cv"], c["mv"]), c["verdict"]) for c in detected["channels"]]
        result = {"plant": name, "model": model, "case": case, "seed": seed, "alarms": alarms,
                  "strong": this.is_strong(), "error": float(this.errors.max()),
                  "verdicts": verdicts}
        if detect_only:
            return result | {"verdict": "-", "reason": "", "findings": []}
        code, output, seconds = run(mpm, [
            "diagnose", *given, "--out", str(folder / "out"), "--threads", "1"])
        if code != 0:
            raise RuntimeError(f"{folder.name}: {output[-400:]}")
        report = json.loads((folder / "out" / "report.json").read_text())
    findings = [(f["cause"], f["cv"], f["mv"], f["confidence"], this.judge(f))
                for f in report["findings"]]
    return result | {"verdict": report["verdict"], "reason": report.get("reason", ""),
                     "findings": findings, "seconds": seconds}


def describe(result):
    named = [f"{cause}({','.join(filter(None, (cv, mv)))}) {sure:.3g} {is_}"
             for cause, cv, mv, sure, is_ in result["findings"]]
    return (f"{result['plant']} {result['model']} {result['case']} {result['seed']} "
            f"({result['error']:.2f}) {','.join(result['alarms']) or '-'} "
            f"{result['verdict']}: {'; '.join(named) or result['reason'] or 'nothing'}")


def row(name, results):
    def count(of, which):
        return sum(any(f[4] == which for f in r["findings"]) for r in of)

    sound = [r for r in results if r["case"] in ("healthy", "far")]
    strong = [r for r in results if r["strong"]]
    silent = [r for r in strong if r["verdict"] == "match"]
    alarmed = [r for r in sound if r["alarms"]]
    return (f"| {name} | {share(len(alarmed), len(sound))} | "
            f"{share(count(sound, 'wrong'), len(sound))} | "
            f"{share(count(strong, 'right'), len(strong))} | {len(silent)} | "
            f"{share(count(results, 'wrong'), len(results))} |")


def channels_row(name, results):
    verdicts = [v for r in results if r["case"] != "stiction" for v in r["verdicts"]]
    sound = [said for error, said in verdicts if error < SOUND]
    wrong = [said for error, said in verdicts if error > WRONG]
    return (f"| {name} | {share(sound.count('mismatch'), len(sound))} | "
            f"{share(wrong.count('mismatch'), len(wrong))} | "
            f"{share(wrong.count('match'), len(wrong))} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mpm", required=True)
    parser.add_argument("--seeds", default="100001-100003")
    parser.add_argument("--plant", nargs="+", default=[make.__name__ for make in PHYSICAL
                                                       if make.__name__ != "separator"])
    parser.add_argument("--case", nargs="+")
    parser.add_argument("--model", nargs="+", default=["exact", "reduced"])
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--step-response", type=float,
                        help="monitor.materiality.step_response of the unit files")
    parser.add_argument("--detect-only", action="store_true")
    parser.add_argument("--keep")
    parser.add_argument("--markdown")
    parser.add_argument("--bounds", action="store_true")
    options = parser.parse_args()
    plants = [make() for make in PHYSICAL if make.__name__ in options.plant]
    wanted = [(plant.name, case, seed, model, options.mpm, options.keep, options.step_response,
               options.detect_only)
              for plant in plants
              for model in options.model for seed in seed_list(options.seeds)
              for case in cases_of(plant)
              if not options.case or case in options.case]
    results = []
    with multiprocessing.Pool(options.jobs) as pool:
        for result in pool.imap(score_case, wanted):
            print(describe(result), flush=True)
            results.append(result)
    parts = [(f"{plant.name}, {model}", [r for r in results if r["plant"] == plant.name
                                         and r["model"] == model])
             for plant in plants for model in options.model] + [("all", results)]
    rows = ["| plant, its model | sound: alarm | sound: accused wrongly | strong: right | "
            "strong: match | all: wrong |", "|---|---|---|---|---|---|"]
    rows += [row(*part) for part in parts]
    channels = ["| plant, its model | sound channels: mismatch | wrong ones: mismatch | "
                "wrong ones: match |", "|---|---|---|---|"]
    channels += [channels_row(*part) for part in parts]
    table, lines = ("physical_channels", channels) if options.detect_only else ("physical", rows)
    print("\n".join(channels if options.detect_only else channels + rows))
    if options.markdown:
        file = pathlib.Path(options.markdown)
        file.write_text(replace_part(file.read_text(), table, lines))
    wrong = sum(any(f[4] == "wrong" for f in r["findings"]) for r in results)
    if options.bounds and wrong > most(len(results), MOST_WRONG):
        raise SystemExit(f"{wrong} of {len(results)} runs have a wrong finding")


if __name__ == "__main__":
    main()
