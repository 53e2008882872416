"""The least s.d. that an unbiased estimate of a gain can have (Cramér-Rao).

For closed-loop data whose truth is known: which channels there are, their form and the noise's
model are given; gain, times and dead times of the CV's channels and its level are not. Who has to
find out more can only be worse.
"""
import numpy as np

from responses import answer, settling

NOISE_ORDER = 20  # autoregression that whitens the true noise
STEP = 0.02       # of a time constant, as a share
DEAD_STEP = 0.25  # samples


def sensitivities(channel, moves, sample_time):
    """Of a channel's answer to the log of its gain, of its time constants and to its dead time."""
    now = answer(channel, moves, sample_time)
    columns = [now]
    for i, time in enumerate(channel["time_constants"]):
        times = list(channel["time_constants"])
        times[i] = time * (1 + STEP)
        later = answer({**channel, "time_constants": times}, moves, sample_time)
        columns.append((later - now) / STEP)
    # The slope has a kink at whole samples: the mean of both sides.
    by = DEAD_STEP * sample_time
    late, early = (answer({**channel, "dead_time": max(0.0, channel["dead_time"] + d)}, moves,
                          sample_time) for d in (by, -by))
    columns.append((late - early) / (2 * DEAD_STEP))
    return columns


def whitened(values, coefficients):
    """A(q) of each column."""
    result = values.copy()
    for lag, a in enumerate(coefficients, 1):
        result[lag:] -= a * values[:-lag]
    return result


def gain_sds(channels, inputs, cv, sample_time):
    """Relative s.d. of each gain at best.

    channels: of one CV, as in model.json; inputs: of each, samples; cv: measured.
    """
    columns, rest = [], cv
    for channel, values in zip(channels, inputs):
        moves = np.diff(values, prepend=values[0])
        mine = sensitivities(channel, moves, sample_time)
        rest = rest - mine[0]
        columns += mine
    count = np.cumsum([0] + [len(c["time_constants"]) + 2 for c in channels])[:-1]
    columns.append(np.ones(len(cv)))
    # Before the first row nobody knows what the inputs did.
    first = min(len(cv) // 4, int(max(settling(c) for c in channels) / sample_time))
    noise = (rest - rest[first:].mean())[first:]
    past = np.column_stack([noise[NOISE_ORDER - lag:len(noise) - lag]
                            for lag in range(1, NOISE_ORDER + 1)])
    coefficients = np.linalg.lstsq(past, noise[NOISE_ORDER:], rcond=None)[0]
    sd = whitened(noise, coefficients)[NOISE_ORDER:].std()
    slopes = whitened(np.column_stack(columns)[first:], coefficients)[NOISE_ORDER:] / sd
    # The rows that were left out would have told as much as the others.
    slopes *= np.sqrt(len(cv) / len(slopes))
    sizes = np.linalg.norm(slopes, axis=0)
    triangle = np.linalg.qr(slopes / sizes, mode="r")
    covariance = np.linalg.inv(triangle)
    covariance = covariance @ covariance.T / np.outer(sizes, sizes)
    return [float(np.sqrt(covariance[c, c])) for c in count]
