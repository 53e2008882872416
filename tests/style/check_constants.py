#!/usr/bin/env python3
"""Numbers that decide a result stand in their room's calibration.hpp and nowhere else.

Looks at the rooms of the monitor for floating-point numbers other than 0, 0.5, 1 and 2 and whole
numbers from 10 on, outside comments and strings. What is structure and decides nothing is allowed
below, with its reason.
"""
import pathlib
import re
import sys

ROOMS = ["alarm", "archive", "identification", "mismatch", "model", "monitor", "nonlinear", "performance", "regression", "signal", "statistics"]
PLAIN = {0.0, 0.5, 1.0, 2.0}
FIRST_WHOLE = 10
ALLOWED = {  # file: numbers, why
    "mismatch/box_least_squares.cpp": ({27}, "ways in which three pairs of bounds can hold"),
    "mismatch/materiality.cpp": ({3.0}, "tests of which the smallest p counts"),
    "mismatch/curvature.cpp": ({3.0, 4.0}, "of a cubic's derivative; of the variance of a quadratic form"),
    "model/linear_model.hpp": ({0.01, 100000}, "default arguments, for callers to set"),
    "model/state_feedback.cpp": ({3.0, 200}, "of a cubic's derivative; most steps of a bisection"),
    "model/tank_channel.cpp": ({0.43586652150845899942, 0.25, 4.0, 5.0, 6.0, 16.0, 20.0},
                               "the integration method's own coefficients"),
    "model/zero_order_hold.cpp": ({16}, "terms of a series to double precision"),
    "monitor/f_thresholds.hpp": ({32}, "room made up front"),
    "monitor/predictions.cpp": ({1e-9}, "seconds of a nanosecond"),
    "monitor/settings.hpp": (None, "what the user may set, with its default and meaning"),
    "nonlinear/channel_nonlinearity.hpp": ({100.0}, "most that is said of what is not known"),
    "nonlinear/nonlinear_regression.cpp": ({32}, "rows taken together: speed only"),
    "regression/leave_one_out_qr.cpp": ({32}, "rows taken together: speed only"),
    "regression/row_feed.hpp": ({32}, "rows taken together: speed only"),
    "regression/rotation.cpp": ({1e-280, 1e280}, "squares that can neither overflow nor underflow"),
    "regression/rotation.hpp": ({64}, "bytes"),
    "regression/rotation_kernel.cpp": ({16, 32, 64}, "bytes and rows of the machine's registers"),
    "signal/nanoseconds.hpp": ({1e9, 1000000000}, "nanoseconds of a second"),
    "statistics/cross_correlation.cpp": (None, "of a report's plot: nothing is decided by it"),
    "statistics/normal.hpp": ({1.96, 1.645, 2.326}, "quantiles, compared with Boost.Math by a test"),
    "statistics/spectrum.cpp": (None, "of a report's plot: nothing is decided by it"),
}
NUMBER = re.compile(r"(?<![\w.])(\d[\d']*(?:\.\d*)?(?:[eE][+-]?\d+)?)[uUlLfF]*(?![\w.])")


def code_of(path):
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m[0].count("\n"), path.read_text(), flags=re.S)
    return re.sub(r'//[^\n]*|"(?:\\.|[^"\\])*"|^\s*#[^\n]*', "", text, flags=re.M)


def is_plain(text):
    if re.fullmatch(r"[\d']+", text):
        return int(text.replace("'", "")) < FIRST_WHOLE
    return float(text) in PLAIN


def main():
    core = pathlib.Path(__file__).resolve().parents[2] / "core"
    used, bad = set(), 0
    for room in ROOMS:
        for path in sorted((core / room).glob("*.[ch]pp")):
            name = f"{room}/{path.name}"
            allowed = ALLOWED.get(name, (set(), ""))[0]
            if path.name == "calibration.hpp":
                continue
            for number, line in enumerate(code_of(path).splitlines(), 1):
                for match in NUMBER.finditer(line):
                    if is_plain(match[1]):
                        continue
                    if allowed is None or float(match[1].replace("'", "")) in allowed:
                        used.add(name)
                        continue
                    bad += 1
                    print(f"core/{name}:{number}: {match[0]}: give it a name, a unit and an origin "
                          f"in core/{room}/calibration.hpp")
    for name in sorted(set(ALLOWED) - used):
        bad += 1
        print(f"core/{name}: allowed numbers that are not there (tests/style/check_constants.py)")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
