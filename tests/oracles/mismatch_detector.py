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


def weigh(x, y):
    """Row weights 1 / (s max(1, |r| / 3 s)), r standardised by its own uncertainty."""
    count = len(y)
    weight = np.ones(count)
    scale, scale_rows, scaled = 1.0, 0.0, False
    begin, waiting = 0, 0
    for k in range(count):
        waiting += 1
        if begin >= TOGETHER * COLUMNS and waiting < PATIENCE and k + 1 < count:
            continue
        waiting, end = 0, k + 1
        if scaled:
            age = LAM ** ((begin - 1 - np.arange(begin)) / 2.0)
            xw = x[:begin] * (age * weight[:begin])[:, None]
            b, _ = fit(xw, y[:begin] * age * weight[:begin])
            norms = np.linalg.norm(xw, axis=0)
            for row in range(begin, end):
                h = np.linalg.lstsq((xw / norms).T, x[row] / scale / norms, rcond=None)[0]
                # Of rows taken together: says more of a new direction than of the noise.
                new = h @ h > 1.0 and end - begin > 1
                error = abs(y[row] - x[row] @ b) / scale / np.sqrt(1 + h @ h)
                clipped = min(error, 3.0)
                weight[row] = (clipped / error if error > clipped else 1.0) / scale
                if new:
                    continue
                scale_rows = min(scale_rows + 1, 300.0)
                scale *= np.sqrt(1 + (clipped**2 - 1) / scale_rows)
        elif end >= 2 * COLUMNS:
            now = LAM ** ((k - np.arange(end)) / 2.0)
            _, sse = fit(x[:end] * now[:, None], y[:end] * now)
            freedom = freedom_of(end)
            scale = np.sqrt(sse / np.sum(now**2) * (freedom + COLUMNS) / max(freedom, 1.0))
            scale_rows = min(max(freedom, 1.0), 300.0)
            weight[:end] = 1.0 / scale
            scaled = True
        begin = end
    return weight


def main():
    u, e = signals()
    x, y = rows(u, e)
    count = len(x)
    age = LAM ** ((count - 1 - np.arange(count)) / 2.0)
    w1, w2 = np.sum(age**2), np.sum(age**4)
    freedom = w1 * w1 / w2 - COLUMNS
    statistics = []
    for j in range(N):
        weight = weigh(x, y[j]) * age
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
               tail_poles=POLES, samples=SAMPLES, patience=PATIENCE, effective_rows=w1 * w1 / w2,
               statistics=statistics, **{"lambda": LAM})
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "mismatch_detector.json")
    with open(path, "w") as file:
        json.dump(out, file, indent=1)
        file.write("\n")
    print(statistics)


if __name__ == "__main__":
    main()
