#!/usr/bin/env python3
"""Fits the models that an engineer would take first and writes them as unit files.

    fit_first.py CUT_FOLDER [UNIT_FOLDER [UNIT...]]

CUT_FOLDER holds what prepare.py wrote. Prints each model's error and writes UNIT_FOLDER/<unit>.yaml
where that folder is given. Needs numpy. What is fitted to what is in units.py.

One model per CV: one or two lags that all its inputs share, a gain (with two lags: a lead too) and
a dead time per input, a constant, and a free initial state per episode. Plain least squares on the
free run, over the episodes' first part only. For given lags and dead times that is linear in all
else; these are searched, the lags on a logarithmic grid that is refined around its best point, the
dead times input by input, in whole samples. A sampled lag sees no input younger than one sample, so
none of these models has direct feed-through. Where units.py leaves the number of lags open, models
that were fitted on the first two thirds of the first part are compared on the rest of it.

The error on the unseen part is the root mean square of the free run too, its initial state fitted
on the first 50 samples; or, where an episode is cut into windows, on the window's first sample.
"""

import itertools
import pathlib
import sys

import numpy as np

from units import UNITS

SETTLING_SAMPLES = 50
LAGS_PER_DECADE = 8
REFINEMENTS = 4
MOST_ROUNDS = 4


def read(path):
    with open(path) as file:
        lines = [line for line in file.read().splitlines() if not line.startswith("#")]
    names = lines[0].split(",")
    values = np.array([[float(text) if text else np.nan for text in line.split(",")]
                       for line in lines[1:]])
    return {name: values[:, i] for i, name in enumerate(names)}


def on_grid(columns, sample_time, inputs):
    """At regular times: rows left out are missing, and an input holds its last value there."""
    at = np.rint((columns["time"] - columns["time"][0]) / sample_time).astype(int)
    regular = {}
    for name, values in columns.items():
        column = np.full(at[-1] + 1, np.nan)
        column[at] = values
        if name in inputs:
            known = np.flatnonzero(~np.isnan(column))
            last = np.searchsorted(known, np.arange(len(column)), side="right") - 1
            column = column[known[np.maximum(last, 0)]]
        regular[name] = column
    return regular


class Episode:
    """Inputs (samples x inputs) and one CV of one run, or of one window of it."""

    def __init__(self, inputs, output):
        self.inputs, self.output = inputs, output
        self.known = ~np.isnan(output)
        self.lagged = {}

    def lag(self, time_constant, sample_time):
        """Each input through one lag of gain 1, held between samples."""
        if time_constant not in self.lagged:
            n = len(self.output)
            pole = np.exp(-sample_time / time_constant)
            response = np.concatenate([[0.0], (1.0 - pole) * pole ** np.arange(n - 1)])
            size = 1 << (2 * n - 1).bit_length()
            spectrum = np.fft.rfft(response, size)[:, None] * np.fft.rfft(self.inputs, size, axis=0)
            self.lagged[time_constant] = np.fft.irfft(spectrum, size, axis=0)[:n]
        return self.lagged[time_constant]

    def regressors(self, lags, delays, sample_time):
        """A column per lag and input, and one of ones."""
        columns = [np.ones(len(self.output))]
        for lag in lags:
            lagged = self.lag(lag, sample_time)
            for i, delay in enumerate(delays):
                column = np.zeros(len(self.output))
                column[delay:] = lagged[:len(lagged) - delay, i]
                columns.append(column)
        return np.stack(columns, axis=1)

    def transients(self, lags, sample_time):
        """What the initial state leaves behind, a column per lag."""
        steps = np.arange(len(self.output))[:, None]
        return np.exp(-steps * sample_time / np.asarray(lags)[None, :])


def episodes_of(unit, cut, cv, parts):
    """The CV's inputs around their means, of each episode or window within these parts."""
    found = []
    tags = unit.inputs_of(cv)
    centre = np.array([unit.centre[tag] for tag in tags])
    for name, first, last in parts:
        columns = on_grid(read(cut / f"{name}.csv"), unit.sample_time, tags)
        rows = len(columns["time"])
        begin, end = int(first * rows), int(last * rows)
        length = unit.window or end - begin
        for start in range(begin, end - length + 1, length):
            part = slice(start, start + length)
            inputs = np.stack([columns[tag][part] for tag in tags], axis=1)
            if np.sum(~np.isnan(columns[cv][part])) > length // 2:
                found.append(Episode(inputs - centre, columns[cv][part]))
    return found


