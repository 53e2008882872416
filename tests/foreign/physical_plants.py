"""Plants from first principles, nonlinear and of another kind than all fits here: what a linear
controller meets. Each: states' derivatives by `slope`, CVs by `measured`; time in s.

Sources: four tanks, Johansson (2000), IEEE TCST 8(3), minimum-phase setting; stirred reactor with
one exothermic reaction, Seborg, Edgar and Mellichamp, Process Dynamics and Control, example 2.5,
cooled below its ignition; evaporator, Newell and Lee (1989), Applied Process Control, its
separator's level held by the product flow, or (separator) left to the controller, integrating;
heater: a stirred tank heated by steam, a sensor's lag, two more tanks that its outflow passes
(assumed numbers); column: sixteen stages of a binary mixture with constant molar flows and relative
volatility, levels held by the products, after Skogestad (1997), Trans. IChemE 75A (assumed numbers;
98 and 2 %, so that reflux and boil-up nearly undo one another).
"""
import dataclasses
import typing

import numpy as np


@dataclasses.dataclass
class Physical:
    name: str
    sample_time: float  # s
    substeps: int
    mvs: list
    dvs: list
    cvs: list
    rest: np.ndarray  # MVs and DVs at the operating point
    limits: np.ndarray  # of the MVs, either side of it
    moves: np.ndarray  # usual movement of the MVs and DVs
    band: np.ndarray  # of the set-points, either side
    load: float  # s.d. of what disturbs `slope`
    states: np.ndarray  # where settling begins
    numbers: dict  # the constants of the plant
    changes: dict  # name: constant, factor
    slope: typing.Callable  # states, inputs, numbers, disturbance -> derivative per s
    measured: typing.Callable
    integrating: tuple = ()  # CVs, by number


def four_tanks():
    area = np.array([28.0, 32.0, 28.0, 32.0])

    def slope(h, u, n, load):
        out = np.array([n["outlet1"], n["outlet2"], n["outlet3"], n["outlet4"]])
        out = out * np.sqrt(2 * 981.0 * np.maximum(h, 0.0))
        one, two = n["pump1"] * u[0], n["pump2"] * u[1]
        return np.array([out[2] - out[0] + n["split1"] * one + load, out[3] - out[1]
                         + n["split2"] * two + load, (1 - n["split2"]) * two - out[2],
                         (1 - n["split1"]) * one - out[3]]) / area

    return Physical(
        "four_tanks", 5.0, 4, ["PUMP1", "PUMP2"], [], ["LT1", "LT2"], np.array([3.0, 3.0]),
        np.array([3.0, 3.0]), np.array([0.3, 0.3]), np.array([1.2, 1.2]), 0.5,
        np.array([12.3, 12.8, 1.6, 1.4]),
        {"outlet1": 0.071, "outlet2": 0.057, "outlet3": 0.071, "outlet4": 0.057, "pump1": 3.33,
         "pump2": 3.35, "split1": 0.7, "split2": 0.6},
        {"outlet 1 clogs": ("outlet1", 0.85), "pump 1 wears": ("pump1", 0.75)},
        slope, lambda h: h[:2])


def reactor():
    def slope(x, u, n, load):
        concentration, temperature = x
        coolant, feed, feed_temperature = u
        rate = n["activity"] * 7.2e10 * np.exp(-8750.0 / temperature) * concentration
        return np.array([
            feed / 100.0 * (n["feed"] - concentration) - rate,
            feed / 100.0 * (feed_temperature - temperature) + 5e4 / 239.0 * rate
            + n["heat_transfer"] / 23900.0 * (coolant - temperature) + load]) / 60.0

    return Physical(
        "reactor", 6.0, 4, ["TC", "FEED"], ["TF"], ["TT", "CA"], np.array([285.0, 100.0, 350.0]),
        np.array([20.0, 35.0]), np.array([3.0, 8.0, 2.0]), np.array([1.5, 0.006]), 1.0,
        np.array([0.96, 309.0]), {"activity": 1.0, "heat_transfer": 5e4, "feed": 1.0},
        {"catalyst ages": ("activity", 0.75), "jacket fouls": ("heat_transfer", 0.85)},
        slope, lambda x: x[::-1])


def boiled(x, steam, cooling, feed, n):
    """Evaporator: vapour and condensate, kg/min."""
    _, product, pressure = x
    inside = 0.5616 * pressure + 0.3126 * product + 48.43
    heat = n["heater"] * 0.16 * (feed + 50.0) * (0.1538 * steam + 90.0 - inside)
    vapour = (heat - 0.07 * feed * (inside - 40.0)) / 38.5
    condensed = n["condenser"] * 6.84 * (0.507 * pressure + 55.0 - 25.0)
    return vapour, condensed / (38.5 * (1.0 + n["condenser"] * 6.84 / (0.14 * cooling)))


def evaporator():
    def slope(x, u, n, load):
        level, product, _ = x
        steam, cooling, feed = u
        vapour, condensed = boiled(x, steam, cooling, feed, n)
        drawn = 2.0 + 1.2 * (level - 1.0)
        return np.array([(feed - vapour - drawn) / 20.0,
                         (feed * 5.0 - drawn * product) / 20.0 + 0.1 * load,
                         (vapour - condensed) / 4.0 + 0.05 * load]) / 60.0

    return Physical(
        "evaporator", 60.0, 6, ["P100", "F200"], ["F1"], ["X2", "P2"],
        np.array([194.7, 208.0, 10.0]), np.array([70.0, 90.0]), np.array([8.0, 12.0, 0.15]),
        np.array([1.5, 1.5]), 0.5, np.array([1.0, 25.0, 50.5]), {"condenser": 1.0, "heater": 1.0},
        {"condenser fouls": ("condenser", 0.85), "heater fouls": ("heater", 0.9)},
        slope, lambda x: x[1:])


