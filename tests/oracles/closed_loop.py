#!/usr/bin/env python3
"""A second, independent implementation of the Shell 3x3 loop, to test the C++ one against.

Plant and model of Carlsson (2010), eq. 4.1, zero-order hold, unit sample; noise of eq. 4.2; an
unconstrained least-squares MPC (horizon 100, blocks 5 5 5 10 25, constant output disturbance);
random binary set-points of +-0.5. Shares no code, number generator or step order with sim/.

Usage: closed_loop.py OUT.csv [--samples N] [--seed S] [--channel CV MV] [--gain R] [--tau R]
                      [--delay D] [--constant] [--no-predictions]
"""
import argparse

import numpy as np

K = np.array([[4.05, 1.77, 5.88], [5.39, 5.72, 6.90], [4.38, 4.42, 7.20]])
TAU = np.array([[50.0, 60, 50], [50, 60, 40], [33, 44, 19]])
DEAD = np.array([[6, 7, 6], [4, 3, 3], [5, 5, 0]])
HORIZON = 100
BLOCKS = [5, 5, 5, 10, 25]


class Channels:
    """First-order channels with dead time; y(k) depends on u(k-1-dead)."""

    def __init__(self, gain, tau, dead):
        self.gain, self.dead = gain, dead.astype(int)
        self.pole = np.exp(-1.0 / tau)
        self.state = np.zeros_like(gain)
        self.past = np.zeros((int(dead.max()) + 1, gain.shape[1]))  # newest first

    def output(self):
        return self.state.sum(axis=1)

    def advance(self, u):
        self.past = np.vstack([u, self.past[:-1]])
        delayed = self.past[self.dead, np.arange(self.gain.shape[1])[None, :]]
        self.state = self.pole * self.state + (1 - self.pole) * self.gain * delayed

    def copy(self):
        other = Channels.__new__(Channels)
        other.gain, other.dead, other.pole = self.gain, self.dead, self.pole
        other.state, other.past = self.state.copy(), self.past.copy()
        return other


def step_matrix():
    """Effect of each block's move on the outputs over the horizon."""
    starts = np.concatenate([[0], np.cumsum(BLOCKS)[:-1]])
    length = HORIZON + 1
    t = np.arange(length)[None, None, :]
    step = K[:, :, None] * np.where(t > DEAD[:, :, None],
                                    1 - np.exp(-(t - DEAD[:, :, None]) / TAU[:, :, None]), 0.0)
    rows = []
    for p in range(1, HORIZON + 1):
        rows.append(np.hstack([step[:, :, p - s] if p > s else np.zeros((3, 3)) for s in starts]))
    return np.vstack(rows)


def run(samples, seed, gain_ratio, tau_ratio, delay, constant):
    rng = np.random.default_rng(seed)
    dynamics = step_matrix()
    weight = np.eye(dynamics.shape[1])
    feedback = np.linalg.solve(dynamics.T @ dynamics + weight, dynamics.T)[:3]
    model = Channels(K, TAU, DEAD)
    plant = Channels(K * gain_ratio, TAU * tau_ratio, DEAD + delay)
    noise = np.zeros(3)
    u = np.zeros(3)
    setpoint = rng.choice([-0.5, 0.5], 3)
    out = np.zeros((samples, 13))
    for k in range(samples):
        noise = 0.95 * noise + 0.01 * rng.standard_normal(3)
        for j in range(3):
            if not constant and k % 100 == 33 * j:
                setpoint[j] = rng.choice([-0.5, 0.5])
        y, predicted = plant.output() + noise, model.output()
        free, ahead = [], model.copy()
        for _ in range(HORIZON):
            ahead.advance(u)
            free.append(ahead.output())
        error = np.tile(setpoint - (y - predicted), HORIZON) - np.concatenate(free)
        u = u + feedback @ error
        out[k] = np.concatenate([[k], setpoint, u, y, predicted])
        plant.advance(u)
        model.advance(u)
    return out


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out")
    parser.add_argument("--samples", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--channel", type=int, nargs=2, default=[0, 0], help="CV MV, from 1")
    parser.add_argument("--gain", type=float, default=1.0)
    parser.add_argument("--tau", type=float, default=1.0)
    parser.add_argument("--delay", type=int, default=0)
    parser.add_argument("--constant", action="store_true")
    parser.add_argument("--no-predictions", action="store_true")
    args = parser.parse_args()
    ratio, tau, delay = np.ones((3, 3)), np.ones((3, 3)), np.zeros((3, 3), int)
    if args.channel[0] > 0:
        at = (args.channel[0] - 1, args.channel[1] - 1)
        ratio[at], tau[at], delay[at] = args.gain, args.tau, args.delay
    data = run(args.samples, args.seed, ratio, tau, delay, args.constant)
    names = ["time"] + [f"{s}{i}" for s in ("sp", "u", "y", "yhat") for i in (1, 2, 3)]
    columns = 10 if args.no_predictions else 13
    np.savetxt(args.out, data[:, :columns], delimiter=",", header=",".join(names[:columns]),
               comments="", fmt="%.17g")


if __name__ == "__main__":
    main()
