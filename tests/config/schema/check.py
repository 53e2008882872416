#!/usr/bin/env python3
"""check.py BUILD SOURCE: an independent validator takes every unit file that is shipped, in its own
words and with all defaults as the daemon prints it, and refuses what the loader refuses. Exit 77
(skipped) where python3-jsonschema or python3-yaml is not installed."""

import copy
import json
import pathlib
import re
import subprocess
import sys

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"SKIPPED: {missing}", file=sys.stderr)
    sys.exit(77)


class Core(yaml.SafeLoader):
    """YAML 1.2 as editors read it: 1e-4 is a number, a date and `on` are texts."""


Core.yaml_implicit_resolvers = {}
for tag, pattern, first in [
    ("null", r"^(?:~|null|Null|NULL|)$", ["~", "n", "N", ""]),
    ("bool", r"^(?:true|True|TRUE|false|False|FALSE)$", list("tTfF")),
    ("int", r"^[-+]?[0-9]+$", list("-+0123456789")),
    ("float", r"^(?:[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.inf|\.nan)$",
     list("-+0123456789.")),
]:
    Core.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(pattern), first)

# What no shipped file has.
EVERYTHING = """
unit: t
sample_time: 2
signals: {mv: [u1, {tag: u2, unit: "%", low: 0, high: 1e2}], dv: d1, cv: [y1, {tag: y2, description: 7}],
          aux: [t_amb], raw: [r], calc: {d1: r / 2, y1: {expression: r + 1, unit: degC}}}
model:
  operating_point: {u1: 40, y1: 50, y2: 10}
  channels:
    - {cv: y1, mv: u1, tanks: {time_constants: [20, 35], empty_input: 10, empty_output: 20,
       overflow: [1.5, .inf], spill: 0.25, dead_time: 3.5}, input: {deadband: 0.5}}
    - {cv: y1, mv: u2, gain: 2, time_constants: 9, input: {polynomial: [1, 0.25]}}
    - {cv: y2, mv: u1, numerator: [0.1], denominator: [1, -0.9], input: {saturation: [5, 60]}}
    - {cv: y2, mv: u2, gain: 3, time_constants: [5], input: {stiction: {band: 2, jump: 1}}}
    - {cv: y2, dv: d1, step_response: [0, 0.5, 0.75]}
  input: {u1: {stuck: {value: 4, onset: 2024-03-01T13:00:00Z}}, u2: {offset: 2}}
  output: {y1: {scale: 2}}
  state: [{cv: y2, mv: u1, restoring_force: {cubic: -0.5}}]
  disturbances: [{cv: y1, shape: step, onset: 2024-03-01T13:00:00.25+01:00, size: 1e-4},
                 {cv: y2, shape: periodic, size: 0.5, period: 70, wave: square}]
monitor: {materiality: {gain: 0.1, channels: [{cv: y1, mv: u1, gain: 0.3}]}, nonlinear: off}
alarms: {latching: false, controller: {class: alarm, consequence: a, action: b, time_to_respond: 9}}
dds: {peers: [10.0.0.1]}
simulation: {noise: {sigma: 0.1}, setpoints: {y1: {hold: 3}}, limits: {u1: {max_move: 2}},
             cv_weights: 2, aux_movement: {t_amb: {sigma: 0.2, pole: 0.98}}}
identify: {channels: [{cv: y1, mv: u1, sign: "+"}, {cv: y2, dv: d1, relation: none}]}
"""

BAD = ["unti: x", "sample_time: 0", "sample_time: fast", "signals: {mv: [u1]}",
       "monitor: {memroy: 3}", "monitor: {false_alarm_rate: 1.5}", "monitor: {first_lag: 0.5}",
       "alarms: {controller: {class: alarm}}", "dds: {domain: 231}",
       "model: {channels: [{cv: y1, gain: 1}]}", "model: {channels: [{cv: y1, mv: u1}]}",
       "model: {output: {y1: {scale: 0}}}"]


def main():
    build, source = map(pathlib.Path, sys.argv[1:])
    mpm, mpmd = build / "bin/mpm", build / "bin/mpmd"
    said = lambda *command: subprocess.run(command, check=True, capture_output=True, text=True).stdout
    schema = json.loads(said(mpm, "schema"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    read = lambda text: yaml.load(text, Core)
    wrong = 0

    def check(name, document):
        nonlocal wrong
        for error in validator.iter_errors(document):
            wrong += 1
            print(f"{name}: {'.'.join(map(str, error.absolute_path))}: {error.message[:200]}")

    files = sorted(path for folder in ("config/units", "config/plants", "config/cases", "tests/hmi")
                   for path in source.joinpath(folder).glob("*.yaml"))
    for path in files:
        document = read(path.read_text())
        check(path.name, document)
        with_slip = copy.deepcopy(document)
        with_slip["nobody"] = 1
        if validator.is_valid(with_slip):
            wrong += 1
            print(f"{path.name}: any key is taken")
    printable = [path for path in files
                 if subprocess.run([mpmd, "--check", "--config", path], capture_output=True).returncode == 0]
    for path in printable:
        check(f"{path.name}, printed", read(said(mpmd, "--print-config", "--config", path)))
    everything = build / "everything.yaml"
    everything.write_text(EVERYTHING)
    check("everything", read(EVERYTHING))
    loader = subprocess.run([mpmd, "--check", "--config", everything], capture_output=True, text=True)
    if "unknown" in loader.stdout:
        wrong += 1
        print(loader.stdout)
    for line in BAD:
        document = read(EVERYTHING)
        document.update(read(line))
        if validator.is_valid(document):
            wrong += 1
            print(f"taken: {line}")
    print(f"{len(files)} unit files, {len(printable)} of them printed, {len(BAD)} bad ones")
    return 1 if wrong or len(printable) < 20 else 0


sys.exit(main())
