#!/usr/bin/env python3
"""Prediction-error fit of two channels in a closed loop: writes identification.json.

One CV, two inputs. The first is moved by a proportional controller that follows a set-point, the
second from outside. tests/core/identification/oracle_test.cpp makes the same data. Here
scipy.optimize.least_squares fits gains, time constants, dead times, level and the coefficients of
an autoregressive noise all at once, from one start near the truth; answers are sums over the
moves of an input. No regression of high order, no grid, no elimination.
Run: /usr/bin/python3 tests/oracles/identification.py  (numpy 1.24.2, scipy 1.10.1)
"""
import json
import os

import numpy as np
import scipy
from scipy.optimize import least_squares

from counter_noise import uniform

ROWS, ORDER = 1500, 10
FIRST = dict(gain=2.0, time_constant=15.0, dead_time=3)
SECOND = dict(gain=-1.0, time_constant=6.0, dead_time=1)
CONTROLLER, NOISE_POLE, NOISE = 0.4, 0.8, 0.1


def telegraph(stream, hold):
    k = np.arange(ROWS)
    return np.where(k < hold, 0.0, np.where(uniform(stream, k // hold) < 0.0, -1.0, 1.0))


def data():
    setpoint, second = telegraph(1, 40), telegraph(2, 25)
    white = NOISE * np.sqrt(3.0) * uniform(3, np.arange(ROWS))
    y, first = np.zeros(ROWS), np.zeros(ROWS)
    noise = 0.0
    states = [0.0, 0.0]
    for k in range(ROWS):
        noise = NOISE_POLE * noise + white[k]
        y[k] = states[0] + states[1] + noise
        first[k] = CONTROLLER * (setpoint[k] - y[k])
        for i, (channel, u) in enumerate(((FIRST, first), (SECOND, second))):
            pole = np.exp(-1.0 / channel["time_constant"])
            late = u[k - channel["dead_time"]] if k >= channel["dead_time"] else 0.0
            states[i] = pole * states[i] + channel["gain"] * (1.0 - pole) * late
    return first, second, y


def answer(u, gain, time_constant, dead_time):
    k = np.arange(ROWS)
    since = np.maximum(0.0, k - dead_time)
    step = 1.0 - np.exp(-since / time_constant)
    return gain * np.convolve(np.diff(u, prepend=u[0]), step)[:ROWS] + gain * u[0]


def main():
    first, second, y = data()
    centred = [u - u.mean() for u in (first, second)]

    def innovations(p):
        rest = y - p[6] - answer(centred[0], *p[:3]) - answer(centred[1], *p[3:6])
        # What the first state adds dies out with either time constant.
        rest = rest - p[7] * np.exp(-np.arange(ROWS) / p[1]) - p[8] * np.exp(-np.arange(ROWS) / p[4])
        white = rest.copy()
        for lag, a in enumerate(p[9:], 1):
            white[lag:] -= a * rest[:-lag]
        return white[ORDER:]

    start = np.array([1.8, 14.0, 3.2, -0.9, 6.5, 1.2, 0.0, 0.0, 0.0, 0.8] + [0.0] * (ORDER - 1))
    # Central differences as wide as a quarter of a sample in the dead times, whose slope is not
    # defined at whole samples.
    fit = least_squares(innovations, start, jac="3-point", x_scale="jac", xtol=1e-12, ftol=1e-14)
    values = fit.x
    jacobian = np.zeros((ROWS - ORDER, len(values)))
    for i in range(len(values)):
        step = np.zeros(len(values))
        step[i] = 0.25 if i in (2, 5) else 1e-4 * max(1.0, abs(values[i]))
        jacobian[:, i] = (innovations(values + step) - innovations(values - step)) / (2 * step[i])
    variance = np.mean(fit.fun ** 2)
    sd = np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian) * variance))
    names = ["gain", "time_constant", "dead_time"]
    out = dict(numpy=np.__version__, scipy=scipy.__version__, rows=ROWS, variance=variance)
    for number, channel in enumerate(("first", "second")):
        out[channel] = {name: dict(value=values[3 * number + i], sd=sd[3 * number + i])
                        for i, name in enumerate(names)}
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "identification.json")
    with open(path, "w") as file:
        json.dump(out, file, indent=1)
        file.write("\n")
    print(json.dumps(out, indent=1))


if __name__ == "__main__":
    main()
