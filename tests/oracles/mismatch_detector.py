#!/usr/bin/env python3
"""Brute-force F tests of all channels: writes mismatch_detector.json.

The weights depend on earlier estimates, so every row is judged by a batch least-squares fit
(numpy.linalg.lstsq) of all rows before those that waited with it, and F of a block is the change of the weighted residual sum of
squares when the block's columns are left out: two fits, no factor, no recursion.
Run: /usr/bin/python3 tests/oracles/mismatch_detector.py  (numpy 1.24.2)
"""
import json
import os

import numpy as np

from counter_noise import coloured, uniform

M, N, LAGS, ORDER, POLES, LAM, SAMPLES = 2, 2, 4, 2, [0.9], 0.998, 700
PATIENCE, TOGETHER = 7, 10  # samples that rows wait, once there are so many per column
BLOCK = LAGS + len(POLES)
COLUMNS = 1 + N * ORDER + M * BLOCK
FIRST = max(LAGS, ORDER) + 1  # sample that gives the first row


def signals():
    k = np.arange(SAMPLES)
    u = np.array([coloured(1 + i, k) for i in range(M)])
    w = np.array([uniform(20 + j, k) ** 5 * 3 * np.where(k > 350, 2.0, 1.0) for j in range(N)])
    e = np.zeros((N, SAMPLES))
    for t in range(1, SAMPLES):
        e[:, t] = 0.6 * e[:, t - 1] + w[:, t]
    e[0, 2:] += 0.08 * u[1, :-2]  # the hidden mismatch
    return u, e


def rows(u, e):
    s = np.zeros((M, len(POLES), SAMPLES))
    origin = u[:, 0]
    for t in range(SAMPLES):
        for i in range(M):
            for p, pole in enumerate(POLES):
                before = s[i, p, t - 1] if t else 0.0
                s[i, p, t] = pole * before + (1 - pole) * (u[i, t] - origin[i])
    x = []
    for t in range(FIRST, SAMPLES):
        row = [1.0]
        for j in range(N):
            row += [e[j, t - q] for q in range(1, ORDER + 1)]
        for i in range(M):
            row += [u[i, t - q] - origin[i] for q in range(1, LAGS + 1)]
            row += [s[i, p, t - LAGS - 1] for p in range(len(POLES))]
        x.append(row)
    return np.array(x), e[:, FIRST:]


def fit(x, y):
    scale = np.linalg.norm(x, axis=0)
    b = np.linalg.lstsq(x / scale, y, rcond=None)[0] / scale
    return b, float(np.sum((y - x @ b) ** 2))


def freedom_of(rows):
    age = LAM ** np.arange(rows)
    return np.sum(age) ** 2 / np.sum(age**2) - COLUMNS


def clip(error):
    return min(error, 3.0)


class Noise:
    """Running s.d. of the errors, clipped, over 300 rows, and the share that was clipped."""

    def __init__(self, scale, rows):
        self.scale, self.rows = scale, min(max(rows, 1.0), 300.0)

    def restart(self, scale, clipped):
        self.scale, self.clipped, self.taken = scale, clipped, 0

    def share(self, leverage):
        """What a row counts for: where tails are heavy, less the more it says that is new."""
        heavy = min(max((self.clipped - 0.008) / 0.012, 0.0), 1.0)
        return min(max(2.0 / (heavy * leverage), 0.02), 1.0) if heavy > 0 else 1.0

    def take(self, error, leverage, tells=True):
        self.taken += 1
        rows = min(200.0 + self.taken, 2000.0)
        if leverage <= 2.0:  # what a wrong model does to others looks like heavy tails
            self.clipped += ((1.0 if error > 3.0 else 0.0) - self.clipped) / rows
        if not tells:
            return
        self.rows = min(self.rows + 1, 300.0)
        self.scale *= np.sqrt(1 + (clip(error) ** 2 - 1) / self.rows)

    def weight(self, error, share):
        return np.sqrt(share) / self.scale * (clip(error) / error if error > 3.0 else 1.0)


def predicted(x, xw, yw):
    """Errors of rows x of (xw, yw)'s fit are y - x b; also the leverages x' (xw' xw)^-1 x."""
    b, _ = fit(xw, yw)
    norms = np.linalg.norm(xw, axis=0)
    h = np.array([np.linalg.lstsq((xw / norms).T, row / norms, rcond=None)[0] for row in x])
    return b, np.sum(h * h, axis=1)


