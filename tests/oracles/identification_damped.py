#!/usr/bin/env python3
"""Prediction-error fit of a channel that overshoots: writes identification_damped.json.

One CV, two inputs moved from outside; tests/core/identification/damped_pair_test.cpp makes the same
data. The pair's answer comes from scipy.linalg.expm of its state matrix, the fit from
scipy.optimize.least_squares over all numbers and the noise's coefficients at once.
Run: /usr/bin/python3 tests/oracles/identification_damped.py  (numpy 1.24.2, scipy 1.10.1)
"""
import json
import os

import numpy as np
import scipy
from scipy.linalg import expm
from scipy.optimize import least_squares

from counter_noise import uniform

ROWS, ORDER = 3000, 10
PAIR = dict(gain=2.0, dead_time=2.0, time=6.0, damping=0.35)
LAG = dict(gain=0.7, dead_time=4.0, time=12.0)
NOISE_POLE, NOISE = 0.9, 0.05


def telegraph(stream, hold):
    k = np.arange(ROWS)
    return np.where(k < hold, 0.0, np.where(uniform(stream, k // hold) < 0.0, -1.0, 1.0))


def pair_step(gain, dead_time, time, damping):
    """C A^-1 (e^(A t) - 1) B at t = k - dead time; sample by sample by powers of e^A."""
    a = np.array([[0.0, 1.0], [-1.0 / time**2, -2.0 * damping / time]])
    start = int(np.floor(dead_time)) + 1
    transition, first = expm(a), expm(a * (start - dead_time))
    step, state = np.zeros(ROWS), first
    for k in range(start, ROWS):
        # x(t) = (1 - e^(A t)) x_end with x_end = (1, 0)
        step[k] = gain * (1.0 - state[0, 0])
        state = transition @ state
    return step


def lag_step(gain, dead_time, time):
    return gain * (1.0 - np.exp(-np.maximum(0.0, np.arange(ROWS) - dead_time) / time))


def answer(u, step):
    return np.convolve(np.diff(u, prepend=u[0]), step)[:ROWS]


def main():
    first, second = telegraph(841, 35), telegraph(842, 50)
    y = np.zeros(ROWS)
    white = NOISE * np.sqrt(3.0) * uniform(843, np.arange(ROWS))
    for k in range(ROWS):
        y[k] = white[k] + (NOISE_POLE * y[k - 1] if k else 0.0)
    y += answer(first, pair_step(**PAIR)) + answer(second, lag_step(**LAG))

    def innovations(p):
        rest = y - p[7] - answer(first, pair_step(*p[:4])) - answer(second, lag_step(*p[4:7]))
        white = rest.copy()
        for lag, a in enumerate(p[8:], 1):
            white[lag:] -= a * rest[:-lag]
        return white[ORDER:]

    start = np.array([1.9, 2.2, 6.3, 0.4, 0.65, 4.2, 11.0, 0.0, 0.9] + [0.0] * (ORDER - 1))
    # Central differences as wide as a quarter of a sample in the dead times, whose slope is not
    # defined at whole samples.
    fit = least_squares(innovations, start, jac="3-point", x_scale="jac", xtol=1e-12, ftol=1e-14)
    jacobian = np.zeros((ROWS - ORDER, len(fit.x)))
    for i in range(len(fit.x)):
        step = np.zeros(len(fit.x))
        step[i] = 0.25 if i in (1, 5) else 1e-4 * max(1.0, abs(fit.x[i]))
        jacobian[:, i] = (innovations(fit.x + step) - innovations(fit.x - step)) / (2 * step[i])
    variance = np.mean(fit.fun**2)
    sd = np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian) * variance))
    out = dict(numpy=np.__version__, scipy=scipy.__version__, rows=ROWS, variance=variance)
    for i, name in enumerate(PAIR):
        out[name] = dict(value=fit.x[i], sd=sd[i])
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "identification_damped.json")
    with open(path, "w") as file:
        json.dump(out, file, indent=1)
        file.write("\n")
    print(json.dumps(out, indent=1))


if __name__ == "__main__":
    main()
