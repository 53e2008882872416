#!/usr/bin/python3
"""Writes one recording of a foreign plant: unit.yaml, data.csv and truth.json.

Shares no code, plant, number generator or controller with sim/ or tests/hidden: first and second
order channels behind dead times, sampled exactly; dynamic matrix control with a bias update, in one
regime PI controllers instead; each channel of the plant is off the controller's model by up to 2 %
of gain and 3 % of time even where nothing is wrong.

Usage: loop.py --regime R --plant P --effect E --seed N [--samples 3000] [--model-error 1]
               [--any-size] --out DIR

Regimes: regimes.py; plants: plants.py; effects: effects.py. Seeds below 1000 are for scores, from
100001 on for tuning, from 90001 on for the test that it writes the same bytes again.

truth.json: what is wrong in the words of `mpm diagnose`; `others`: what the regime itself does that
may rightly be named; by how much each channel is off; the step responses of plant and model;
`input_gains`: slope of each valve's position on its command; and the noncentrality: the sum of
squares of the effect in the CVs, with the inputs as applied, after whitening by the noise's true
model and taking out all that errors of gain, time and dead time of the channels that are not wrong
could do, and a constant. It is what the best possible test would have to go by. It does not count
what a regime hides besides (feed-forward, a disturbance that moves with a set-point, a late
change), so there it flatters.
* gain, dead_time, time_constant: of the CV.
* input_scale: over the CVs but the one with the most, since a gain there would explain that one.
* output_scale: what no gain of a single channel of the CV explains.
* the rest: what no error of any channel of the CV explains, over the CVs.
"""
import argparse
import json
import os
import pathlib

try:
    import numpy as np
except ImportError:
    raise SystemExit("loop.py: needs numpy (python3-numpy)") from None

import effects
import regimes
from channels import Simulator, discrete_form, respond, step_response
from controller import LIMIT, Dmc, Pi
from plants import PLANTS

GAIN_ERROR, TIME_ERROR = 0.02, 0.03  # of every channel, at most
MOST_CV, MOST_CLIPPED = 25.0, 0.3  # usual set-point moves; share of samples
STEP_POINTS = 80
PAST_LAGS, PAST_MEANS = 8, (24, 80, 250, 800)  # of a CV, samples
CV_ORIGIN, MV_ORIGIN, AUX_ORIGIN = 50.0, 30.0, 20.0  # values at the operating point


def simulate(regime, plant, outside, hidden, samples, present=None, healthy=None):
    """CVs as measured, MVs as applied, valve positions. `present`: of each sample, whether the
    channels are the hidden ones; where not, what it reads is what `healthy` channels would give."""
    controller = Pi(plant) if regime == "pi_control" else Dmc.of(plant)
    simulator = Simulator(hidden["channels"], plant.cv_count, plant.mv_count + 1)
    other = (Simulator(healthy, plant.cv_count, plant.mv_count + 1) if present is not None else
             None)
    added = outside.noise + hidden["added"]
    if hidden["aux"] is not None:
        added[:, hidden["aux"].cv] += respond(hidden["aux"], outside.aux)
    cvs = np.zeros((samples, plant.cv_count))
    mvs, positions = (np.zeros((samples, plant.mv_count)) for _ in range(2))
    limit = LIMIT * np.array(plant.mv_scale)
    clean, manual = np.zeros(plant.cv_count), np.zeros(plant.mv_count)
    inputs = np.zeros(plant.mv_count + 1)
    analysed, every = outside.reading
    read = np.ones(plant.cv_count, bool)
    for k in range(samples):
        cvs[k] = hidden["sensor"] * clean + added[k]
        read[analysed] = k == 0 or k // every > (k - 1) // every
        if not read[analysed]:
            cvs[k, analysed] = cvs[k - 1, analysed]
        wanted = (controller.move(outside.setpoints[k], cvs[k], read) + outside.feedforward[k] -
                  manual)
        manual = outside.feedforward[k]
        mvs[k] = np.clip(wanted, -limit, limit)
        inputs[:-1], inputs[-1] = mvs[k], outside.dv[k]
        controller.applied(inputs)
        positions[k] = mvs[k]
        for mv, valve in hidden["valve"].items():
            positions[k, mv] = valve(k, mvs[k, mv])
        inputs[:-1] = positions[k]
        clean = simulator.step(inputs)
        if other is not None:
            sound = other.step(inputs)
            clean = clean if present[k] else sound
    return cvs, mvs, positions


