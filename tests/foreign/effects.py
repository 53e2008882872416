"""What may be wrong in a foreign plant, drawn from the seed, in the words of `mpm diagnose`."""
import math

import numpy as np

from channels import Channel

EFFECTS = ["none", "gain", "dead_time", "time_constant", "input_scale", "output_scale",
           "output_step", "output_drift", "aux", "stiction", "input_stuck", "input_offset"]


class Valve:
    """Sticks at every reversal until the command is far enough from it, slips, then lags behind
    its command (Kano 2004); or sticks again after every slip (He 2007)."""

    def __init__(self, band, jump, slips_once):
        self.static, self.kinetic = (band + jump) / 2, (band - jump) / 2
        self.slips_once = slips_once
        self.position = self.last = 0.0
        self.moving = 0

    def __call__(self, command):
        way = int(np.sign(command - self.last))
        self.last = command
        if way != self.moving:
            self.moving = 0
        pull = command - self.position
        if self.moving != 0 or abs(pull) > self.static:
            self.moving = 0 if self.slips_once else int(np.sign(pull))
            self.position = command - np.sign(pull) * self.kinetic
        return self.position


def either(rng, low, high):
    """Uniform in one of two ranges."""
    return float(rng.uniform(*(low if rng.random() < 0.5 else high)))


def any_ratio(rng):
    """5 to 100 % more, or its inverse; each doubling of the size as likely as the others."""
    size = math.exp(rng.uniform(math.log(0.05), math.log(1.0)))
    return float((1 + size)**rng.choice([-1, 1]))


def draw(effect, plant, channels, pilot_sd, noise_sd, samples, rng, any_size=False):
    """What the plant is then: channels; valve (mv -> function of sample and command); sensor (cv ->
    ratio); added (samples x CVs); aux_channel (cv, gain in its s.d. by the noise's, lag); and the
    truth. `pilot_sd`: of the MVs in a healthy run. `any_size`: a gain, time constant or dead time
    (with the sample that holds the input) is off by 5 to 100 %, not by what one would notice."""
    hidden = {"channels": list(channels), "valve": {}, "sensor": np.ones(plant.cv_count),
              "added": np.zeros((samples, plant.cv_count)), "aux": None}
    truth = {"cause": None, "cv": None, "mv": None, "tag": None, "parameters": {}, "onset": None}
    if effect == "none":
        return hidden, truth
    truth["cause"] = {"output_step": "output_disturbance", "output_drift": "output_disturbance",
                      "aux": "unmodelled_input"}.get(effect, effect)
    eligible = [i for i, c in enumerate(channels) if c.input < plant.dv and
                (effect != "time_constant" or c.has_time)]
    at = int(rng.choice(eligible))
    cv, mv = channels[at].cv, channels[at].input
    onset = int(rng.uniform(0.15, 0.5) * samples)

    if effect in ("gain", "dead_time", "time_constant"):
        truth.update(cv=cv, mv=mv)
        if effect == "gain":
            value = any_ratio(rng) if any_size else either(rng, (0.6, 0.85), (1.15, 1.5))
            hidden["channels"][at] = channels[at].with_gain(value)
            truth["parameters"] = {"gain_ratio": value}
        elif effect == "dead_time":
            dead = channels[at].dead
            value = (any_ratio(rng) - 1) * (dead + 1) if any_size else float(rng.integers(2, 6))
            value = value if dead + value >= 0 else -value
            hidden["channels"][at] = channels[at].with_dead(value)
            truth["parameters"] = {"dead_time_error": value * plant.sample_time}
        else:
            value = any_ratio(rng) if any_size else either(rng, (0.5, 0.75), (1.35, 2.0))
            hidden["channels"][at] = channels[at].with_time(value)
            truth["parameters"] = {"time_constant_ratio": value}
    elif effect == "input_scale":
        value = either(rng, (0.65, 0.85), (1.15, 1.4))
        truth.update(mv=mv, parameters={"gain_ratio": value})
        hidden["channels"] = [c.with_gain(value) if c.input == mv else c for c in channels]
    elif effect == "output_scale":
        value = either(rng, (0.65, 0.85), (1.15, 1.4))
        truth.update(cv=cv, parameters={"gain_ratio": value})
        hidden["sensor"][cv] = value
    elif effect in ("output_step", "output_drift"):
        size = float(rng.choice([-1, 1]) * rng.uniform(5, 12) * noise_sd[cv])
        since = np.maximum(0, np.arange(samples) - onset)
        step = effect == "output_step"
        hidden["added"][:, cv] = size * (since > 0) if step else size * since / since[-1]
        truth.update(cv=cv, onset=onset, parameters={"shape": effect[7:], "size": size})
    elif effect == "aux":
        size = float(rng.choice([-1, 1]) * rng.uniform(2.0, 4.0) * noise_sd[cv])
        hidden["aux"] = Channel(cv, 0, size, (float(rng.uniform(8, 25)),), float(rng.integers(5)))
        truth.update(cv=cv, tag="aux", parameters={"gain": size})
    elif effect == "stiction":
        band = float(rng.uniform(0.4, 1.2) * pilot_sd[mv])
        jump = float(rng.uniform(0.3, 1.0) * band)
        valve = Valve(band, jump, bool(rng.random() < 0.5))
        hidden["valve"][mv] = lambda k, command: valve(command)
        truth.update(mv=mv, parameters={"band": band, "jump": jump})
    elif effect == "input_stuck":
        held = []

        def stuck(k, command):
            if k < onset:
                return command
            held.append(command)
            return held[0]
        hidden["valve"][mv] = stuck
        truth.update(mv=mv, onset=onset)
    elif effect == "input_offset":
        size = float(rng.choice([-1, 1]) * rng.uniform(1.0, 2.5) * pilot_sd[mv])
        hidden["valve"][mv] = lambda k, command: command + size * (k >= onset)
        truth.update(mv=mv, onset=onset, parameters={"size": size})
    return hidden, truth
