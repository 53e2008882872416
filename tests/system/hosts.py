#!/usr/bin/python3
"""Three hosts that stand by for one another: each is lost in turn, and comes back.

Usage: hosts.py --bin build/release/bin [--losses 30] [--bounds]

Each host is a network namespace of its own on one bridge (root). Units u0, u1, u2, of whose
plants one channel each is wrong (scenario hidden_gain of config/plants/shell3x3.yaml): host i speaks
for ui and stands by for the unit of the host before it. A host is lost without a word: its link goes down,
then its processes are killed. Said is how long nobody spoke for each unit that it spoke for, as one
who reads mpm/health on a fourth host sees it, and of which alarms readers were told.
"""
import argparse
import json
import os
import pathlib
import random
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

HOSTS = 3
NET = "10.231.7"


class Net:
    """Namespaces on one bridge, gone in the end."""

    def __init__(self, names):
        self.tag = f"mpm{os.getpid()}"
        self.made = []
        self.netns("wire")
        self.inside("wire", "ip", "link", "add", "bridge0", "type", "bridge")
        self.inside("wire", "ip", "link", "set", "bridge0", "up")
        for number, name in enumerate(names):
            self.netns(name)
            self.inside("wire", "ip", "link", "add", f"to{number}", "type", "veth", "peer", "name",
                        "net0", "netns", self.name(name))
            self.inside("wire", "ip", "link", "set", f"to{number}", "master", "bridge0", "up")
            self.inside(name, "ip", "addr", "add", f"{NET}.{number + 1}/24", "dev", "net0")
            for link in "lo", "net0":
                self.inside(name, "ip", "link", "set", link, "up")
            self.inside(name, "ip", "route", "add", "224.0.0.0/4", "dev", "net0")
        self.port = {name: f"to{number}" for number, name in enumerate(names)}

    def name(self, name):
        return f"{self.tag}-{name}"

    def netns(self, name):
        subprocess.run(["ip", "netns", "add", self.name(name)], check=True)
        self.made.append(name)

    def inside(self, name, *command):
        subprocess.run(["ip", "netns", "exec", self.name(name), *command], check=True)

    def start(self, name, *command, **more):
        return subprocess.Popen(["ip", "netns", "exec", self.name(name), *command], **more)

    def plug(self, name, state):
        self.inside("wire", "ip", "link", "set", self.port[name], state)

    def close(self):
        for name in self.made:
            subprocess.run(["ip", "netns", "del", self.name(name)], check=False)


class Watch:
    """What one who reads hears, with when it came."""

    def __init__(self, net, program, folder, topic):
        self.heard = []
        self.process = net.start("control", program, "echo", topic, "--json", "--config",
                                 folder / "u0.yaml", stdout=subprocess.PIPE,
                                 stderr=subprocess.DEVNULL, text=True)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            words = json.loads(line)
            if "sample" in words:  # else somebody has left
                self.heard.append((time.monotonic(), words["sample"]))

    def first_after(self, moment, unit, timeout=20.0):
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            for when, sample in list(self.heard):
                if when > moment and sample["unit"] == unit:
                    return when - moment
            time.sleep(0.002)
        raise RuntimeError(f"nobody speaks for {unit}")


def unit_text(template, number):
    lines = [line for line in template.splitlines()
             if not line.startswith(("unit:", "dds:", "monitor:"))]
    return "\n".join([f"unit: u{number}"] + lines + ["monitor: {diagnosis_samples: 0}"]
                     + ["dds: {domain: 9, interface: net0, multicast: true}", ""])


def units_of(host):
    return host, (host - 1) % HOSTS


def partner(host, unit):
    """Who stands by where `host` speaks."""
    return next(other for other in range(HOSTS) if other != host and unit in units_of(other))


def start_host(net, binaries, folder, number):
    """Its own unit and the one of the host before it."""
    started = []
    for unit, rank in zip(units_of(number), ("10", "0")):
        log = open(folder / f"h{number}-u{unit}.log", "a", encoding="utf-8")
        started.append(net.start(
            f"h{number}", binaries / "mpmd", "--config", folder / f"u{unit}.yaml", "--standby",
            "--standby-rank", rank, "--state-dir", folder / f"h{number}-u{unit}", stderr=log))
    return started


def lose(net, number, processes):
    net.plug(f"h{number}", "down")
    moment = time.monotonic()
    for process in processes:
        process.send_signal(signal.SIGKILL)
        process.wait()
    return moment


def alarms(events):
    """Unit: what readers were told of its channels."""
    told = {}
    for _, event in list(events.heard):
        if event["to"] != "diagnosed":
            told.setdefault(event["unit"], []).append(
                f"{event['mv']}->{event['cv']} {event['to']}")
    return told


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--losses", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--logs", type=pathlib.Path,
                        help="keep what the monitors log there, and tell each loss")
    parser.add_argument("--bounds", action="store_true",
                        help="fail where an alarm is lost or told twice")
    options = parser.parse_args()
    if os.geteuid() != 0 or shutil.which("ip") is None:
        print("SKIPPED: network namespaces take root and the program ip")
        sys.exit(77)
    binaries = options.bin.resolve()
    template = (pathlib.Path(__file__).parents[2] / "config/plants/shell3x3.yaml").read_text()
    net = Net(["control"] + [f"h{number}" for number in range(HOSTS)])
    chance = random.Random(options.seed)
    processes = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.logs or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            for number in range(HOSTS):
                (folder / f"u{number}.yaml").write_text(unit_text(template, number))
            hosts = [start_host(net, binaries, folder, number) for number in range(HOSTS)]
            processes += [each for host in hosts for each in host]
            health = Watch(net, binaries / "mpm", folder, "mpm/health")
            events = Watch(net, binaries / "mpm", folder, "mpm/alarm_event")
            time.sleep(3.0)
            plants = [net.start("control", binaries / "mpmsim", "--config",
                                folder / f"u{number}.yaml", "--seed", str(number + 1),
                                "--speed", "50", "--readers", "2", "--scenario", "hidden_gain",
                                stderr=subprocess.DEVNULL)
                      for number in range(HOSTS)]
            processes += plants + [health.process, events.process]
            took = []
            speaker = list(range(HOSTS))
            for loss in range(options.losses):
                time.sleep(4.0 + 3.0 * chance.random())
                number = loss % HOSTS
                moment = lose(net, number, hosts[number])
                for unit in units_of(number):
                    if speaker[unit] == number:
                        speaker[unit] = partner(number, unit)
                        took.append(health.first_after(moment, f"u{unit}"))
                        if options.logs:
                            print(f"{time.time():.3f} h{number} lost: u{unit} after {took[-1]:.3f}")
                time.sleep(1.0)
                net.plug(f"h{number}", "up")
                hosts[number] = start_host(net, binaries, folder, number)
                processes += hosts[number]
            told = alarms(events)
            while options.bounds and len(told) < HOSTS and plants[0].poll() is None:
                time.sleep(0.5)  # on a slow machine not all have risen
                told = alarms(events)
        finally:
            for process in processes:
                if process.poll() is None:
                    process.kill()
                    process.wait()
            net.close()
    print(f"{options.losses} hosts lost: silent for {1e3 * statistics.median(took):.0f} ms "
          f"(median), {1e3 * max(took):.0f} ms at most")
    for unit, words in sorted(told.items()):
        print(f"{unit}: {', '.join(words)}")
    if options.bounds and any(len(told.get(f"u{number}", [])) != 1 for number in range(HOSTS)):
        sys.exit("an alarm was lost or told twice")


if __name__ == "__main__":
    main()