def solve(episodes, lags, delays, sample_time):
    """Coefficients of the regressors and the sum of squares; initial states are projected out."""
    rows, wanted = [], []
    for episode in episodes:
        known = episode.known
        x = episode.regressors(lags, delays, sample_time)[known]
        y = episode.output[known]
        basis, _ = np.linalg.qr(episode.transients(lags, sample_time)[known])
        rows.append(x - basis @ (basis.T @ x))
        wanted.append(y - basis @ (basis.T @ y))
    x, y = np.concatenate(rows), np.concatenate(wanted)
    coefficients = np.linalg.lstsq(x, y, rcond=1e-9)[0]
    return coefficients, float(np.sum((y - x @ coefficients) ** 2))


def search_lags(episodes, order, delays, unit):
    """The best lags for these dead times."""
    shortest = 0.3 * unit.sample_time
    half = 0.5 * max(len(episode.output) for episode in episodes) * unit.sample_time
    longest = unit.longest_lag or half
    count = max(3, int(np.log10(longest / shortest) * LAGS_PER_DECADE))
    grid = np.geomspace(shortest, longest, count)
    candidates = ([(lag,) for lag in grid] if order == 1
                  else list(itertools.combinations(grid[::-1], 2)))
    step = grid[1] / grid[0]

    def cost(lags):
        for episode in episodes:
            if len(episode.lagged) > 2 * count:
                episode.lagged.clear()
        return solve(episodes, lags, delays, unit.sample_time)[1]

    best = min(candidates, key=cost)
    for _ in range(REFINEMENTS):
        step = np.sqrt(step)
        moves = itertools.product((1.0 / step, 1.0, step), repeat=order)
        near = [tuple(np.clip(lag * move, shortest, longest) for lag, move in zip(best, by))
                for by in moves]
        best = min([lags for lags in near if order == 1 or lags[0] > 1.05 * lags[1]] + [best],
                   key=cost)
    return best


def search(episodes, order, unit):
    """Lags and dead times, turn by turn until neither moves."""
    delays = [unit.shortest_delay] * episodes[0].inputs.shape[1]
    lags = search_lags(episodes, order, delays, unit)
    for _ in range(MOST_ROUNDS):
        before = list(delays)
        for i in range(len(delays)):
            def with_delay(delay):
                tried = delays[:i] + [delay] + delays[i + 1:]
                return solve(episodes, lags, tried, unit.sample_time)[1]
            delays[i] = min(range(unit.shortest_delay, unit.longest_delay + 1), key=with_delay)
        if delays == before:
            break
        lags = search_lags(episodes, order, delays, unit)
    return lags, delays


class Fit:
    """One CV's model."""

    def __init__(self, unit, episodes, order):
        self.unit = unit
        self.lags, self.delays = search(episodes, order, unit)
        self.coefficients, _ = solve(episodes, self.lags, self.delays, unit.sample_time)

    def residuals(self, episodes):
        """Measured less free run, initial state as the file's head says."""
        found = []
        for episode in episodes:
            error = episode.output - (episode.regressors(self.lags, self.delays,
                                                         self.unit.sample_time) @ self.coefficients)
            transients = episode.transients(self.lags, self.unit.sample_time)
            head = np.flatnonzero(episode.known)[:1 if self.unit.window else SETTLING_SAMPLES]
            state = np.linalg.lstsq(transients[head], error[head], rcond=1e-6)[0]
            found.append((error - transients @ state)[episode.known])
        return np.concatenate(found)

    def error(self, episodes):
        return float(np.sqrt(np.mean(self.residuals(episodes) ** 2))) if episodes else np.nan

    def channels(self):
        """Gain, lead (None with one lag) and dead time of each input."""
        inputs = len(self.delays)
        share = self.coefficients[1:].reshape(len(self.lags), inputs)
        for i in range(inputs):
            gain = share[:, i].sum()
            lead = None
            if len(self.lags) == 2:
                lead = (share[0, i] * self.lags[1] + share[1, i] * self.lags[0]) / gain
            yield gain, lead, self.delays[i] * self.unit.sample_time


