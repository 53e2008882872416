#!/usr/bin/env python3
"""gateway.py UNIT.yaml SAMPLES [MPM-OPTIONS]: as gateway.c, without DDS: writes to the pipe of
`mpm publish`, one line per control interval."""
import json
import math
import random
import subprocess
import sys

command = ["mpm", "publish", "--config", sys.argv[1], "--format", "json"]
random.seed(1)
pole = math.exp(-1 / 5)
u, y = [0.0, 0.0], 0.0
with subprocess.Popen(command + sys.argv[3:], stdin=subprocess.PIPE, text=True) as publish:
    for k in range(int(sys.argv[2])):
        measured = y + 0.1 * (random.random() - 0.5)
        y = pole * y + (1 - pole) * (4 * u[0] + u[1])  # the model says 2 where this says 4
        u = [random.choice([-1.0, 1.0]) if random.random() < 0.1 else value for value in u]
        line = {"time": 1.7e9 + k, "u1": u[0], "u2": u[1], "y1": measured}
        publish.stdin.write(json.dumps(line) + "\n")
    publish.stdin.close()
sys.exit(publish.returncode)
