#!/usr/bin/env python3
"""The recovery boiler's channels from its test: writes boiler_identification.json.

boiler_identification.py TEST.csv, where TEST.csv is what
  mpmsim --config config/plants/recovery_boiler.yaml --scenario identification --samples 5400 --seed 1
writes with --csv TEST.csv; tests/core/identification/boiler_test.cpp makes the same data.

Each CV by itself: level + the four inputs' answers + autoregressive noise of order 12, fitted by
scipy.optimize.least_squares to the errors one sample ahead. An answer is the sum over the moves of
an input, held between samples, of K (1 - e^{-(t-L)/T}), or of two such lags after one dead time; a
second lag is kept where BIC asks for it. Before the first row each input stood at a level that is
fitted as well. A channel is there where its p-value (likelihood ratio) is below 1e-4. No regression
of high order, no lead, no damped pair, no unseen rows. Standard deviations of gains and step
responses come from the joint covariance of all numbers of the CV.
Run: OPENBLAS_NUM_THREADS=1 /usr/bin/python3 tests/oracles/boiler_identification.py TEST.csv
(numpy 1.24.2, scipy 1.10.1; some minutes)
"""
import csv
import json
import os
import sys

import numpy as np
import scipy
from scipy.linalg import lstsq
from scipy.optimize import least_squares
from scipy.signal import fftconvolve, lfilter
from scipy.stats import chi2

MVS = ["FC-301.SP", "FC-101.SP", "TC-102.SP", "HV-501.SP"]
CVS = ["FI-500.PV", "TI-502.PV", "AI-601.PV", "AI-602.PV"]
SAMPLE, ORDER = 10.0, 12
LAGS = (50, 100, 200)
# One lag: gain, ln T, L. Two: both gains, both ln T, L.
BOUNDS = {3: ([-np.inf, 0.0, 0.0], [np.inf, 8.0, 100.0]),
          5: ([-np.inf, -np.inf, 0.0, 0.0, 0.0], [np.inf, np.inf, 8.0, 8.0, 100.0])}


def step(p, t):
    """Answer after t s to a unit step."""
    since = np.maximum(0.0, t - p[-1])
    if len(p) == 3:
        return p[0] * -np.expm1(-since / np.exp(p[1]))
    return p[0] * -np.expm1(-since / np.exp(p[2])) + p[1] * -np.expm1(-since / np.exp(p[3]))


def gain(p):
    return p[0] if len(p) == 3 else p[0] + p[1]


class Fit:
    """One CV with the channels of `starts` (input: numbers of its channel)."""

    def __init__(self, inputs, y, starts):
        self.y, self.inputs, self.used = y, inputs, sorted(starts)
        self.rows = len(y)
        start, low, high, self.slices = [], [], [], {}
        for i in self.used:
            self.slices[i] = slice(len(start), len(start) + len(starts[i]) + 1)
            start += [*starts[i], inputs[i].mean()]  # and where the input stood before
            low += [*BOUNDS[len(starts[i])][0], inputs[i].min()]
            high += [*BOUNDS[len(starts[i])][1], inputs[i].max()]
        low, high = np.array(low), np.array(high)
        start = np.clip(start, low + 1e-6, high - 1e-6)
        found = least_squares(self.innovations, start, bounds=(low, high), jac=self.slopes,
                              x_scale="jac", xtol=1e-8, ftol=1e-8, max_nfev=40)
        self.values = found.x
        self.sum = 2.0 * found.cost
        self.bic = self.rows * np.log(self.sum) + len(start) * np.log(self.rows)

    def answer(self, i, numbers):
        t = SAMPLE * np.arange(self.rows)
        moves = np.diff(self.inputs[i], prepend=numbers[-1])
        return fftconvolve(moves, step(numbers[:-1], t))[:self.rows]

    def rest(self, values):
        return self.y - sum(self.answer(i, values[self.slices[i]]) for i in self.used)

    @staticmethod
    def past(rest):
        """rest(k) = a1 rest(k-1) + ... + constant + innovation."""
        return np.column_stack([rest[ORDER - lag:-lag] for lag in range(1, ORDER + 1)] +
                               [np.ones(len(rest) - ORDER)])

    def innovations(self, values):
        """With the level and the noise's coefficients at their best for these channels."""
        rest = self.rest(values)
        past = self.past(rest)
        return rest[ORDER:] - past @ lstsq(past, rest[ORDER:])[0]

    def slopes(self, values):
        """Of the innovations, less what level and noise would follow (Kaufman 1975). Central
        differences, a quarter of a sample wide in dead times: kinks at whole samples."""
        rest = self.rest(values)
        past = self.past(rest)
        noise = np.concatenate([[1.0], -lstsq(past, rest[ORDER:])[0][:ORDER]])
        out = np.zeros((self.rows - ORDER, len(values)))
        for i in self.used:
            at = self.slices[i]
            for n in range(at.start, at.stop):
                width = 2.5 if n == at.stop - 2 else 1e-4 * max(abs(values[n]), 1e-2)
                up, down = values.copy(), values.copy()
                up[n] += width
                down[n] -= width
                moved = (self.answer(i, up[at]) - self.answer(i, down[at])) / (2 * width)
                out[:, n] = -lfilter(noise, [1.0], moved)[ORDER:]
        basis = np.linalg.qr(past)[0]
        return out - basis @ (basis.T @ out)

    def covariance(self):
        jacobian = self.slopes(self.values)
        # What the data do not say at all (where an input stood that answers at once) takes no part.
        inverse = np.linalg.pinv(jacobian, rcond=1e-10)
        return inverse @ inverse.T * self.sum / (self.rows - ORDER)

    def starts(self):
        return {i: self.values[self.slices[i]][:-1] for i in self.used}


