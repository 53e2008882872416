"""The foreign plants: what each controller believes. Times in samples."""
import dataclasses

import numpy as np

from channels import Channel


@dataclasses.dataclass(frozen=True)
class Plant:
    name: str
    sample_time: float  # s
    mv_count: int
    cv_count: int
    channels: tuple  # of the model; the last input is the DV
    cv_scale: tuple  # usual set-point move
    mv_scale: tuple  # usual movement; the limits are at 5 times that
    dv_scale: float
    hold: tuple  # samples between set-point moves
    noise_pole: tuple

    @property
    def dv(self):
        return self.mv_count


def wood_berry():
    """Wood and Berry (1973): distillate and bottoms of a methanol column, minutes; DV: the feed."""
    c = Channel
    return Plant("wood_berry", 60.0, 2, 2, (
        c(0, 0, 12.8, (16.7,), 1), c(0, 1, -18.9, (21.0,), 3), c(0, 2, 3.8, (14.9,), 8.1),
        c(1, 0, 6.6, (10.9,), 7), c(1, 1, -19.4, (14.4,), 3), c(1, 2, 4.9, (13.2,), 3.4)),
        (1.0, 1.0), (0.15, 0.1), 0.2, (60, 140), (0.8, 0.95))


def sparse_4x6():
    """Four CVs, six MVs, 14 of 24 channels; drawn once and for all."""
    rng = np.random.default_rng(4006)
    places = {(i, i) for i in range(4)} | {(1, 4), (3, 5)}
    while len(places) < 14:
        places.add((int(rng.integers(4)), int(rng.integers(6))))
    channels = []
    for cv, mv in sorted(places):
        own = mv == cv or mv > 3
        size = rng.uniform(1.2, 2.0) if own else rng.uniform(0.4, 0.9)
        channels.append(Channel(cv, mv, round(float(size * rng.choice([-1, 1])), 2),
                                (round(float(rng.uniform(10, 45)), 1),),
                                int(rng.integers(0, 8))))
    channels += [Channel(0, 6, 0.8, (20.0,), 4), Channel(2, 6, -0.6, (30.0,), 6)]
    return Plant("sparse_4x6", 30.0, 6, 4, tuple(channels), (1.0,) * 4, (0.7,) * 6, 0.5,
                 (80, 180), (0.8, 0.95))


def underdamped():
    c = Channel
    return Plant("underdamped", 2.0, 2, 2, (
        c(0, 0, 2.0, (), 2, damped=(6.0, 0.35)), c(0, 1, 0.7, (12.0,), 4),
        c(1, 0, -0.9, (15.0,), 3), c(1, 1, 1.5, (), 3, damped=(9.0, 0.45)),
        c(0, 2, 0.6, (10.0,), 3), c(1, 2, 0.5, (14.0,), 2)),
        (1.0, 1.0), (0.6, 0.7), 0.6, (60, 140), (0.75, 0.93))


def inverse_response():
    c = Channel
    return Plant("inverse_response", 10.0, 2, 2, (
        c(0, 0, 1.6, (18.0, 7.0), 1, -6.0), c(0, 1, -0.7, (25.0,), 3),
        c(1, 0, 0.8, (20.0,), 4), c(1, 1, 2.2, (22.0, 9.0), 2, -8.0),
        c(0, 2, 0.7, (20.0,), 2), c(1, 2, -0.5, (16.0,), 5)),
        (1.0, 1.0), (0.6, 0.5), 0.6, (80, 160), (0.8, 0.95))


def integrating():
    """A level (integrates) and a temperature; DV: the feed. The heater has one channel only."""
    c = Channel
    return Plant("integrating", 10.0, 2, 2, (
        c(0, 0, -0.012, (), 1, integrating=True), c(0, 2, 0.012, (), 2, integrating=True),
        c(1, 1, 0.9, (30.0,), 4), c(1, 0, -0.4, (50.0,), 2), c(1, 2, -0.6, (40.0,), 3)),
        (3.0, 3.0), (6.0, 4.0), 2.0, (90, 200), (0.8, 0.95))


def slow():
    c = Channel
    return Plant("slow", 5.0, 2, 2, (
        c(0, 0, 1.8, (400.0,), 20), c(0, 1, 0.6, (250.0,), 35),
        c(1, 0, -0.7, (600.0,), 40), c(1, 1, 1.4, (300.0,), 15),
        c(0, 2, 0.7, (350.0,), 25), c(1, 2, 0.5, (200.0,), 30)),
        (1.0, 1.0), (0.8, 0.8), 0.6, (250, 600), (0.9, 0.98))


PLANTS = {make.__name__: make for make in
          (wood_berry, sparse_4x6, underdamped, inverse_response, integrating, slow)}
