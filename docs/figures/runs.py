"""Runs of the thesis's scenarios through mpmsim and `mpm detect`, for draw.py and study.py."""
import csv
import json
import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("MPM_BIN", os.path.join(ROOT, "build", "release", "bin"))

SHELL = "shell3x3"
HIGH_MODEL = "shell3x3_high_model"
MVS, CVS = ("u1", "u2", "u3"), ("y1", "y2", "y3")
FIRST_LAG = -10
METHODS = (("conventional", "3.4"), ("partial", "3.14"), ("lagged_partial", "3.15"),
           ("alternative", "3.16"))

# Name, title, plant, scenario, channels (cv, mv) that the thesis wants to be found.
U1_Y1, U1_Y2, U1_Y3, U3_Y2 = (0, 0), (1, 0), (2, 0), (1, 2)
STUDIES = (
    ("S1", "Scenario 1: nothing hidden", SHELL, "none", ()),
    ("S2, no integral action", "Scenario 2 as written, no integral action", SHELL,
     "s2_gain25_no_integral", (U1_Y1, U1_Y2)),
    ("S2, tight limits", "Scenario 2 as written, |u| \u2264 1.5", SHELL, "s2_gain25_limits",
     (U1_Y1, U1_Y2)),
    ("S2, high model", "Scenario 2, (4.1) is the plant and the model is too high", HIGH_MODEL,
     "s2_gain25", (U1_Y1, U1_Y2)),
    ("S2, 15 %", "Scenario 2 with 15 %", SHELL, "s2_gain15", (U1_Y1, U1_Y2)),
    ("S3", "Scenario 3: MV1 four samples later", SHELL, "s3_delay", (U1_Y1, U1_Y2, U1_Y3)),
    ("S4", "Scenario 4: MV3-CV2 40 % lower, all others 3-5 % off", SHELL, "s4_gain40", (U3_Y2,)),
)
LAGS_SWEPT = (5, 10, 20, 40, 80)


def unit_file(plant):
    return os.path.join(ROOT, "config", "plants", plant + ".yaml")


def simulate(plant, scenario, seed, folder):
    """Path of the data file of 3000 samples."""
    path = os.path.join(folder, f"{plant}-{scenario}-{seed}.csv")
    subprocess.run([os.path.join(BIN, "mpmsim"), "--config", unit_file(plant), "--scenario",
                    scenario, "--samples", "3000", "--seed", str(seed), "--csv", path], check=True)
    return path


def read(path):
    """Column name -> values."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[c]) for row in rows[1:]] for c, name in enumerate(rows[0])}


def control_error_variance(columns, cv):
    error = [s - y for s, y in zip(columns[f"sp{cv + 1}"], columns[f"y{cv + 1}"])]
    mean = sum(error) / len(error)
    return sum((e - mean) ** 2 for e in error) / len(error)


class Correlations:
    """What `mpm detect` says of a data file, all samples weighed alike, as in the thesis."""

    def __init__(self, plant, path, method, controlling_lags=40):
        overlay = path + "." + method + ".yaml"
        with open(overlay, "w") as file:
            file.write(f"monitor: {{correlation: {method}, threshold: mean_line, "
                       f"controlling_lags: {controlling_lags}, memory: 1.0e+9}}\n")
        out = subprocess.run([os.path.join(BIN, "mpm"), "detect", "--config", unit_file(plant),
                              "--data", path, "--scenario", overlay, "--json"],
                             check=True, stdout=subprocess.PIPE).stdout
        self.values, self.largest, self.p_value = {}, {}, {}
        for channel in json.loads(out)["channels"]:
            key = (CVS.index(channel["cv"]), MVS.index(channel["mv"]))
            self.values[key] = channel["partial_correlations"]["values"]
            self.largest[key] = channel["statistic"]  # over lags >= 1
            self.p_value[key] = channel["p_value"]
            self.line = channel["threshold"]
