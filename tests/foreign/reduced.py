"""What an engineer puts into a controller: one lag or two behind a dead time, fitted to the steps of a
plant."""
import dataclasses

import numpy as np

ENOUGH = 0.02  # rms error of a step over the rms of the step, up to which one lag will do
TIMES = 28  # of each lag that are tried, geometrically from a sample to half the steps' length


@dataclasses.dataclass(frozen=True)
class Lags:
    gain: float
    times: tuple  # samples
    lead: float  # samples; of (lead s + 1)
    dead: int  # samples
    error: float  # as ENOUGH has it
    steps: np.ndarray
    ramps: bool = False  # gain per sample


def rises(times, dead, samples):
    """Of a lag each, to a unit step; a column each."""
    past = np.maximum(0.0, np.arange(samples) - dead)[:, None]
    return 1.0 - np.exp(-past / np.array(times))


def fit(steps, all_times, dead):
    shape = rises(all_times, dead, len(steps))
    weights, *_ = np.linalg.lstsq(shape, steps, rcond=None)
    return weights, shape @ weights


def best(steps, candidates, deads):
    """The pair of lags (or one) and dead time with the smallest error."""
    found = None
    for dead in deads:
        for times in candidates:
            weights, fitted = fit(steps, times, dead)
            error = np.linalg.norm(steps - fitted) / np.linalg.norm(steps)
            gain = weights.sum()
            lasts = abs(gain) > 0.1 * np.abs(weights).sum()  # else a lead without end
            if lasts and (found is None or error < found.error):
                lead = weights @ times[::-1] / gain if len(times) > 1 else 0.0
                found = Lags(gain, tuple(times), lead, dead, error, fitted)
    return found


def reduced_ramp(steps):
    """A ramp and a lag: gain (lead s + 1) / (s (T s + 1)), no dead time."""
    found = None
    for time in np.geomspace(1.0, 0.2 * len(steps), 2 * TIMES):
        shape = np.column_stack([np.arange(len(steps)), rises((time,), 0, len(steps))])
        weights, *_ = np.linalg.lstsq(shape, steps, rcond=None)
        error = np.linalg.norm(steps - shape @ weights) / np.linalg.norm(steps)
        if found is None or error < found.error:
            lead = time + weights[1] / weights[0]
            found = Lags(weights[0], (time,), lead, 0, error, shape @ weights, True)
    return found


def reduced(steps):
    """One lag where its error is below ENOUGH, else two of their own weights. `steps`: the first 0."""
    times = np.geomspace(1.0, 0.5 * len(steps), TIMES)
    deads = range(0, 9)
    one = best(steps, [(t,) for t in times], deads)
    near = np.geomspace(0.8, 1.25, 21) * one.times[0]
    one = best(steps, [(t,) for t in near], deads)
    if one.error < ENOUGH:
        return one
    pairs = [(times[i], times[j]) for i in range(TIMES) for j in range(i)]
    return best(steps, pairs, range(0, 5))
