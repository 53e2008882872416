#!/usr/bin/env python3
"""alarms.py DOMAIN SECONDS [MPM-OPTIONS]: as alarms.c, without DDS: reads the pipe of `mpm echo`."""
import json
import subprocess
import sys

command = ["mpm", "echo", "mpm/alarm", "--json", "--domain", sys.argv[1], "--duration", sys.argv[2]]
with subprocess.Popen(command + sys.argv[3:], stdout=subprocess.PIPE, text=True) as echo:
    for line in echo.stdout:
        said = json.loads(line)
        if "sample" in said:
            alarm = said["sample"]
            print("alarm", alarm["unit"], alarm["mv"], alarm["cv"], alarm["to"], flush=True)
        else:  # disposed, or its monitor has left
            print("alarm", said["unit"], said["mv"], said["cv"], said["state"], flush=True)
sys.exit(echo.returncode)
