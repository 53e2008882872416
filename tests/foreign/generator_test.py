#!/usr/bin/python3
"""The foreign plants are what they say: the same bytes from a seed again, step responses as in
closed form, a unit file from which the model is read back, balances that close. Exits with 77
without numpy."""
import math
import pathlib
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: needs numpy (python3-numpy)")
    sys.exit(77)

import loop
from channels import Channel, Simulator, respond, step_response
from controller import Dmc, Pi
from model_reader import model_steps
from physical_plants import PHYSICAL, four_tanks, heater, responses, settled
from plants import PLANTS
from regimes import Noise


def check(holds, what):
    if not holds:
        sys.exit(f"failed: {what}")


def same_bytes():
    case = ("late", "underdamped", "stiction")
    with tempfile.TemporaryDirectory() as folder:
        folders = [pathlib.Path(folder) / name for name in ("first", "again", "other")]
        for place, seed in zip(folders, (90001, 90001, 90002)):
            loop.write(*case, seed, 1000, place)
        for name in ("unit.yaml", "data.csv", "truth.json"):
            first, again, _ = ((place / name).read_bytes() for place in folders)
            check(first == again, f"{name} of one seed differs")
        first, _, other = ((place / "data.csv").read_bytes() for place in folders)
        check(first != other, "another seed makes the same data")


def closed_form():
    """K (1 - exp(-(k - dead) / T)); of an integrator K (k - dead); of a lag that integrates
    K (t - T (1 - exp(-t / T))); of a damped pair the textbook's (Seborg et al. 2016, eq. 5.51)."""
    k = np.arange(60.0)
    late = np.maximum(0.0, k - 2.3)
    lag = step_response(Channel(0, 0, 1.7, (9.0,), 2.3), 60)
    check(np.allclose(lag, 1.7 * (1 - np.exp(-late / 9.0)), atol=1e-9), "first-order lag")
    ramp = step_response(Channel(0, 0, 0.4, (), 2.3, integrating=True), 60)
    check(np.allclose(ramp, 0.4 * late, atol=1e-9), "integrator")
    both = step_response(Channel(0, 0, 0.4, (9.0,), 2.3, integrating=True), 60)
    check(np.allclose(both, 0.4 * (late - 9 * (1 - np.exp(-late / 9))), atol=1e-9),
          "integrator with a lag")
    tau, zeta = 6.0, 0.35
    root = math.sqrt(1 - zeta**2)
    wave = np.cos(root * late / tau) + zeta / root * np.sin(root * late / tau)
    damped = step_response(Channel(0, 0, 2.0, (), 2.3, damped=(tau, zeta)), 60)
    check(np.allclose(damped, 2 * (1 - np.exp(-zeta * late / tau) * wave), atol=1e-9), "damped")


def simulates_as_it_responds():
    rng = np.random.default_rng(90001)
    inputs = rng.standard_normal((200, 3))
    channels = PLANTS["wood_berry"]().channels
    simulator = Simulator(channels, 2, 3)
    stepped = np.array([simulator.step(row) for row in inputs])[:-1]
    summed = np.zeros((200, 2))
    for channel in channels:
        summed[:, channel.cv] += respond(channel, inputs[:, channel.input])
    check(np.allclose(stepped, summed[1:], atol=1e-8), "simulator against convolution")


def reads_back():
    for make in PLANTS.values():
        plant = make()
        text = loop.unit_file(plant)
        steps = model_steps(text, plant.sample_time, 200, {})
        check(len(steps) == len(plant.channels), f"channels of {plant.name}")
        for channel in plant.channels:
            tag = f"u{channel.input + 1}" if channel.input < plant.dv else "d1"
            check(np.allclose(steps[f"y{channel.cv + 1}", tag], step_response(channel, 200),
                              atol=1e-6), f"{plant.name} {channel} read back")


def whitens():
    for noise in (Noise(0.9, -0.3, False, 0.2), Noise(0.0, -0.5, True, 0.2)):
        drawn = noise.draw(np.random.default_rng(90001), 4000)
        white = noise.whitened(drawn[:, None])[50:, 0]
        # Of 3950 independent values: s.d. 1 +- 4 / sqrt(2 n), correlation 0 +- 4 / sqrt(n).
        check(abs(white.std() - 1) < 0.045, "s.d. of the innovations")
        check(abs(white[1:] @ white[:-1]) / len(white) < 0.064, "whiteness")


def controllers_control():
    """In the last half of a step that nothing disturbs, no CV is off by more than a fifth of it."""
    for make in PLANTS.values():
        plant = make()
        for controller in (Dmc.of(plant), Pi(plant)):
            simulator = Simulator(plant.channels, plant.cv_count, plant.mv_count + 1)
            cvs, inputs = np.zeros(plant.cv_count), np.zeros(plant.mv_count + 1)
            samples = 20 * int(max(c.settling() for c in plant.channels))
            for k in range(samples):
                inputs[:-1] = controller.move(np.array(plant.cv_scale), cvs)
                controller.applied(inputs)
                cvs = simulator.step(inputs)
                if 2 * k > samples:
                    check(np.all(np.abs(cvs / plant.cv_scale - 1) < 0.2),
                          f"{type(controller).__name__} of {plant.name}")


def balances():
    """The physical plants come to rest, the tanks and the heater where balances by hand say, and a
    step model's first row is the rest."""
    for make in PHYSICAL:
        plant = make()
        state = settled(plant, plant.rest, plant.numbers)
        slope = plant.slope(state, plant.rest, plant.numbers, 0.0)
        check(np.all(np.abs(slope * plant.sample_time) < 1e-9 * np.abs(state)), plant.name)
        steps, level = responses(plant, plant.rest, plant.numbers, 3)
        check(np.all(steps[0] == 0.0) and np.any(steps[1] != 0.0), f"steps of {plant.name}")
        check(np.allclose(level, plant.measured(state)), f"rest of {plant.name}")
    plant = four_tanks()
    inflow = 0.7 * 3.33 * 3.0 + 0.4 * 3.35 * 3.0  # of tank 1, what tank 3 lets through included
    level = settled(plant, plant.rest, plant.numbers)[0]
    check(math.isclose(level, (inflow / 0.071) ** 2 / (2 * 981.0), rel_tol=1e-9), "tank 1")
    plant = heater()
    warm = (50.0 * 20.0 + 60.0 * 40.0 + 0.5 * 20.0) / 50.5
    check(math.isclose(settled(plant, plant.rest, plant.numbers)[3], warm, rel_tol=1e-9), "heater")


for test in (same_bytes, closed_form, simulates_as_it_responds, reads_back, whitens,
             controllers_control, balances):
    test()
