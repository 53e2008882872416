"""What goes on around a foreign loop: set-points, noise, disturbances, and how they are logged.

stationary            ARMA noise, moving set-points
random_walk           what disturbs the CVs integrates
day_night             a cycle of several hundred samples and its second harmonic
constant_setpoints    nothing moves from outside but the noise
rare_moves            one set-point moves once or twice
hidden_feedforward    an operator moves an MV against a disturbance that nobody measures
aux_disturbance       a measured signal acts on a CV and, by feed-forward, on an MV
setpoint_disturbance  a disturbance moves with a set-point
quantised             CVs are logged in steps of 0.3 to 1 s.d. of the noise
compressed            CVs and MVs are logged again only once they have moved by a deadband
finely_compressed     CVs are logged again only once they have moved by a twentieth of the noise
analyser              one CV is logged every 2 to 12 samples, and stands until the next; the
                      controller sees every sample
analyser_controlled   one CV is read every 2 to 12 samples, whole or not, and that is all the
                      controller sees, too
late                  drift, step or noise x 2.9 from the last third on
injected_steps        constant set-points, and load steps that the loop answers
noisy_walk            what disturbs the CVs integrates slowly, under measurement noise
pi_control            as stationary, but each CV has a PI controller of its own: no MPC
"""
import dataclasses

import numpy as np

REGIMES = ["stationary", "random_walk", "day_night", "constant_setpoints", "rare_moves",
           "hidden_feedforward", "aux_disturbance", "setpoint_disturbance", "quantised",
           "compressed", "finely_compressed", "analyser", "analyser_controlled", "late",
           "injected_steps", "noisy_walk", "pi_control"]
STILL = ("constant_setpoints", "rare_moves", "injected_steps")  # neither set-points nor the DV move


@dataclasses.dataclass
class Noise:
    """(1 - pole q^-1)(1 - q^-1)^integrated n = (1 + zero q^-1) e."""

    pole: float
    zero: float
    integrated: bool
    innovation: float  # s.d.

    def draw(self, rng, samples):
        value = before = 0.0
        result = np.zeros(samples + 300)
        for k, e in enumerate(self.innovation * rng.standard_normal(len(result))):
            value = self.pole * value + e + self.zero * before
            before = e
            result[k] = value
        result = result[300:]
        return np.cumsum(result) if self.integrated else result

    def whitened(self, columns):
        """In s.d. of the innovations."""
        lagged = np.vstack([np.zeros(columns.shape[1]), columns[:-1]])
        result = columns - self.pole * lagged
        if self.integrated:
            result = result - np.vstack([np.zeros(columns.shape[1]), result[:-1]])
        for k in range(1, len(result)):
            result[k] -= self.zero * result[k - 1]
        return result / self.innovation


def noise_of(regime, plant, rng):
    models = []
    for scale in plant.cv_scale:
        if regime == "random_walk":
            models.append(Noise(0.0, float(rng.uniform(-0.7, -0.2)), True,
                                float(rng.uniform(0.015, 0.04)) * scale))
            continue
        if regime == "noisy_walk":  # a walk under white noise is IMA(1, 1) (Muth 1960)
            models.append(Noise(0.0, float(rng.uniform(-0.96, -0.8)), True,
                                float(rng.uniform(0.03, 0.09)) * scale))
            continue
        pole, zero = float(rng.uniform(*plant.noise_pole)), float(rng.uniform(-0.4, 0.3))
        sd = float(rng.uniform(0.03, 0.09)) * scale
        gain = np.sqrt(1 + (pole + zero)**2 / (1 - pole**2))
        models.append(Noise(pole, zero, False, sd / gain))
    return models


def noise_sd(model):
    """Of what wanders about; of an integrating one over some ten samples."""
    if model.integrated:
        return 3.0 * model.innovation * (1 + model.zero)
    return model.innovation * np.sqrt(1 + (model.pole + model.zero)**2 / (1 - model.pole**2))


def levels(rng, samples, hold, size):
    """Random levels, held for random times."""
    result, k = np.zeros(samples), 0
    while k < samples:
        until = k + int(rng.integers(*hold))
        result[k:until] = size * rng.choice([-1, 1]) * rng.uniform(0.4, 1.0)
        k = until
    return result


def wandering(rng, samples, pole):
    """Of s.d. 1."""
    value, result = 0.0, np.zeros(samples)
    for k in range(-200, samples):
        value = pole * value + np.sqrt(1 - pole**2) * rng.standard_normal()
        if k >= 0:
            result[k] = value
    return result


def lagged(values, time):
    result, value = np.zeros(len(values)), 0.0
    for k, target in enumerate(values):
        value += (target - value) / time
        result[k] = value
    return result


@dataclasses.dataclass
class Outside:
    setpoints: np.ndarray
    dv: np.ndarray
    aux: np.ndarray
    noise: np.ndarray  # as measured, with everything that disturbs
    feedforward: np.ndarray  # added to the MVs by an operator or by feed-forward
    noise_models: list
    causes: list  # in the words of a diagnosis: what of that may rightly be named
    regressors: list  # per CV: shapes of which the best possible test does not know the size
    reading: tuple = (0, 1.0)  # a CV, and every how many samples it is read, whole or not