def stays_put(plant, cvs, mvs, free):
    if not np.isfinite(cvs).all() or np.abs(cvs / plant.cv_scale).max() > MOST_CV:
        return False
    clipped = (np.abs(mvs) > 0.999 * LIMIT * np.array(plant.mv_scale)).mean(axis=0)
    return all(share < MOST_CLIPPED for mv, share in enumerate(clipped) if mv != free)


def sensitivities(channel, values):
    """Of a channel's output to its gain, time scale and dead time."""
    base = respond(channel, values)
    columns = [base, (respond(channel.with_dead(0.25), values) - base) / 0.25]
    if channel.has_time:
        columns.append((respond(channel.with_time(1.02), values) - base) / 0.02)
    return columns


def own_past(values):
    """The lags and means that an autoregression of the values has."""
    columns = [np.concatenate([np.zeros(lag), values[:-lag]]) for lag in range(1, PAST_LAGS + 1)]
    for length in PAST_MEANS:
        kept, mean = np.exp(-1 / length), np.zeros(len(values))
        for k in range(1, len(values)):
            mean[k] = kept * mean[k - 1] + (1 - kept) * values[k - 1]
        columns.append(mean)
    return columns


def left(target, columns, whiten, white=()):
    """Sum of squares of the whitened target that the columns, and the white ones, which are not
    whitened, do not explain."""
    both = np.column_stack([whiten(np.column_stack([target] + columns)), *white])
    sizes = np.linalg.norm(both[:, 1:], axis=0)
    basis, triangle = np.linalg.qr(both[:, 1:] / np.maximum(sizes, 1e-300))
    basis = basis[:, np.abs(np.diag(triangle)) > 1e-7]
    rest = both[:, 0] - basis @ (basis.T @ both[:, 0])
    return float(rest @ rest)


def noncentrality(plant, healthy, hidden, outside, truth, mvs, positions):
    cause, mv = truth["cause"], truth["mv"]
    if cause is None:
        return 0.0
    inputs = np.column_stack([mvs, outside.dv])
    changed = set()
    per_cv = np.zeros(plant.cv_count)
    for i in range(plant.cv_count):
        target = hidden["added"][:, i].copy()
        if hidden["aux"] is not None and hidden["aux"].cv == i:
            target += respond(hidden["aux"], outside.aux)
        columns = [np.ones(len(mvs))] + list(outside.regressors[i])
        rivals = []
        for before, after in zip(healthy, hidden["channels"]):
            if before.cv != i:
                continue
            given = inputs[:, before.input]
            mine = (before is not after) or hidden["sensor"][i] != 1.0
            if before is not after:
                target += respond(after, given) - respond(before, given)
            if before.input == mv and hidden["valve"]:
                target += respond(before, positions[:, mv] - mvs[:, mv])
            if hidden["sensor"][i] != 1.0:
                target += (hidden["sensor"][i] - 1.0) * respond(before, given)
                rivals.append(respond(before, given))
            if not mine:
                columns += sensitivities(before, given)
            else:
                changed.add(i)
        if not np.any(target):
            continue
        whiten = outside.noise_models[i].whitened
        per_cv[i] = min((left(target, columns + [rival], whiten) for rival in rivals),
                        default=left(target, columns, whiten))
    if cause == "input_scale" and len(changed) > 1:
        return float(per_cv.sum() - per_cv.max())
    return float(per_cv.sum())


