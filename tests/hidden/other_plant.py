#!/usr/bin/python3
"""A second, independent plant with something hidden in it, to try `mpm diagnose` on.

Shares no code, number generator or controller with sim/ or the other hidden plants: the Shell 3x3
plant (Carlsson 2010, eq. 4.1) as differential equations, each channel a slow and a fast lag in
series behind a shorter dead time, integrated with 20 steps a sample; PI controllers behind a static
decoupler; set-points of random level and hold; noise that wanders plus white sensor noise. So even
with nothing hidden the plant is only nearly the model.

Usage: other_plant.py --effect EFFECT --seed N --csv OUT.csv --truth OUT.json
                      [--unit OUT.yaml] [--samples N]

EFFECT: none gain dead_time time_constant stiction sensor_offset sensor_drift unmodelled_input
input_nonlinearity. The CSV is for config/plants/shell3x3.yaml; with unmodelled_input it has a
column t_amb besides, and --unit writes the unit file that names it. Seeds below 1000 are for
scores, from 100001 on for tuning.
"""
import argparse
import json
import pathlib

import numpy as np

K = np.array([[4.05, 1.77, 5.88], [5.39, 5.72, 6.90], [4.38, 4.42, 7.20]])
TAU = np.array([[50.0, 60, 50], [50, 60, 40], [33, 44, 19]])
DEAD = np.array([[6.0, 7, 6], [4, 3, 3], [5, 5, 0]])
STEPS = 20  # integration steps a sample
FAST_LAG = 0.4  # s, of each channel that has as much dead time, which gets shorter by it
UNIT_FILE = pathlib.Path(__file__).parents[2] / "config/plants/shell3x3.yaml"
EFFECTS = ["none", "gain", "dead_time", "time_constant", "stiction", "sensor_offset",
           "sensor_drift", "unmodelled_input", "input_nonlinearity"]
WANDER, SENSOR = (0.01, 0.94), 0.004  # s.d. of the innovations and pole; s.d.
NOISE_SD = float(np.hypot(WANDER[0] / np.sqrt(1 - WANDER[1] ** 2), SENSOR))
PI_GAIN, PI_TIME = 2.0, 45.0  # of a decoupled loop, whose gain is 1
MV_RANGE = np.array([1.85, 1.3, 1.0])  # that a healthy loop uses, 2 .. 98 %
MV_LIMIT = 5.0


class Valve:
    """Sticks until its strain passes static friction, then slips and sticks again (He 2007)."""

    def __init__(self, band, jump):
        self.static, self.kinetic = (band + jump) / 2, (band - jump) / 2
        self.position = self.strain = self.last = 0.0

    def __call__(self, command):
        self.strain += command - self.last
        self.last = command
        if abs(self.strain) > self.static:
            slip = np.sign(self.strain)
            self.position = command - slip * self.kinetic
            self.strain = slip * self.kinetic
        return self.position


class Lags:
    """Two lags in series behind a dead time, for a matrix of channels; midpoint rule."""

    def __init__(self, gain, slow, fast, dead):
        self.gain, self.slow, self.fast = gain, slow, fast
        self.delay = np.rint(dead * STEPS).astype(int)
        self.past = np.zeros((self.delay.max() + 1, gain.shape[1]))
        self.first, self.second = np.zeros_like(gain), np.zeros_like(gain)
        self.columns = np.arange(gain.shape[1])[None, :]
        self.now = 0

    def step(self, inputs):
        h = 1.0 / STEPS
        length = len(self.past)
        for _ in range(STEPS):
            self.now = (self.now + 1) % length
            self.past[self.now] = inputs
            seen = self.gain * self.past[(self.now - self.delay) % length, self.columns]
            slope = (seen - self.first) / self.slow
            middle = self.first + h / 2 * slope
            onward = (self.first - self.second) / self.fast
            self.first = self.first + h * (seen - middle) / self.slow
            self.second = self.second + h * (middle - self.second - h / 2 * onward) / self.fast
        return self.second.sum(axis=1)


