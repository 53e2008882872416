"""What fit_first.py fits: a unit file per entry, its signals, and the recordings that it saw."""

from dataclasses import dataclass, field


@dataclass
class Unit:
    """`fit`: (recording, share of it from its beginning). `unseen`: (recording, from, to), shares;
    None = the rest of what was fitted. `channels`: inputs of a CV where it has not all of them.
    `order`: number of lags, None = decided on the first part. `shortest_delay`, `longest_delay` in
    samples, beyond the one that sampling makes. `longest_lag` in s, 0 = half an episode.
    `window` in samples: free runs of that length instead of one."""

    name: str
    what: str
    sample_time: float
    mv: list
    cv: list
    fit: list
    unseen: list = None
    dv: list = field(default_factory=list)
    aux: list = field(default_factory=list)
    setpoints: dict = field(default_factory=dict)
    channels: dict = field(default_factory=dict)
    order: int = None
    shortest_delay: int = 0
    longest_delay: int = 10
    longest_lag: float = 0
    window: int = 0

    def __post_init__(self):
        if self.unseen is None:
            self.unseen = [(name, share, 1.0) for name, share in self.fit if share < 1.0]

    @property
    def inputs(self):
        return self.mv + self.dv

    def inputs_of(self, cv):
        return self.channels.get(cv, self.inputs)


def ahu():
    return [Unit(
        "ahu", "Air handling unit of a test cell (FLEXLAB): heating and cooling coil, mixed air to "
        "supply air, by the minute in occupied hours, in closed loop. Fitted on the four days on "
        "which both coils did as they were told (4, 5, 6 and 14; only dampers were tampered with).",
        60, ["HC_valve", "CC_valve"], ["SA_temp_degF"],
        [(f"ahu_day{day:02d}", 1.0) for day in (4, 5, 6, 14)], unseen=[("ahu_day07", 0.0, 1.0)],
        dv=["MA_temp_degF"], order=1)]


def pump():
    return [Unit(
        f"pump_run{run}", f"Water circulation rig (SKAB), run {run}: drive voltage to flow, fitted "
        "on the time before the event, which begins around 600 s. The drive stands still but for "
        "noise, so its gain means nothing: the model is the mean.",
        1, ["motor_V"], ["flow_l_min"], [(f"pump_run{run}", share)], order=1,
        longest_lag=10)
        for run, share in enumerate((0.49, 0.5, 0.49, 0.5, 0.55, 0.42, 0.49))]


def rooms():
    return [Unit(
        f"room_{room}", f"Office {room}, ventilated on demand (closed loop): valve to CO2, 15 min. "
        "Least squares finds that an open valve raises the CO2, for the controller opens it when "
        "people come in; they are counted, but the model does not know them.",
        900, ["vent_valve"], ["CO2_bms_ppm"], [(f"room_{room}", 2 / 3)], order=1, longest_delay=2,
        aux=["persons_camera", "T_out_degC", "sun_W_m2"]) for room in (917810, 999169)]


def houses():
    return [Unit(
        f"house_{house}", f"Dwelling {house} with a thermostat (closed loop), in winter: heating "
        "to indoor temperature, one lag, on free runs of 24 h. Weather is measured and offered as "
        "`aux`.", 900, ["heating"], ["T_in_degC"], [(f"house_{house}", 2 / 3)], order=1,
        longest_delay=8, longest_lag=2e5, window=96, aux=["T_out_degC", "sun"])
        for house in (1, 2, 3)]


def varennes():
    return [Unit(
        "varennes_outdoor", "The building of varennes.yaml, whose model now knows the outdoor "
        "temperature too: one lag, on free runs of 24 h. Sun and the electricity used indoors are "
        "left out.", 900, ["heating_total"], ["T_int"], [("varennes", 2 / 3)], dv=["T_ext"],
        order=1, longest_delay=8, longest_lag=2e5, window=96,
        aux=["GHI", "DNI", "DHI", "cons_noHVAC"])]


def heat_exchanger():
    return [Unit(
        "heat_exchanger", "Steam heats water (DaISy): flow of the water to its outlet temperature, "
        "fitted on the first half.", 1, ["q_liquid"], ["T_out_degC"], [("heat_exchanger", 0.5)],
        longest_delay=20)]


def wall():
    inside, outside = "T_inside_degC", "T_outside_degC"
    what = ("Heat flow through a wall of two layers (DaISy), both surfaces' temperatures measured. "
            "The time unit is the sample. ")
    common = dict(sample_time=1, cv=["heat_flow"], fit=[("wall", 2 / 3)])
    return [
        Unit("wall", what + "The model has both.", mv=[inside], dv=[outside], **common),
        Unit("wall_without_outside", what + "The model leaves the outer one out.", mv=[inside],
             aux=[outside], **common),
        Unit("wall_without_inside", what + "The model leaves the inner one out.", mv=[outside],
             aux=[inside], **common)]


