"""What closes the foreign loops. Dmc: dynamic matrix control (Cutler and Ramaker 1980), an
unconstrained least-squares gain from step responses, an output bias kept over the horizon, moves
clipped to the limits. Pi: a controller of each CV by itself (Skogestad 2003)."""
import itertools

import numpy as np

from channels import step_response

POINTS = 30  # of the horizon that enter the cost
MOVES = 3
SUPPRESSION = 0.15  # of a move of one MV scale against an error of one CV scale at every point
LIMIT = 5.0  # of an MV, in its scales
MOST_MOVE = 1.0  # a sample, in its scales


def steps_of(plant):
    """Responses to unit steps: samples x CVs x inputs, the DV last."""
    horizon = int(max(channel.settling() for channel in plant.channels))
    steps = np.zeros((horizon + 1, plant.cv_count, plant.mv_count + 1))
    for channel in plant.channels:
        steps[:, channel.cv, channel.input] = step_response(channel, horizon + 1)
    return steps


class Dmc:
    """`integrating`: of each CV, whether its steps end in ramps; `limits`: of the MVs."""

    def __init__(self, steps, cv_scale, mv_scale, integrating, limits):
        horizon, cvs, mvs = len(steps) - 1, len(cv_scale), len(mv_scale)
        cv_scale, mv_scale = np.array(cv_scale), np.array(mv_scale)
        self.steps = steps
        self.points = np.unique(np.rint(np.linspace(2, 0.6 * horizon, POINTS)).astype(int))
        starts = np.rint(np.array([0.0, 0.06, 0.15][:MOVES]) * horizon).astype(int)
        blocks = []
        for start in starts:
            late = np.maximum(0, self.points - start)
            blocks.append((steps[late, :, :mvs] * mv_scale / cv_scale[:, None]).reshape(-1, mvs))
        effect = np.hstack(blocks)
        penalty = SUPPRESSION * len(self.points) * np.eye(effect.shape[1])
        gain = np.linalg.solve(effect.T @ effect + penalty, effect.T)[:mvs]
        self.gain = gain * mv_scale[:, None] / np.tile(cv_scale, len(self.points))
        self.free = np.zeros((horizon + 1, cvs))
        self.ramps = np.array(integrating, float)  # 1: the prediction goes on in a straight line
        self.most, self.limit = MOST_MOVE * mv_scale, np.array(limits)
        self.last, self.bias = np.zeros(steps.shape[2]), np.zeros(cvs)

    @classmethod
    def of(cls, plant):
        integrating = [any(c.integrating for c in plant.channels if c.cv == cv)
                       for cv in range(plant.cv_count)]
        return cls(steps_of(plant), plant.cv_scale, plant.mv_scale, integrating,
                   LIMIT * np.array(plant.mv_scale))

    def move(self, setpoint, measured, read=True):
        """The MVs that it wants; `applied` must follow. `read`: of each CV, whether it was: a bias
        stands until it is known better."""
        self.bias = np.where(read, measured - self.free[0], self.bias)
        expected = self.free[self.points] + self.bias
        moves = np.clip(self.gain @ (setpoint - expected).ravel(), -self.most, self.most)
        mvs = len(moves)
        return np.clip(self.last[:mvs] + moves, -self.limit, self.limit)

    def applied(self, inputs):
        """The MVs as applied, by whomever, and the DV: predictions move on by one sample."""
        self.free = self.free + self.steps @ (inputs - self.last)
        self.last = inputs.copy()
        self.free[:-1] = self.free[1:].copy()
        self.free[-1] += self.ramps * (self.free[-2] - self.free[-3])


class Pi:
    """Each CV by the MV that moves it most; MVs that are left over rest. SIMC rules, at a fifth of
    the speed that a channel by itself would bear, for the others disturb; limits hold the sum."""

    def __init__(self, plant):
        cvs, mvs = plant.cv_count, plant.mv_count
        size = np.zeros((cvs, mvs))
        channels = {(c.cv, c.input): c for c in plant.channels if c.input < mvs}
        for (cv, mv), channel in channels.items():
            slope = channel.gain * (50.0 if channel.integrating else 1.0)
            size[cv, mv] = abs(slope) * plant.mv_scale[mv] / plant.cv_scale[cv]
        self.pairs = list(max(itertools.permutations(range(mvs), cvs),
                              key=lambda order: np.prod(size[np.arange(cvs), list(order)])))
        self.gain, self.rate = np.zeros(cvs), np.zeros(cvs)
        for cv, mv in enumerate(self.pairs):
            c = channels[cv, mv]
            lag, late = max(1.0, c.time_scale), 1.0 + c.dead + abs(c.lead)
            closed = 5.0 * (late + (0.0 if c.integrating else 0.2 * lag))
            reset = 4.0 * (closed + late)
            if not c.integrating:
                reset = min(lag, reset)
            self.gain[cv] = (1.0 if c.integrating else lag) / (c.gain * (closed + late))
            self.rate[cv] = self.gain[cv] / reset
        self.limit = LIMIT * np.array(plant.mv_scale)
        self.sums = np.zeros(cvs)

    def move(self, setpoint, measured, read=True):
        """`read`: does not matter to it; what stands is what it sees."""
        error = setpoint - measured
        wanted = np.zeros(len(self.limit))
        for cv, mv in enumerate(self.pairs):
            most = self.limit[mv]
            self.sums[cv] = np.clip(self.sums[cv] + self.rate[cv] * error[cv], -most, most)
            wanted[mv] = np.clip(self.gain[cv] * error[cv] + self.sums[cv], -most, most)
        return wanted

    def applied(self, inputs):
        """It goes by errors alone."""
