#!/usr/bin/env python3
"""Generalised least squares with an autoregressive noise of each CV: writes identify_fit.json.

The same small plants as tests/core/identify/problem_test.cpp, simulated as sums of step responses
and fitted by dense normal equations, noise models and numbers in turn until nothing moves: no
square-root information, no shared elimination, no stopping rule.
Run: /usr/bin/python3 tests/oracles/identify_fit.py  (numpy 1.24.2)
"""
import json
import os

import numpy as np

from counter_noise import uniform

ROWS, ORDER = 400, 8
TOLERANCES = dict(gain=0.02, log_time_constant=0.03, dead_time=0.1)
# (cv, input): gain, time constant, dead time
MODEL = {(0, 0): (2.0, 10.0, 2.0), (0, 1): (-1.0, 5.0, 0.0), (1, 0): (1.5, 20.0, 3.0)}
DECAYS = {0: [5.0, 10.0], 1: [20.0]}


def white(stream):
    return np.sqrt(3.0) * uniform(stream, np.arange(ROWS))


def telegraph(stream, hold):
    k = np.arange(ROWS)
    return np.where(k < hold, 0.0, np.where(uniform(stream, k // hold) < 0.0, -1.0, 1.0))


INPUTS = [telegraph(1, 12), telegraph(2, 9)]


def response(u, gain, time_constant, dead_time):
    """Sum of the answers to each move of u."""
    k = np.arange(ROWS)
    y = np.zeros(ROWS)
    moves = np.diff(u, prepend=0.0)
    for j in np.flatnonzero(moves):
        since = np.maximum(0.0, k - j - dead_time)
        y += moves[j] * gain * (1.0 - np.exp(-since / time_constant))
    return y


def simulate(cv, errors):
    """errors: by input, (gain ratio, log time constant ratio, dead time error)."""
    y = np.zeros(ROWS)
    for (c, i), (gain, time_constant, dead_time) in MODEL.items():
        if c == cv:
            ratio, log_ratio, more = errors.get(i, (1.0, 0.0, 0.0))
            y += response(INPUTS[i], gain * ratio, time_constant * np.exp(log_ratio),
                          dead_time + more)
    return y


def noise(stream):
    e, x = 0.1 * white(stream), np.zeros(ROWS)
    for k in range(ROWS):
        x[k] = e[k] + (0.6 * x[k - 1] if k else 0.0)
    return x


class Cv:
    """One CV's rows, weights and small errors."""

    def __init__(self, cv, truth, unknown, replaced):
        self.cv = cv
        self.y = simulate(cv, truth) + noise(20 + cv)
        self.known = np.ones(ROWS)
        self.known[unknown] = 0.0
        self.y *= self.known
        self.weights = self.known.copy()
        self.weights[:ORDER] = 0.0
        for k in unknown:
            self.weights[k:k + ORDER + 1] = 0.0
        self.rows = np.sum(self.weights)
        self.nuisances = self.small_errors(replaced)
        self.beta = np.zeros(self.nuisances.shape[1])

    def small_errors(self, replaced):
        base = simulate(self.cv, {})
        count = np.sum(self.known)
        mean = np.sum(self.y) / count
        scale = np.sqrt(np.sum((self.y - mean) ** 2 * self.known) / count)
        misfit = (self.y - base) * self.known
        columns = [np.full(ROWS, max(1e-6 * scale, np.linalg.norm(misfit) / np.sqrt(count)))]
        for (c, i) in MODEL:
            if c != self.cv:
                continue
            for name, sd, error, step in (
                    ("gain", TOLERANCES["gain"], (1.01, 0.0, 0.0), 0.01),
                    ("log_time_constant", TOLERANCES["log_time_constant"], (1.0, 0.01, 0.0), 0.01),
                    ("dead_time", TOLERANCES["dead_time"], (1.0, 0.0, 0.25), 0.25)):
                column = sd * (simulate(self.cv, {i: error}) - base) / step
                columns.append(0.0 * column if (i, name) in replaced else column)
        moves = np.sqrt(np.sum(np.diff(misfit) ** 2) / ROWS)
        few = np.flatnonzero(self.known)[:5]
        first = max(1e-3 * scale, np.sqrt(np.mean((self.y - base)[few] ** 2)), 5.0 * moves)
        for decay in DECAYS[self.cv]:
            columns.append(first * np.exp(-np.arange(ROWS) / decay))
        return np.array(columns).T

    def whiten(self, x):
        x = x * self.known
        white = x.copy()
        for lag, a in enumerate(self.a, 1):
            white[lag:] -= a * x[:-lag]
        white[:ORDER] = 0.0
        return white

    def rows_of(self, x):
        return self.whiten(x) * np.sqrt(self.weights / self.variance)

    def update(self, simulated):
        residual = (self.y - simulated - self.nuisances @ self.beta) * self.known
        root = np.sqrt(self.weights[ORDER:])
        past = np.array([residual[ORDER - lag:ROWS - lag] for lag in range(1, ORDER + 1)]).T
        self.a = np.linalg.lstsq(past * root[:, None], residual[ORDER:] * root, rcond=None)[0]
        self.variance = np.sum(self.weights * self.whiten(residual) ** 2) / self.rows


def fit(cvs, coordinates, errors_of):
    """coordinates: (start, mean, sd); errors_of(theta): errors by input."""
    theta = np.array([c[0] for c in coordinates])
    mean = np.array([c[1] for c in coordinates])
    sd = np.array([c[2] for c in coordinates])
    count = len(theta)
    for _ in range(200):
        information, right = np.eye(count), (mean - theta) / sd
        log_det, systems = 0.0, []
        for cv in cvs:
            simulated = simulate(cv.cv, errors_of(theta))
            cv.update(simulated)
            jacobian = np.zeros((ROWS, count))
            for i in range(count):
                step = np.zeros(count)
                step[i] = 1e-5
                jacobian[:, i] = sd[i] * (simulate(cv.cv, errors_of(theta + step)) -
                                          simulate(cv.cv, errors_of(theta - step))) / 2e-5
            n = np.array([cv.rows_of(c) for c in cv.nuisances.T]).T
            j = np.array([cv.rows_of(c) for c in jacobian.T]).reshape(count, ROWS).T
            r = cv.rows_of(cv.y - simulated)
            inner = np.eye(n.shape[1]) + n.T @ n
            log_det += np.linalg.slogdet(inner)[1]
            solve = np.linalg.solve(inner, n.T)
            information += j.T @ j - j.T @ n @ solve @ j
            right += j.T @ r - j.T @ n @ solve @ r
            systems.append((n, j, r, inner))
        log_det += np.linalg.slogdet(information)[1]
        penalty = np.sum(((theta - mean) / sd) ** 2) + sum(np.sum(cv.beta**2) for cv in cvs)
        misfit = sum(cv.rows * np.log(cv.variance) for cv in cvs)
        step = np.linalg.solve(information, right)
        theta = theta + step * sd
        for cv, (n, j, r, inner) in zip(cvs, systems):
            cv.beta = np.linalg.solve(inner, n.T @ (r - j @ step))
    assert np.linalg.norm(step) < 1e-9
    covariance = np.linalg.inv(information) * np.outer(sd, sd)
    return dict(values=list(theta), covariance=covariance.tolist(), misfit=misfit,
                complexity=penalty + log_det,
                noise=[dict(coefficients=list(cv.a), variance=cv.variance) for cv in cvs])


def main():
    gain, log_ratio, delay = (1.0, 1.0, 0.25), (0.0, 0.0, 0.35), (0.3, 0.0, 3.0)
    out = dict(numpy=np.__version__, rows=ROWS)
    scaled = {0: (1.2, 0.0, 0.0)}
    out["input_scale"] = fit([Cv(0, scaled, [], set()), Cv(1, scaled, [], set())], [gain],
                             lambda t: {0: (t[0], 0.0, 0.0)})
    slow = {0: (0.9, np.log(1.3), 1.0)}
    own = {(0, name) for name in TOLERANCES}
    out["dynamics"] = fit([Cv(1, slow, [], own)], [gain, log_ratio, delay],
                          lambda t: {0: tuple(t)})
    holes = [100, 101, 102, 103, 104, 250]
    out["unknown_rows"] = fit([Cv(0, scaled, holes, {(0, "gain")})], [gain],
                              lambda t: {0: (t[0], 0.0, 0.0)})
    out["nothing"] = fit([Cv(0, {}, [], set())], [], lambda t: {})
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "identify_fit.json")
    with open(path, "w") as file:
        json.dump(out, file, indent=1)
        file.write("\n")
    for name in ("input_scale", "dynamics", "unknown_rows"):
        print(name, out[name]["values"], np.sqrt(np.diag(out[name]["covariance"])))


if __name__ == "__main__":
    main()
