"""Channels of the foreign plants: exact sampling of first and second order lags behind a dead time.

Times are in samples here; only the unit file speaks of seconds.
"""
import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Channel:
    """gain (lead s + 1) e^(-dead s) / ([s] prod(T s + 1)), or a damped pair instead of the lags."""

    cv: int
    input: int  # MVs, then the DV
    gain: float
    lags: tuple = ()
    dead: float = 0.0
    lead: float = 0.0
    integrating: bool = False
    damped: tuple = ()  # (tau, zeta): 1 / (tau^2 s^2 + 2 zeta tau s + 1)

    def with_gain(self, ratio):
        return dataclasses.replace(self, gain=self.gain * ratio)

    def with_time(self, ratio):
        damped = (self.damped[0] * ratio, self.damped[1]) if self.damped else ()
        return dataclasses.replace(self, lags=tuple(ratio * t for t in self.lags), damped=damped,
                                   lead=self.lead * ratio)

    def with_dead(self, more):
        return dataclasses.replace(self, dead=self.dead + more)

    @property
    def has_time(self):
        return bool(self.lags or self.damped)

    @property
    def time_scale(self):
        """Grows as with_time() says, where there is anything to grow."""
        return self.damped[0] if self.damped else sum(self.lags)

    def settling(self):
        slow = 4 * self.damped[0] / self.damped[1] if self.damped else 4 * sum(self.lags)
        return self.dead + slow + (40 if self.integrating else 0)


def exponential(matrix):
    """Taylor series after halving until the norm is small, then squaring."""
    halvings = max(0, int(np.ceil(np.log2(max(np.abs(matrix).sum(axis=1).max(), 1e-9)))) + 4)
    small = matrix / 2.0**halvings
    term = result = np.eye(len(matrix))
    for i in range(1, 13):
        term = term @ small / i
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return result


def continuous(channel):
    """x' = a x + b u, y = c x of one or two states."""
    if channel.damped:
        tau, zeta = channel.damped
        poly = [1.0, 2 * zeta * tau, tau * tau]
    else:
        poly = [1.0]
        for t in channel.lags:
            poly = np.convolve(poly, [1.0, t])
        if channel.integrating:
            poly = np.concatenate([[0.0], poly])
    if len(poly) == 2:
        return (np.array([[-poly[0] / poly[1]]]), np.array([1.0 / poly[1]]),
                np.array([channel.gain]))
    return (np.array([[0.0, 1.0], [-poly[0] / poly[2], -poly[1] / poly[2]]]),
            np.array([0.0, 1.0 / poly[2]]), channel.gain * np.array([1.0, channel.lead]))


def held(a, b, time):
    """Transition and effect of an input held for `time`."""
    size = len(b)
    both = np.zeros((size + 1, size + 1))
    both[:size, :size], both[:size, size] = a, b
    both = exponential(both * time)
    return both[:size, :size], both[:size, size]


def sampled(channel):
    """phi, older, newer, c, d: x(k+1) = phi x(k) + older u(k-d-1) + newer u(k-d), y = c x."""
    a, b, c = continuous(channel)
    d = int(np.floor(channel.dead + 1e-9))
    part = max(0.0, channel.dead - d)
    phi, _ = held(a, b, 1.0)
    rest, newer = held(a, b, 1.0 - part)
    _, first = held(a, b, part)
    return phi, rest @ first, newer, c, d


def impulse(channel, samples):
    """y(0), y(1), ... after a pulse of one sample at 0."""
    phi, older, newer, c, d = sampled(channel)

    def free(start):
        states, power = start[None, :], phi
        while len(states) < samples:
            states = np.concatenate([states, states @ power.T])
            power = power @ power
        return states[:samples] @ c

    result = np.zeros(samples)
    for start, at in ((newer, d + 1), (older, d + 2)):
        if at < samples:
            result[at:] += free(start)[:samples - at]
    return result


def step_response(channel, samples):
    return np.cumsum(impulse(channel, samples))


def respond(channel, values):
    """The channel's output, from rest, to a whole record of its input."""
    samples = len(values)
    size = 1 << (2 * samples - 1).bit_length()
    spectrum = np.fft.rfft(impulse(channel, samples), size) * np.fft.rfft(values, size)
    return np.fft.irfft(spectrum, size)[:samples]


def discrete_form(channel):
    """Numerator, denominator, delay of a channel whose dead time is a whole number of samples."""
    phi, older, newer, c, d = sampled(channel)
    assert np.allclose(older, 0.0)
    denominator = np.poly(phi)
    pulse = impulse(dataclasses.replace(channel, dead=0.0), len(denominator))[1:]
    numerator = np.convolve(denominator, pulse)[:len(denominator) - 1]
    return numerator, denominator, d


class Simulator:
    """All channels side by side, one sample at a time."""

    def __init__(self, channels, cv_count, input_count):
        parts = [sampled(channel) for channel in channels]
        orders = [len(part[3]) for part in parts]
        total = sum(orders)
        self.phi = np.zeros((total, total))
        self.older, self.newer = np.zeros(total), np.zeros(total)
        self.read = np.zeros((cv_count, total))
        self.delay, self.input = np.zeros(total, int), np.zeros(total, int)
        first = 0
        for channel, (phi, older, newer, c, d), order in zip(channels, parts, orders):
            at = slice(first, first + order)
            self.phi[at, at], self.older[at], self.newer[at] = phi, older, newer
            self.read[channel.cv, at] = c
            self.delay[at], self.input[at] = d, channel.input
            first += order
        self.past = np.zeros((int(self.delay.max()) + 2, input_count))
        self.state, self.now = np.zeros(total), 0

    def step(self, inputs):
        """Holds the inputs for one sample; the CVs at its end."""
        length = len(self.past)
        self.now = (self.now + 1) % length
        self.past[self.now] = inputs
        newer = self.past[(self.now - self.delay) % length, self.input]
        older = self.past[(self.now - self.delay - 1) % length, self.input]
        self.state = self.phi @ self.state + self.newer * newer + self.older * older
        return self.read @ self.state