def learnt_noise(plant, healthy, hidden, outside, truth, mvs):
    if truth["cause"] not in ("gain", "dead_time", "time_constant"):
        return None
    inputs = np.column_stack([mvs, outside.dv])
    cv = truth["cv"]
    columns, target = [np.ones(len(mvs))] + list(outside.regressors[cv]), np.zeros(len(mvs))
    own = {c.input for c in healthy if c.cv == cv}
    for before, after in zip(healthy, hidden["channels"]):
        given = inputs[:, before.input]
        if before is not after:
            target += respond(after, given) - respond(before, given)
        elif before.cv == cv:
            columns += sensitivities(before, given)
        elif before.input not in own:  # as it acts on another CV, it may act on this one
            columns.append(respond(before, given))
    past = own_past(target + outside.noise[:, cv])
    return left(target, columns, outside.noise_models[cv].whitened, past)


def unit_file(plant):
    """The model, in seconds; flat style, one channel a line."""
    dt = plant.sample_time
    lines = [f"unit: {plant.name}", f"sample_time: {dt:g}  # s", "signals:", "  mv:"]
    lines += [f"    - {{tag: u{j + 1}}}" for j in range(plant.mv_count)]
    lines += ["  dv:", "    - {tag: d1}", "  cv:"]
    lines += [f"    - {{tag: y{i + 1}, setpoint: sp{i + 1}}}" for i in range(plant.cv_count)]
    lines += ["  aux:", "    - {tag: aux}", "model:", "  channels:"]
    for c in plant.channels:
        place = f"cv: y{c.cv + 1}, " + (f"mv: u{c.input + 1}" if c.input < plant.dv else "dv: d1")
        if c.damped:
            numerator, denominator, delay = discrete_form(c)
            text = (f"numerator: [{', '.join(f'{v:.12g}' for v in numerator)}], denominator: "
                    f"[{', '.join(f'{v:.12g}' for v in denominator)}], delay_samples: {delay}")
        else:
            gain = c.gain / dt if c.integrating else c.gain
            text = f"gain: {gain:.10g}, dead_time: {c.dead * dt:.10g}"
            if c.lags:
                text += f", time_constants: [{', '.join(f'{t * dt:.10g}' for t in c.lags)}]"
            if c.lead:
                text += f", lead: {c.lead * dt:.10g}"
            if c.integrating:
                text += ", integrating: true"
        lines.append(f"    - {{{place}, {text}}}")
    origin = [f"u{j + 1}: {MV_ORIGIN:g}" for j in range(plant.mv_count)]
    origin += [f"y{i + 1}: {CV_ORIGIN:g}" for i in range(plant.cv_count)] + ["d1: 0"]
    lines.append(f"  operating_point: {{{', '.join(origin)}}}")
    return "\n".join(lines) + "\n"


def tags(plant, item):
    """Numbers of signals into tags."""
    named = dict(item)
    named["cv"] = None if item.get("cv") is None else f"y{item['cv'] + 1}"
    named["mv"] = None if item.get("mv") is None else f"u{item['mv'] + 1}"
    return named