def fit(unit, cut, cv):
    """Model, its error where it was fitted and on the unseen part, and that part's deviation."""
    parts = [(name, 0.0, share) for name, share in unit.fit]
    train = episodes_of(unit, cut, cv, parts)
    unseen = episodes_of(unit, cut, cv, unit.unseen)
    order = unit.order
    if order is None:
        early = episodes_of(unit, cut, cv, [(n, a, a + (b - a) * 2 / 3) for n, a, b in parts])
        late = episodes_of(unit, cut, cv, [(n, a + (b - a) * 2 / 3, b) for n, a, b in parts])
        order = min((1, 2), key=lambda n: Fit(unit, early, n).error(late))
    found = Fit(unit, train, order)
    everything = np.concatenate([episode.output[episode.known] for episode in unseen or train])
    return found, found.error(train), found.error(unseen), float(np.std(everything))


def signal_lines(unit):
    yield "signals:"
    for kind, tags in (("mv", unit.mv), ("dv", unit.dv), ("cv", unit.cv), ("aux", unit.aux)):
        if tags:
            yield f"  {kind}:"
        for tag in tags:
            extra = f", setpoint: {unit.setpoints[tag]}" if tag in unit.setpoints else ""
            yield f"    - {{tag: {tag}{extra}}}"


def model_lines(unit, fits):
    yield "model:"
    yield "  channels:"
    for cv, found in fits.items():
        for tag, (gain, lead, dead_time) in zip(unit.inputs_of(cv), found.channels()):
            kind = "mv" if tag in unit.mv else "dv"
            lags = ", ".join(f"{lag:.4g}" for lag in found.lags)
            yield (f"    - {{cv: {cv}, {kind}: {tag}, gain: {gain:.5g}, time_constants: [{lags}]"
                   + (f", lead: {lead:.4g}" if lead is not None else "")
                   + (f", dead_time: {dead_time:g}" if dead_time > 0 else "") + "}")
    point = [f"{tag}: {unit.centre[tag]:.6g}" for tag in unit.inputs]
    point += [f"{cv}: {found.coefficients[0]:.6g}" for cv, found in fits.items()]
    yield "  operating_point: {" + ", ".join(point) + "}"


def wrapped(text, width=98):
    line = "#"
    for word in text.split():
        if len(line) + 1 + len(word) > width:
            yield line
            line = "#"
        line += " " + word
    yield line


def unit_file(unit, fits, errors):
    said = "; ".join(f"{cv} {before:.3g} there, {after:.3g} unseen"
                     for cv, (before, after) in errors.items())
    head = f"{unit.what} Error of the free run: {said}. Written by docs/cases/fit_first.py."
    lines = list(wrapped(head)) + [f"unit: {unit.name}", f"sample_time: {unit.sample_time:g}"]
    return "\n".join(lines + list(signal_lines(unit)) + list(model_lines(unit, fits))) + "\n"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    cut = pathlib.Path(sys.argv[1])
    print("| unit | CV | lags | error where fitted | unseen | standard deviation there |")
    print("|---|---|---|---|---|---|")
    for unit in UNITS if len(sys.argv) < 4 else [u for u in UNITS if u.name in sys.argv[3:]]:
        recordings = [read(cut / f"{name}.csv") for name, _ in unit.fit]
        unit.centre = {tag: np.nanmean(np.concatenate([columns[tag] for columns in recordings]))
                       for tag in unit.inputs}
        fits, errors = {}, {}
        for cv in unit.cv:
            fits[cv], before, after, deviation = fit(unit, cut, cv)
            errors[cv] = before, after
            lags = ", ".join(f"{lag:.3g}" for lag in fits[cv].lags)
            print(f"| {unit.name} | {cv} | {lags} | {before:.3g} | {after:.3g} | {deviation:.3g} |",
                  flush=True)
        if len(sys.argv) > 2:
            path = pathlib.Path(sys.argv[2]) / f"{unit.name}.yaml"
            path.write_text(unit_file(unit, fits, errors))


if __name__ == "__main__":
    main()