def draw(regime, plant, samples, rng):
    models = noise_of(regime, plant, rng)
    sd = [noise_sd(model) for model in models]
    noise = np.column_stack([model.draw(rng, samples) for model in models])
    setpoints = np.column_stack([levels(rng, samples, plant.hold, scale)
                                 for scale in plant.cv_scale])
    dv = plant.dv_scale * (0.6 * wandering(rng, samples, 0.97) +
                           levels(rng, samples, plant.hold, 0.7))
    aux = wandering(rng, samples, 0.985)
    feedforward = np.zeros((samples, plant.mv_count))
    causes, regressors = [], [[] for _ in range(plant.cv_count)]
    cv = int(rng.integers(plant.cv_count))
    paired = [c for c in plant.channels if c.cv == cv and c.input < plant.dv]
    main = max(paired, key=lambda c: abs(c.gain) * plant.mv_scale[c.input])
    time = np.arange(samples)
    onset = int(rng.uniform(0.67, 0.8) * samples)
    if regime in STILL:
        setpoints[:], dv[:] = 0.0, 0.0

    def compensate(disturbance):
        """What of it a crude feed-forward takes away; an integrating CV needs its slope."""
        share = float(rng.uniform(0.4, 0.9))
        if main.integrating:
            size = np.concatenate([[0.0], np.diff(lagged(disturbance, 15.0))])
        else:
            size = lagged(disturbance, 5.0)
        feedforward[:, main.input] = np.clip(-share * size / main.gain,
                                             -plant.mv_scale[main.input],
                                             plant.mv_scale[main.input])

    def disturb(values, cause="output_disturbance", tag=None):
        noise[:, cv] += values
        causes.append({"cause": cause, "cv": cv, "tag": tag})

    if regime in ("random_walk", "day_night"):
        causes += [{"cause": "output_disturbance", "cv": i, "tag": None}
                   for i in range(plant.cv_count)]
    if regime == "day_night":
        period = float(rng.uniform(400, 700))
        swing = 1 + 0.2 * wandering(rng, samples, 0.998)
        for i in range(plant.cv_count):
            size, phase = rng.uniform(2, 5) * sd[i], rng.uniform(0, 2 * np.pi)
            angle = 2 * np.pi * time / period + phase
            noise[:, i] += size * swing * (np.sin(angle) + 0.3 * np.sin(2 * angle + 1))
            regressors[i] = [f(m * angle) for m in (1, 2) for f in (np.sin, np.cos)]
    elif regime == "rare_moves":
        for _ in range(int(rng.integers(1, 3))):
            setpoints[int(rng.uniform(0.1, 0.9) * samples):, cv] += (
                rng.choice([-1, 1]) * rng.uniform(0.5, 1.0) * plant.cv_scale[cv])
    elif regime == "hidden_feedforward":
        hidden = wandering(rng, samples, 0.98) + levels(rng, samples, plant.hold, 1.0)
        values = lagged(rng.uniform(2, 5) * sd[cv] * hidden, 12.0)
        disturb(values)
        compensate(values)
    elif regime == "aux_disturbance":
        values = lagged(rng.uniform(2, 5) * sd[cv] * aux, 12.0)
        disturb(values, "unmodelled_input", "aux")
        compensate(values)
    elif regime == "setpoint_disturbance":
        other = int(rng.integers(plant.cv_count))
        values = lagged(setpoints[:, other], 10.0) * rng.uniform(0.15, 0.4) * rng.choice([-1, 1])
        disturb(values * plant.cv_scale[cv] / plant.cv_scale[other])
        causes.append({"cause": "unmodelled_input", "cv": cv, "tag": f"sp{other + 1}"})
    elif regime == "late":
        kind = rng.choice(["drift", "step", "noise"])
        size = rng.choice([-1, 1]) * rng.uniform(4, 10) * sd[cv]
        since = np.maximum(0, time - onset)
        if kind == "noise":
            noise[onset:, cv] *= 2.9
            causes.append({"cause": "noise", "cv": cv, "tag": None})
        else:
            disturb(size * (since > 0) if kind == "step" else size * since / since[-1])
    elif regime == "injected_steps":
        # Into every CV: a load that comes and goes, through a lag.
        for cv in range(plant.cv_count):
            steps = levels(rng, samples, (150, 500), rng.uniform(6, 15) * sd[cv])
            steps[:int(rng.integers(50, 200))] = 0.0
            values = lagged(steps, float(rng.uniform(3, 15)))
            disturb(values)
            regressors[cv] = [values]
    reading = (0, 1.0)
    if regime == "analyser_controlled":
        every = float(rng.uniform(2, 12))
        reading = int(rng.integers(plant.cv_count)), every if rng.random() < 0.5 else round(every)
    return Outside(setpoints, dv, aux, noise, feedforward, models, causes, regressors, reading)


def logged(regime, plant, models, cvs, mvs, rng):
    """The CVs and MVs as a historian gives them back."""
    cvs, mvs = cvs.copy(), mvs.copy()
    if regime == "quantised":
        for i, model in enumerate(models):
            step = rng.uniform(0.3, 1.0) * noise_sd(model)
            cvs[:, i] = step * np.rint(cvs[:, i] / step)
    elif regime == "compressed":
        for i, model in enumerate(models):
            hold(cvs[:, i], rng.uniform(0.3, 1.0) * noise_sd(model))
        for j in range(plant.mv_count):
            hold(mvs[:, j], 0.5 * np.diff(mvs[:, j]).std())
    elif regime == "finely_compressed":
        for i, model in enumerate(models):
            hold(cvs[:, i], 0.05 * noise_sd(model))
    elif regime == "analyser":
        # One CV is read seldom, and the reading stands until the next.
        cv, every = int(rng.integers(plant.cv_count)), int(rng.integers(2, 13))
        rows = np.arange(len(cvs))
        cvs[:, cv] = cvs[rows - rows % every, cv]
    return cvs, mvs


def hold(values, deadband):
    last = values[0]
    for k, value in enumerate(values):
        if abs(value - last) > deadband:
            last = value
        values[k] = last