def make(regime, name, effect, seed, samples, model_error, any_size, present=None):
    plant = PLANTS[name]()
    key = [seed, regimes.REGIMES.index(regime), list(PLANTS).index(name),
           effects.EFFECTS.index(effect)]
    for attempt in range(60):
        rng = np.random.default_rng(key + [attempt])
        outside = regimes.draw(regime, plant, samples, rng)
        healthy = tuple(
            c.with_gain(1 + model_error * rng.uniform(-GAIN_ERROR, GAIN_ERROR)).with_time(
                1 + model_error * rng.uniform(-TIME_ERROR, TIME_ERROR)) for c in plant.channels)
        nothing, _ = effects.draw("none", plant, healthy, None, None, samples, rng)
        pilot = simulate(regime, plant, outside, nothing, samples)
        if not stays_put(plant, pilot[0], pilot[1], None):
            continue
        noise = [regimes.noise_sd(model) for model in outside.noise_models]
        hidden, truth = effects.draw(effect, plant, healthy, pilot[1].std(axis=0), noise,
                                     samples, rng, any_size)
        cvs, mvs, positions = (pilot if effect == "none" else
                               simulate(regime, plant, outside, hidden, samples, present, healthy))
        if stays_put(plant, cvs, mvs, truth["mv"] if hidden["valve"] else None):
            break
    else:
        raise SystemExit(f"loop.py: no draw of {regime} {name} {effect} {seed} that a loop stands")
    value = noncentrality(plant, healthy, hidden, outside, truth, mvs, positions)
    learnt = learnt_noise(plant, healthy, hidden, outside, truth, mvs)
    slopes = {}
    for j in range(plant.mv_count):
        spread = mvs[:, j].var()
        sticks = truth["cause"] == "stiction" and truth["mv"] == j and spread > 0
        slopes[f"u{j + 1}"] = (float(np.cov(positions[:, j], mvs[:, j])[0, 1] /
                                     mvs[:, j].var(ddof=1)) if sticks else 1.0)
    horizon = int(max(c.settling() for c in plant.channels))
    stride = max(1, horizon // STEP_POINTS)
    steps = []
    for model, true in zip(plant.channels, hidden["channels"]):
        tag = f"u{true.input + 1}" if true.input < plant.dv else "d1"
        true = true.with_gain(float(hidden["sensor"][true.cv]))
        steps.append({"cv": f"y{true.cv + 1}", "input": tag, "gain_ratio": true.gain / model.gain,
                      "time_constant_ratio": (true.time_scale / model.time_scale if true.has_time
                                              else None),
                      "dead_time": model.dead * plant.sample_time,
                      "dead_time_error": (true.dead - model.dead) * plant.sample_time,
                      "plant": step_response(true, horizon + 1)[::stride].tolist(),
                      "model": step_response(model, horizon + 1)[::stride].tolist()})
    truth = tags(plant, truth)
    if truth["onset"] is not None:
        truth["onset"] *= plant.sample_time
    truth.update(
        regime=regime, plant=name, effect=effect, seed=seed, samples=samples,
        attempts=attempt + 1, sample_time=plant.sample_time, noncentrality=value,
        noncentrality_learnt_noise=learnt,
        others=[tags(plant, item) for item in outside.causes], input_gains=slopes,
        stride=stride, channels=steps)
    return plant, outside, cvs, mvs, truth, rng


def write(regime, name, effect, seed, samples, out, model_error=1.0, any_size=False,
          present=None):
    """Writes the three files and returns the truth. `model_error` scales what every model is off
    by; `any_size`: effects.draw; `present`: simulate(). The noncentralities are those of an error
    that is always there."""
    plant, outside, cvs, mvs, truth, rng = make(regime, name, effect, seed, samples, model_error,
                                                any_size, present)
    cvs, mvs = regimes.logged(regime, plant, outside.noise_models, cvs, mvs, rng)
    header = (["time"] + [f"u{j + 1}" for j in range(plant.mv_count)] + ["d1"] +
              [f"y{i + 1}" for i in range(plant.cv_count)] +
              [f"sp{i + 1}" for i in range(plant.cv_count)] + ["aux"])
    table = np.column_stack([plant.sample_time * np.arange(samples), mvs + MV_ORIGIN, outside.dv,
                             cvs + CV_ORIGIN, outside.setpoints + CV_ORIGIN,
                             outside.aux + AUX_ORIGIN])
    out = pathlib.Path(out)
    os.makedirs(out, exist_ok=True)
    np.savetxt(out / "data.csv", table, fmt="%.8g", delimiter=",", header=",".join(header),
               comments="")
    (out / "unit.yaml").write_text(unit_file(plant))
    (out / "truth.json").write_text(json.dumps(truth, indent=1, default=float) + "\n")
    return truth


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--regime", choices=regimes.REGIMES, required=True)
    parser.add_argument("--plant", choices=list(PLANTS), required=True)
    parser.add_argument("--effect", choices=effects.EFFECTS, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--samples", type=int, default=3000)
    parser.add_argument("--model-error", type=float, default=1.0)
    parser.add_argument("--any-size", action="store_true")
    parser.add_argument("--out", required=True)
    args = parser.parse_args()
    truth = write(args.regime, args.plant, args.effect, args.seed, args.samples, args.out,
                  args.model_error, args.any_size)
    print(f"{args.regime} {args.plant} {args.effect} {args.seed}: "
          f"noncentrality {truth['noncentrality']:.0f}")


if __name__ == "__main__":
    main()
