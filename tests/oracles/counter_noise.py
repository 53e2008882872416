"""Noise that Python and C++ draw alike, at any index without the ones before (splitmix64 of a
counter; tests/core/counter_noise.hpp is the twin)."""
import numpy as np

MASK = np.uint64(0xFFFFFFFFFFFFFFFF)


def uniform(stream, index):
    """In [-1, 1), exact in double."""
    with np.errstate(over="ignore"):
        z = (np.uint64(stream) * np.uint64(0x9E3779B97F4A7C15) +
             np.asarray(index, dtype=np.uint64) * np.uint64(0xD1342543DE82EF95))
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z = z ^ (z >> np.uint64(31))
    return (z >> np.uint64(11)).astype(np.float64) * 2.0**-52 - 1.0


def coloured(stream, index):
    """Moving average of five, so that neighbours correlate."""
    index = np.asarray(index, dtype=np.int64) + 16
    total = uniform(stream, index)
    for lag, weight in ((1, 0.75), (2, 0.5), (3, 0.375), (4, 0.25)):
        total = total + weight * uniform(stream, index - lag)
    return total
