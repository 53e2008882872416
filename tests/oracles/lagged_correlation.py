#!/usr/bin/env python3
"""Batch least squares for the correlations (3.4, 3.14-3.17): writes lagged_correlation.json.

Weighted rows, columns scaled to norm 1, numpy.linalg.lstsq (SVD) for u_i and all e_j(t+d) on 1 and
the controls of the case's kind; correlation of the residuals. Rows older than 45 memories weigh
less than e-45 and are left out. Run: /usr/bin/python3 tests/oracles/lagged_correlation.py  (numpy 1.24.2)
"""
import json
import os

import numpy as np

from counter_noise import coloured


def signals(case, k):
    """u (m) and e (n) at the indices k."""
    m, n = case["inputs"], case["cvs"]
    u = [coloured(10 + i, k) for i in range(m)]
    if case["collinear"] > 0:
        u[m - 1] = u[0] + u[1] + case["collinear"] * u[m - 1]
    e = [0.3 * coloured(10 + j, k - 2) - 0.2 * coloured(11 + j, k - 5) + coloured(50 + j, k)
         for j in range(n)]
    return np.array(u), np.array(e)


def controls(case, u, i, t):
    """What input i is controlled for, besides the mean."""
    kind, g = case["kind"], case["controlling_lags"]
    others = [j for j in range(case["inputs"]) if j != i]
    if kind == "conventional":
        return []
    if kind == "partial":
        return [u[j][t] for j in others]
    if kind == "alternative":
        past = [u[j][t - a] for j in range(case["inputs"]) for a in range(1, g + 1)]
        return [u[j][t] for j in others] + past
    return [u[j][t - a] for j in others for a in range(g + 1)]


def correlations(case):
    g, first, last, lam, total = (case[s] for s in
                                  ("controlling_lags", "first_lag", "last_lag", "lambda",
                                   "samples"))
    back = 0 if case["kind"] in ("conventional", "partial") else g
    back = max(back, -first)
    rows = total - (last + back)
    if lam < 1.0:
        rows = min(rows, int(45 / (1 - lam)))
    span = rows + last + back
    k = np.arange(total - span, total)
    u, e = signals(case, k)
    t = np.arange(span)[back:span - last]
    weight = lam ** ((len(t) - 1 - np.arange(len(t))) / 2.0)
    result = []
    for i in range(case["inputs"]):
        z = np.array([np.ones(len(t))] + controls(case, u, i, t)).T * weight[:, None]
        z /= np.linalg.norm(z, axis=0)
        right = [u[i][t]] + [e[j][t + d] for j in range(case["cvs"])
                             for d in range(first, last + 1)]
        right = np.array(right).T * weight[:, None]
        for _ in range(2):  # once more on the residual: iterative refinement
            right = right - z @ np.linalg.lstsq(z, right, rcond=1e-15)[0]
        norms = np.linalg.norm(right, axis=0)
        result.append((right[:, 0] @ right[:, 1:] / (norms[0] * norms[1:])).tolist())
    return result  # per input: CV-major, lags ascending


CASES = [
    dict(name="well conditioned", inputs=3, cvs=3, controlling_lags=40, first_lag=-10,
         last_lag=20, samples=3000, collinear=0.0, **{"lambda": 0.999}, tolerance=1e-10),
    dict(name="no forgetting", inputs=2, cvs=2, controlling_lags=10, first_lag=-5, last_lag=8,
         samples=2000, collinear=0.0, **{"lambda": 1.0}, tolerance=1e-10),
    dict(name="one input", inputs=1, cvs=2, controlling_lags=5, first_lag=0, last_lag=6,
         samples=500, collinear=0.0, **{"lambda": 0.99}, tolerance=1e-10),
    dict(name="collinear 1e-6", inputs=3, cvs=3, controlling_lags=40, first_lag=-10, last_lag=20,
         samples=3000, collinear=1e-6, **{"lambda": 0.999}, tolerance=1e-7),
    dict(name="well conditioned, 1e6 samples", inputs=2, cvs=2, controlling_lags=5, first_lag=-2,
         last_lag=5, samples=1000000, collinear=0.0, **{"lambda": 0.999}, tolerance=1e-10),
    dict(name="collinear 1e-6, 1e6 samples", inputs=3, cvs=2, controlling_lags=5, first_lag=-2,
         last_lag=5, samples=1000000, collinear=1e-6, **{"lambda": 0.999}, tolerance=1e-7),
    dict(name="more lags back than controls", inputs=3, cvs=2, controlling_lags=5, first_lag=-10,
         last_lag=20, samples=1500, collinear=0.0, **{"lambda": 0.998}, tolerance=1e-10),
] + [
    dict(name=kind + ", " + name, kind=kind, inputs=3, cvs=cvs, controlling_lags=g,
         first_lag=first, last_lag=last, samples=samples, collinear=0.0, **{"lambda": lam},
         tolerance=1e-10)
    for kind in ("conventional", "partial", "alternative")
    for name, cvs, g, first, last, samples, lam in (
        ("g = 40", 3, 40, -10, 20, 3000, 0.999), ("no forgetting", 2, 7, -4, 9, 1200, 1.0))
] + [
    dict(name="alternative, one input", kind="alternative", inputs=1, cvs=2, controlling_lags=5,
         first_lag=0, last_lag=6, samples=500, collinear=0.0, **{"lambda": 0.99},
         tolerance=1e-10),
    dict(name="alternative, collinear 1e-6", kind="alternative", inputs=3, cvs=2,
         controlling_lags=10, first_lag=-10, last_lag=20, samples=3000, collinear=1e-6,
         **{"lambda": 0.999}, tolerance=1e-7),
]

if __name__ == "__main__":
    for case in CASES:
        case.setdefault("kind", "lagged_partial")
        case["expected"] = correlations(case)
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "lagged_correlation.json")
    with open(path, "w") as out:
        json.dump({"numpy": np.__version__, "cases": CASES}, out)
        out.write("\n")
