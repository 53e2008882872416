"""Dynamic matrix control (Cutler and Ramaker 1980): an unconstrained least-squares gain from step
responses, an output bias kept over the horizon, moves clipped to the limits."""
import numpy as np

from channels import step_response

POINTS = 30  # of the horizon that enter the cost
MOVES = 3
SUPPRESSION = 0.15  # of a move of one MV scale against an error of one CV scale at every point
LIMIT = 5.0  # of an MV, in its scales
MOST_MOVE = 1.0  # a sample, in its scales


class Dmc:
    def __init__(self, plant):
        horizon = int(max(channel.settling() for channel in plant.channels))
        cvs, mvs = plant.cv_count, plant.mv_count
        steps = np.zeros((horizon + 1, cvs, mvs + 1))
        for channel in plant.channels:
            steps[:, channel.cv, channel.input] = step_response(channel, horizon + 1)
        self.steps = steps
        self.points = np.unique(np.rint(np.linspace(2, 0.6 * horizon, POINTS)).astype(int))
        starts = np.rint(np.array([0.0, 0.06, 0.15][:MOVES]) * horizon).astype(int)
        cv_scale, mv_scale = np.array(plant.cv_scale), np.array(plant.mv_scale)
        blocks = []
        for start in starts:
            late = np.maximum(0, self.points - start)
            blocks.append((steps[late, :, :mvs] * mv_scale / cv_scale[:, None]).reshape(-1, mvs))
        effect = np.hstack(blocks)
        penalty = SUPPRESSION * len(self.points) * np.eye(effect.shape[1])
        gain = np.linalg.solve(effect.T @ effect + penalty, effect.T)[:mvs]
        self.gain = gain * mv_scale[:, None] / np.tile(cv_scale, len(self.points))
        self.free = np.zeros((horizon + 1, cvs))
        self.ramps = np.zeros(cvs)  # 1 where the prediction goes on in a straight line
        for channel in plant.channels:
            if channel.integrating:
                self.ramps[channel.cv] = 1.0
        self.most, self.limit = MOST_MOVE * mv_scale, LIMIT * mv_scale
        self.last = np.zeros(mvs + 1)

    def move(self, setpoint, measured):
        """The MVs that it wants; `applied` must follow."""
        expected = self.free[self.points] + (measured - self.free[0])
        moves = np.clip(self.gain @ (setpoint - expected).ravel(), -self.most, self.most)
        return np.clip(self.last[:-1] + moves, -self.limit, self.limit)

    def applied(self, inputs):
        """The MVs as applied, by whomever, and the DV: predictions move on by one sample."""
        self.free = self.free + self.steps @ (inputs - self.last)
        self.last = inputs.copy()
        self.free[:-1] = self.free[1:].copy()
        self.free[-1] += self.ramps * (self.free[-2] - self.free[-3])