def better(inputs, y, fit):
    """The fit with a second lag in whichever channel gains most by it, if BIC asks for one."""
    best = fit
    for i in fit.used:
        p = fit.starts()[i]
        if len(p) == 5:
            continue
        for share, slow in ((0.3, 300.0), (-0.3, 300.0), (0.1, 1000.0), (-0.3, 5.0)):
            trial = dict(fit.starts())
            trial[i] = [(1 - share) * p[0], share * p[0], p[1], np.log(slow), p[2]]
            trial = Fit(inputs, y, trial)
            if trial.bic < best.bic:
                best = trial
    return best if best is fit else better(inputs, y, best)


def first_guess(inputs, y):
    """One lag per channel: the best of a grid for one channel after the other, in the differences,
    which see little of slow noise; gains are linear."""
    t = SAMPLE * np.arange(len(y))
    def answer(i, T, L):
        return np.diff(fftconvolve(np.diff(inputs[i], prepend=inputs[i][0]),
                                   step([1.0, np.log(T), L], t))[:len(y)])
    grid = [(T, L) for T in (6.0, 18.0, 60.0, 180.0) for L in (3.0, 8.0, 15.0, 23.0, 35.0)]
    known = [[answer(i, T, L) for T, L in grid] for i in range(len(inputs))]
    chosen, misfit = [0] * len(inputs), np.inf
    for i in list(range(len(inputs))) * 3:
        for n in range(len(grid)):
            trial = chosen[:i] + [n] + chosen[i + 1:]
            a = np.column_stack([known[j][m] for j, m in enumerate(trial)])[ORDER:]
            gains = np.linalg.solve(a.T @ a, a.T @ np.diff(y)[ORDER:])
            left = np.sum((np.diff(y)[ORDER:] - a @ gains) ** 2)
            if left < misfit:
                chosen, misfit, best = trial, left, gains
    return {i: [best[i], np.log(grid[n][0]), grid[n][1]] for i, n in enumerate(chosen)}


def identify(inputs, y):
    fit = Fit(inputs, y, first_guess(inputs, y))
    fit = better(inputs, y, fit)
    p_values = []
    for i in range(len(inputs)):
        starts = fit.starts()
        numbers = len(starts.pop(i))
        without = Fit(inputs, y, starts)
        p_values.append(chi2.sf(max(0.0, fit.rows * np.log(without.sum / fit.sum)), numbers))
    there = [i for i in range(len(inputs)) if p_values[i] < 1e-4]
    starts = fit.starts()
    if len(there) < len(inputs):
        fit = Fit(inputs, y, {i: starts[i] for i in there})
    return fit, p_values


def answers(fit):
    """Gain and steps of all channels, and the s.d. of each."""
    def all_of(values):
        out = []
        for i in fit.used:
            p = values[fit.slices[i]][:-1]
            out += [gain(p), *(step(p, SAMPLE * lag) for lag in LAGS)]
        return np.array(out)
    slopes = np.zeros((4 * len(fit.used), len(fit.values)))
    for n in range(len(fit.values)):
        width = 1e-5 * max(abs(fit.values[n]), 1e-2)
        up, down = fit.values.copy(), fit.values.copy()
        up[n] += width
        down[n] -= width
        slopes[:, n] = (all_of(up) - all_of(down)) / (2 * width)
    return all_of(fit.values), np.sqrt(np.diag(slopes @ fit.covariance() @ slopes.T))


def main():
    with open(sys.argv[1]) as file:
        table = list(csv.DictReader(file))
    columns = {name: np.array([float(row[name]) for row in table]) for name in MVS + CVS}
    inputs = [columns[name] for name in MVS]
    out = dict(numpy=np.__version__, scipy=scipy.__version__, rows=len(table), lags=LAGS, channels=[])
    for name in CVS:
        fit, p_values = identify(inputs, columns[name])
        values, sd = answers(fit)
        print(name, "innovation", np.sqrt(fit.sum / (fit.rows - ORDER)), "p", p_values)
        for n, i in enumerate(fit.used):
            print("  ", MVS[i], fit.starts()[i])
            at = slice(4 * n, 4 * n + 4)
            rounded = [[float(f"{x:.5g}") for x in each[at]] for each in (values, sd)]
            out["channels"].append(dict(cv=name, mv=MVS[i], gain=rounded[0][0], gain_sd=rounded[1][0],
                                        steps=rounded[0][1:], step_sd=rounded[1][1:]))
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "boiler_identification.json")
    with open(path, "w") as file:
        json.dump(out, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