class Controller:
    """PI control of each CV on a filtered error, turned into moves by the inverse of the gains."""

    def __init__(self):
        self.decouple = np.linalg.inv(K)
        self.integral, self.error = np.zeros(3), np.zeros(3)

    def __call__(self, setpoint, measured):
        self.error = self.error + 0.15 * (setpoint - measured - self.error)
        step = PI_GAIN / PI_TIME * self.error
        wanted = PI_GAIN * self.error + self.integral + step
        moves = self.decouple @ wanted
        if np.all(np.abs(moves) < MV_LIMIT):
            self.integral = self.integral + step
        return np.clip(moves, -MV_LIMIT, MV_LIMIT)


def stabilisable(gain):
    """Whether an offset-free controller that believes in K can hold these gains."""
    return np.linalg.eigvals(gain @ np.linalg.inv(K)).real.min() > 0.2


def wandering(rng, samples, innovation, pole):
    value, result = 0.0, np.zeros(samples)
    for k in range(-200, samples):
        value = pole * value + innovation * rng.standard_normal()
        if k >= 0:
            result[k] = value
    return result


def setpoints(rng, samples):
    result = np.zeros((samples, 3))
    for j in range(3):
        k = 0
        while k < samples:
            hold = rng.integers(70, 140)
            result[k:k + hold, j] = rng.uniform(0.2, 0.6) * rng.choice([-1, 1])
            k += hold
    return result


def draw(effect, rng, samples):
    """What is hidden: the plant's numbers, and the truth in the words of `mpm diagnose`."""
    cv, mv = rng.integers(3), rng.integers(3)
    plant = {"gain": K.copy(), "tau": TAU.copy(), "dead": DEAD.copy(), "valve": {},
             "added": np.zeros((samples, 3)), "ambient": None}
    truth = {"effect": effect, "cause": effect, "cv": None, "mv": None, "tag": None,
             "kind": None, "onset": None, "parameters": {}}
    if effect in ("gain", "dead_time", "time_constant"):
        truth["cv"], truth["mv"] = f"y{cv + 1}", f"u{mv + 1}"
    elif effect in ("stiction", "input_nonlinearity"):
        truth["mv"] = f"u{mv + 1}"
    elif effect != "none":
        truth["cv"] = f"y{cv + 1}"

    if effect == "gain":
        ratio = 1 + rng.choice([-1, 1]) * rng.uniform(0.1, 0.3)
        plant["gain"][cv, mv] *= ratio
        truth["parameters"] = {"gain_ratio": ratio}
    elif effect == "dead_time":
        error = rng.uniform(2, 6)
        plant["dead"][cv, mv] += error
        truth["parameters"] = {"dead_time_error": error}
    elif effect == "time_constant":
        ratio = rng.choice([rng.uniform(0.7, 0.85), rng.uniform(1.2, 1.6)])
        plant["tau"][cv, mv] *= ratio
        truth["parameters"] = {"time_constant_ratio": ratio}
    elif effect == "stiction":
        band = rng.uniform(0.04, 0.15) * MV_RANGE[mv]
        jump = rng.uniform(0.3, 1.0) * band
        plant["valve"][mv] = Valve(band, jump)
        truth["parameters"] = {"band": band, "jump": jump}
    elif effect == "input_nonlinearity":
        # Equal percentage: the local gain goes up or down by 20 .. 50 % over the MV's range.
        bend = rng.choice([-1, 1]) * np.log(rng.uniform(1.2, 1.5)) / MV_RANGE[mv]
        plant["valve"][mv] = lambda u: np.expm1(bend * u) / bend
        truth["kind"] = "polynomial"
        truth["parameters"] = {"quadratic": bend / 2}
    elif effect in ("sensor_offset", "sensor_drift"):
        onset = int(rng.uniform(0.07, 0.45) * samples)
        size = rng.choice([-1, 1]) * rng.uniform(3, 10) * NOISE_SD
        since = np.maximum(0, np.arange(samples) - onset)
        offset = effect == "sensor_offset"
        plant["added"][:, cv] = size * (since > 0) if offset else size * since / since[-1]
        truth["cause"], truth["kind"] = "output_disturbance", "step" if offset else "drift"
        truth["onset"] = float(onset + 1)
        truth["parameters"] = {"size": size} if offset else {"rate": size / int(since[-1])}
    elif effect == "unmodelled_input":
        day = np.sin(2 * np.pi * (np.arange(samples) / rng.uniform(500, 900) + rng.uniform()))
        ambient = 15 + 2 * day + wandering(rng, samples, 0.5, 0.96)
        gain = rng.choice([-1, 1]) * rng.uniform(1.0, 2.0) * NOISE_SD / ambient.std()
        slow, dead = rng.uniform(8, 30), rng.uniform(0, 6)
        plant["ambient"] = ambient
        plant["ambient_lags"] = Lags(np.array([[gain]]), slow, 0.3 * slow, np.array([[dead]]))
        truth["tag"] = "t_amb"
        truth["parameters"] = {"gain": gain}
        plant["ambient_cv"] = cv
    return plant, truth