def first_rows(x, y, noise, weight, share):
    """The first rows, by what the fit of all of them leaves of each, five times over."""
    count = len(y)
    age = LAM ** ((count - 1 - np.arange(count)) / 2.0)
    for turn in range(5):
        b, h = predicted(x * weight[:, None], x * (age * weight)[:, None], y * age * weight)
        # A row that counts for part of one has a larger error than it takes itself for.
        error = np.abs(y - x @ b) / np.sqrt(np.maximum(0.02, 1 + h / share - 2 * h))
        scale = np.sort(error)[count // 2] / 0.6745
        leverages = h / np.maximum(0.02, 1 - h) / share
        clipped = np.sum((error > 3.0 * scale) & (leverages <= 2.0))
        rows = 200 + np.sum(leverages <= 2.0)
        noise.restart(scale, 0.02 if turn == 0 else clipped / rows)
        for row, leverage in enumerate(leverages):
            share[row] = noise.share(leverage)
            weight[row] = noise.weight(error[row] / scale, share[row])
            noise.take(error[row] / scale, leverage)


def weigh(x, y, cv):
    """Row weights sqrt(share) / (s max(1, |r| / 3 s)), r standardised by its own uncertainty, and
    the shares."""
    count = len(y)
    weight, share = np.ones(count), np.ones(count)
    noise = None
    begin, waiting = 0, 0
    for k in range(count):
        waiting += 1
        if begin >= TOGETHER * COLUMNS and waiting < PATIENCE and k + 1 < count:
            continue
        waiting, end = 0, k + 1
        if noise:
            age = LAM ** ((begin - 1 - np.arange(begin)) / 2.0) * weight[:begin]
            b, h = predicted(x[begin:end], x[:begin] * age[:, None], y[:begin] * age)
            for row in range(begin, end):
                leverage = h[row - begin] / noise.scale**2
                error = abs(y[row] - x[row] @ b) / noise.scale / np.sqrt(1 + leverage)
                share[row] = noise.share(leverage)
                weight[row] = noise.weight(error, share[row])
                # Of rows taken together one may say more of a new direction than of the noise.
                noise.take(error, leverage, leverage <= 1.0 or end - begin == 1)
        elif end >= 3 * COLUMNS + cv:
            now = LAM ** ((k - np.arange(end)) / 2.0)
            _, sse = fit(x[:end] * now[:, None], y[:end] * now)
            freedom = freedom_of(end)
            scale = np.sqrt(sse / np.sum(now**2) * (freedom + COLUMNS) / max(freedom, 1.0))
            noise = Noise(scale, freedom)
            weight[:end] = 1.0 / scale
            first_rows(x[:end], y[:end], noise, weight[:end], share[:end])
        begin = end
    return weight, share


def main():
    u, e = signals()
    x, y = rows(u, e)
    count = len(x)
    age = LAM ** ((count - 1 - np.arange(count)) / 2.0)
    statistics, effective = [], []
    for j in range(N):
        weight, share = weigh(x, y[j], j)
        weight *= age
        w1, w2 = np.sum(age**2 * share), np.sum(age**4 * share**2)
        effective.append(w1 * w1 / w2)
        freedom = effective[-1] - COLUMNS
        xw, yw = x * weight[:, None], y[j] * weight
        _, full = fit(xw, yw)
        variance = full / w1 * (freedom + COLUMNS) / freedom
        line = []
        for i in range(M):
            begin = 1 + N * ORDER + i * BLOCK
            keep = [c for c in range(COLUMNS) if not begin <= c < begin + BLOCK]
            _, without = fit(xw[:, keep], yw)
            line.append((without - full) / (BLOCK * variance) * w1 / w2)
        statistics.append(line)
    out = dict(numpy=np.__version__, inputs=M, cvs=N, fir_lags=LAGS, residual_order=ORDER,
               tail_poles=POLES, samples=SAMPLES, patience=PATIENCE, effective_rows=effective,
               statistics=statistics, **{"lambda": LAM})
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "mismatch_detector.json")
    with open(path, "w") as file:
        json.dump(out, file, indent=1)
        file.write("\n")
    print(statistics)


if __name__ == "__main__":
    main()