def separator():
    def slope(x, u, n, load):
        drawn, steam, cooling, feed = u
        vapour, condensed = boiled(x, steam, cooling, feed, n)
        return np.array([(feed - vapour - drawn) / 20.0 + 0.01 * load,
                         (feed * 5.0 - drawn * x[1]) / 20.0 + 0.1 * load,
                         (vapour - condensed) / 4.0 + 0.05 * load]) / 60.0

    return Physical(
        "separator", 60.0, 6, ["F2", "P100", "F200"], ["F1"], ["L2", "X2", "P2"],
        np.array([1.999996614939544, 194.7, 208.0, 10.0]), np.array([1.5, 70.0, 90.0]),
        np.array([0.08, 8.0, 12.0, 0.15]), np.array([0.15, 1.5, 1.5]), 0.5,
        np.array([1.0, 25.0, 50.5]), {"condenser": 1.0, "heater": 1.0},
        {"condenser fouls": ("condenser", 0.85), "heater fouls": ("heater", 0.9)},
        slope, lambda x: x, (0,))


def heater():
    def slope(x, u, n, load):
        tank, sensor, first, second = x
        steam, flow, inflow = u
        return np.array([
            (flow * (inflow - tank) + n["heating"] * steam - 0.5 * (tank - 20.0)) / 2500.0
            + 0.05 * load, (tank - sensor) / n["sensor"], (tank - first) * flow / 3000.0,
            (first - second) * flow / 3000.0])

    return Physical(
        "heater", 10.0, 4, ["STEAM", "FLOW"], ["TIN"], ["TOUT", "TDOWN"],
        np.array([40.0, 50.0, 20.0]), np.array([35.0, 35.0]), np.array([4.0, 5.0, 1.0]),
        np.array([2.0, 2.0]), 0.2, np.full(4, 67.0), {"heating": 60.0, "sensor": 40.0},
        {"coil fouls": ("heating", 0.75), "sensor is slow": ("sensor", 2.5)},
        slope, lambda x: x[[1, 3]])


def column():
    """Time in minutes here; states: the light component on each stage, the reboiler's first."""
    stages, fed = 16, 8
    holdup = np.full(stages, 0.5)
    holdup[[0, -1]] = 2.0

    def slope(x, u, n, load):
        reflux, boilup, feed = u
        vapour = n["volatility"] * x / (1.0 + (n["volatility"] - 1.0) * x)
        rising = np.concatenate([[0.0], boilup * vapour[:-1]])  # into a stage
        down = np.full(stages, reflux + feed)
        down[fed + 1:] = reflux
        down[0] = reflux + feed - boilup  # the bottom product
        falling = np.concatenate([down[1:-1] * x[1:-1], [reflux * x[-1], 0.0]])
        change = rising + falling - down * x - boilup * vapour
        change[-1] = boilup * (vapour[-2] - x[-1])  # a total condenser
        change[fed] += feed * (n["light"] + 0.01 * load)
        return change / holdup / 60.0

    return Physical(
        "column", 120.0, 30, ["REFLUX", "BOILUP"], ["FEED"], ["XTOP", "XBOT"],
        np.array([1.517557633575, 2.017557633575, 1.0]), np.array([0.6, 0.6]),
        np.array([0.03, 0.03, 0.02]), np.array([0.004, 0.004]), 1.0,
        np.linspace(0.02, 0.98, stages), {"volatility": 2.2, "light": 0.5},
        {"trays foul": ("volatility", 0.97), "feed is heavy": ("light", 0.94)},
        slope, lambda x: x[[-1, 0]])


PHYSICAL = [four_tanks, reactor, evaporator, heater, column, separator]


def advance(plant, state, inputs, numbers, load=0.0):
    """One sample, inputs held (midpoint rule)."""
    step = plant.sample_time / plant.substeps
    for _ in range(plant.substeps):
        half = state + 0.5 * step * plant.slope(state, inputs, numbers, load)
        state = state + step * plant.slope(half, inputs, numbers, load)
    return state


def settled(plant, inputs, numbers, samples=3000):
    state = plant.states
    for _ in range(samples):
        before, state = state, advance(plant, state, inputs, numbers)
        if np.all(np.abs(state - before) <= 1e-14 * np.abs(state)):
            break
    return state


def responses(plant, inputs, numbers, samples):
    """To a step of each input, per unit, the mean of one up and one down by half its usual movement:
    samples x CVs x inputs, the first row 0; and the CVs before."""
    before = settled(plant, inputs, numbers)
    steps = np.zeros((samples, len(plant.cvs), len(inputs)))
    for i, usual in enumerate(plant.moves):
        for size in (0.5 * usual, -0.5 * usual):
            moved, state = inputs.copy(), before
            moved[i] += size
            for k in range(1, samples):
                state = advance(plant, state, moved, numbers)
                change = plant.measured(state) - plant.measured(before)
                steps[k, :, i] += change / size / 2.0
    return steps, plant.measured(before)