def run(plant, rng, samples):
    """time, MVs, CVs, set-points; y(k) is measured, then u(k) set, which acts until k+1."""
    fast = np.where(plant["dead"] > FAST_LAG, FAST_LAG, 1.0 / STEPS)
    dead = np.maximum(0.0, plant["dead"] - fast)
    lags = Lags(plant["gain"], plant["tau"], fast, dead)
    controller = Controller()
    wanted = setpoints(rng, samples)
    noise = np.column_stack([wandering(rng, samples, *WANDER) for _ in range(3)])
    noise += SENSOR * rng.standard_normal((samples, 3)) + plant["added"]
    clean = np.zeros(3)
    out = np.zeros((samples, 10))
    for k in range(samples):
        measured = clean + noise[k]
        moves = controller(wanted[k], measured)
        out[k] = np.concatenate([[k], moves, measured, wanted[k]])
        positions = moves.copy()
        for mv, valve in plant["valve"].items():
            positions[mv] = valve(moves[mv])
        clean = lags.step(positions)
        if plant["ambient"] is not None:
            outside = plant["ambient"][k] - plant["ambient"][0]
            clean = clean.copy()
            clean[plant["ambient_cv"]] += plant["ambient_lags"].step(np.array([outside]))[0]
    return out


def stays_put(data):
    return (np.isfinite(data).all() and np.abs(data[:, 1:4]).max() < 0.8 * MV_LIMIT and
            np.abs(data[:, 4:7]).max() < 3.0)


def unit_file():
    """config/plants/shell3x3.yaml with the ambient temperature among its signals."""
    text = UNIT_FILE.read_text()
    return text.replace("model:\n", "  aux:\n    - {tag: t_amb, unit: degC}\nmodel:\n", 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--effect", choices=EFFECTS, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--csv", required=True)
    parser.add_argument("--truth", required=True)
    parser.add_argument("--unit")
    parser.add_argument("--samples", type=int, default=3000)
    args = parser.parse_args()
    for attempt in range(100):
        rng = np.random.default_rng([args.seed, EFFECTS.index(args.effect), attempt])
        plant, truth = draw(args.effect, rng, args.samples)
        if not stabilisable(plant["gain"]):
            continue
        data = run(plant, rng, args.samples)
        if stays_put(data):
            break
    else:
        raise SystemExit("other_plant.py: no draw was one that the loop can stand")

    names = ["time", "u1", "u2", "u3", "y1", "y2", "y3", "sp1", "sp2", "sp3"]
    if plant["ambient"] is not None:
        names.append("t_amb")
        data = np.column_stack([data, plant["ambient"]])
    np.savetxt(args.csv, data, fmt="%.9g", delimiter=",", header=",".join(names), comments="")
    truth.update(seed=args.seed, samples=args.samples, attempts=attempt + 1)
    pathlib.Path(args.truth).write_text(json.dumps(truth, indent=1, default=float) + "\n")
    if args.unit:
        pathlib.Path(args.unit).write_text(
            unit_file() if plant["ambient"] is not None else UNIT_FILE.read_text())


if __name__ == "__main__":
    main()