def evaporator():
    inputs = ["u1_feed_flow", "u2_vapour_flow", "u3_cooling_water_flow"]
    what = ("Evaporator of four stages (DaISy): feed, vapour and cooling water to dry matter, flow "
            "and temperature of the product. The time unit is the sample. ")
    found = []
    for left_out in [None] + inputs:
        has = f"The model leaves {left_out} out." if left_out else "The model has all three."
        found.append(Unit(
            "evaporator" + (f"_without_{left_out[:2]}" if left_out else ""), what + has,
            1, [tag for tag in inputs if tag != left_out],
            ["y1_dry_matter", "y2_product_flow", "y3_product_temp"], [("evaporator", 2 / 3)],
            aux=[left_out] if left_out else [], order=2, longest_delay=5,
            longest_lag=100))
    return found


def dryer():
    return [Unit(
        "industrial_dryer", "Industrial dryer (DaISy), means and trends taken out by those who "
        "published it: fuel, fan and raw material to temperatures and moisture.", 10,
        ["u1_fuel_flow", "u2_fan_speed", "u3_raw_material_flow"],
        ["y1_dry_bulb_temp", "y2_wet_bulb_temp", "y3_moisture"], [("industrial_dryer", 0.5)],
        order=2, longest_delay=5)]


def tclab():
    heaters, sensors = ["Q1_pct", "Q2_pct"], ["T1_degC", "T2_degC"]
    return [
        Unit("tclab_siso", "Temperature control lab with its old firmware: one heater (pulse "
             "width, 0..255), sensor in kelvin with steps of 0.3 K.", 1, ["Q1_pwm"], ["T1_K"],
             [("tclab_siso", 2 / 3)], longest_delay=30),
        Unit("tclab_uw_prbs", "Temperature control lab of another laboratory, open loop, two-level "
             "pseudo-random steps.", 1, heaters, sensors, [("tclab_uw_prbs", 2 / 3)], order=1,
             longest_delay=30),
        Unit("tclab_uw_setpoint", "Temperature control lab of another laboratory, set-point steps "
             "in closed loop, fitted on runs 0 and 7.", 1, heaters, sensors,
             [("tclab_setpoint_0", 1.0), ("tclab_setpoint_7", 1.0)],
             unseen=[("tclab_setpoint_4", 0.0, 1.0)], order=1, longest_delay=30,
             setpoints={"T1_degC": "T1_sp", "T2_degC": "T2_sp"})]


def tennessee_eastman():
    return [Unit(
        "tep", "Tennessee Eastman process (simulated by others, closed loop): cooling water of the "
        "reactor to its outlet temperature, steam to the stripper's temperature. Fitted on the "
        "first half of the run without a fault.", 180, ["xmv9", "xmv10"], ["xmeas18", "xmeas21"],
        [("tep_idv00", 0.5)], channels={"xmeas18": ["xmv9"], "xmeas21": ["xmv10"]})]


def isdb():
    return [Unit(
        f"isdb_{loop.lower()}", f"Loop {loop} of the International Stiction Data Base, controller "
        "output to process value, in closed loop. The time unit is the sample.", 1, ["OP"], ["PV"],
        [(f"isdb_{loop.lower()}", 2 / 3)], order=1, shortest_delay=1, longest_delay=5)
        for loop in ("CHEM1", "CHEM2", "CHEM12", "CHEM13", "PAP2", "PAP4", "PAP9")]


def refinery_loop(name, tag, recording):
    what = f"Loop {tag} of a refinery, controller output to process value, in closed loop."
    return Unit(name, what, 10, ["OP_pct"], ["PV"], [(recording, 2 / 3)], order=1, longest_delay=6,
                longest_lag=60 if "FIC" in tag else 0, setpoints={"PV": "SP"})


def refinery():
    loops = [(f"refinery_{loop.lower()}", area + loop, f"refinery_{loop.lower()}")
             for area, loop in (("2111", "FIC10201"), ("2111", "FIC40102E"), ("2111", "LIC31102B"),
                                ("2111", "PIC23001"), ("2411", "FIC20502"), ("2411", "FIC20102"))]
    loops += [(f"refinery2_{tag[4:].lower()}", tag, f"refinery2_{file:02d}")
              for tag, file in (("2111FIC51001", 0), ("2111LIC33102", 1), ("2411LIC30102", 5),
                                ("2411PDIC10321", 7), ("2411LIC30501", 9))]
    return [refinery_loop(*loop) for loop in loops]


PLANTS = (tclab, varennes, refinery, ahu, pump, rooms, houses, heat_exchanger, wall, evaporator,
          dryer, tennessee_eastman, isdb)
UNITS = [unit for plant in PLANTS for unit in plant()]
