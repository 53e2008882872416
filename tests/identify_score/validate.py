#!/usr/bin/python3
"""Free run of an identified model on other data.

validate.py MODEL.json DATA.csv, with what `mpm identify --report` wrote and a wide CSV of the same
tags without gaps. For each CV the model runs from the first row on; behind what it forgets slowest
its mean is set to the measured one, as a level is nobody's model. Said are R2 (share of the CV's
variance), fit (1 - s.d. of the error / s.d. of the CV), and two tests of what is left once an
autoregression of order 12 has made it white: whiteness (Ljung and Box 1978, 32 lags) and, for each
input, its correlation with the input's moves of the last 200 samples in 20 sums (chi-square).
Run: tests/identify_score/validate.py MODEL.json DATA.csv
"""
import csv
import json
import sys

import numpy as np
from scipy.stats import chi2

import responses

ORDER, WHITENESS_LAGS, SUMS, PER_SUM = 12, 32, 20, 10


def whitened(error):
    past = np.column_stack([error[ORDER - lag:-lag] for lag in range(1, ORDER + 1)])
    return error[ORDER:] - past @ np.linalg.lstsq(past, error[ORDER:], rcond=None)[0]


def whiteness(white):
    n = len(white)
    lags = np.arange(1, WHITENESS_LAGS + 1)
    rho = np.array([white[lag:] @ white[:-lag] for lag in lags]) / (white @ white)
    squares = n * (n + 2) * np.sum(rho ** 2 / (n - lags))
    return chi2.sf(squares, WHITENESS_LAGS - ORDER)


def goes_with(white, u):
    """p-value of what is left not depending on the mean of the input over each ten samples before."""
    reach = SUMS * PER_SUM
    sums = np.concatenate([[0.0], np.cumsum(u)])
    n = len(u)
    columns = np.column_stack([sums[reach - k * PER_SUM:n - k * PER_SUM] -
                               sums[reach - (k + 1) * PER_SUM:n - (k + 1) * PER_SUM]
                               for k in range(SUMS)] + [np.ones(n - reach)])
    y = white[reach:] - white[reach:].mean()
    left = y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]
    return chi2.sf(len(y) * np.log((y @ y) / (left @ left)), SUMS)


def main():
    with open(sys.argv[1]) as file:
        model = json.load(file)
    with open(sys.argv[2]) as file:
        table = list(csv.DictReader(file))
    column = lambda tag: np.array([float(row[tag]) for row in table])
    sample_time = float(table[1]["time"]) - float(table[0]["time"])
    inputs = [each["mv"] for each in model["inputs"]]
    print("CV, R2, fit, s.d. of the error, p of whiteness, p of no " + ", ".join(inputs))
    for cv in model["operating_point"]:
        channels = [each for each in model["channels"] if each["cv"] == cv and each["in_model"]]
        if not channels:
            continue
        y, run = column(cv), 0.0
        for each in channels:
            u = column(each["mv"])
            run = run + responses.answer(each, np.diff(u, prepend=u[0]), sample_time)
        first = int(max(responses.settling(each) for each in channels) / sample_time)
        error = (y - run)[first:]
        error -= error.mean()
        white = whitened(error)
        share = error.std() / y[first:].std()
        tests = [goes_with(white, column(tag)[first + ORDER:]) for tag in inputs]
        print(f"{cv}, {1 - share ** 2:.4f}, {100 * (1 - share):.1f} %, {error.std():.3g} of "
              f"{y[first:].std():.3g}, {whiteness(white):.2g}, " + ", ".join(f"{p:.2g}" for p in tests))


if __name__ == "__main__":
    main()
