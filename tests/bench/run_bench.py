#!/usr/bin/python3
"""Speed of the monitor beside its peers, in turns on the same machine: run_bench.py BUILD_DIR
[--json FILE]. Needs numpy and scikit-learn; bounded to about five minutes."""

import argparse
import itertools
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy
import numpy  # noqa: E402

import kernels  # noqa: E402
import peers  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
ROUNDS = 7
LAMBDA = 0.999
WINDOW = 2000
SIZES = {"3x3": (3, 3, 40), "10x20": (10, 20, 60)}
TARGETS = {"3x3": 15.0, "10x20": 10.0}  # times faster than numpy RLS
UDP_TARGET = 10.0  # p99 through the daemon against p99 of UDP

OWN = [  # case of bench_core, seconds per round, what it is
    ("lagged_update_3x3", 0.1, "lagged correlation 3x3: update"),
    ("lagged_evaluate_3x3", 0.1, "lagged correlation 3x3: evaluate"),
    ("lagged_update_10x20", 0.2, "lagged correlation 10x20: update"),
    ("lagged_evaluate_10x20", 0.1, "lagged correlation 10x20: evaluate"),
    ("givens_update_3x3", 0.1, "one factor of 3x3: update"),
    ("givens_update_10x20", 0.1, "one factor of 10x20: update"),
    ("channel_update_3x3", 0.1, "mismatch detector 3x3: update"),
    ("channel_evaluate_3x3", 0.1, "mismatch detector 3x3: evaluate"),
    ("channel_update_10x20", 0.1, "mismatch detector 10x20: update"),
    ("channel_evaluate_10x20", 0.2, "mismatch detector 10x20: evaluate"),
    ("coupled_evaluate_3x3", 0.2, "mismatch detector 3x3: evaluate, all CVs judged together"),
    ("coupled_evaluate_10x20", 2.0, "mismatch detector 10x20: evaluate, all CVs judged together"),
    ("monitor_push_3x3", 0.1, "whole monitor, Shell 3x3: one frame"),
    ("mpc_step_free", 0.1, "MPC, Shell 3x3: one step, no limit active"),
    ("mpc_step_limited", 0.1, "MPC, Shell 3x3: one step, limits active"),
]


class Core:
    """bench_core as a server: one case at a time."""

    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True)
        self.compiler = self.process.stdout.readline().strip()

    def median_us(self, case, seconds):
        self.process.stdin.write(f"{case} {seconds}\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"bench_core ended at {case}")
        return float(line)

    def close(self):
        self.process.stdin.close()
        self.process.wait(timeout=10)


def spread(values):
    return {"min": min(values), "median": statistics.median(values), "max": max(values)}


def figure(name, ours, peer=None, peer_values=None, target=None):
    """Ours and the peer's come in pairs of one round; the ratio is the median of theirs."""
    result = {"name": name, "unit": "us", "value": spread(ours)}
    if peer:
        result["peer"] = {"name": peer, "value": spread(peer_values)}
        result["ratio"] = spread([b / a for a, b in zip(ours, peer_values)])
    if target:
        result["target"] = f">= {target:g} x"
        result["met"] = result["ratio"]["median"] >= target
    return result


def own_figures(core):
    times = {case: [] for case, _, _ in OWN}
    for _ in range(ROUNDS):
        for case, seconds, _ in OWN:
            times[case].append(core.median_us(case, seconds))
    return [figure(name, times[case]) for case, _, name in OWN]


def recursive_figures(core, size):
    mvs, cvs, g = SIZES[size]
    small = size == "3x3"
    x, y = peers.random_rows(mvs, cvs, g, 700, range(mvs))
    rows = itertools.cycle(zip(x, y))  # going on where it stopped: all directions stay excited
    rls = peers.Rls(mvs, x.shape[2], y.shape[2], LAMBDA, batched=small)
    plain_rls = peers.PlainRls(mvs, x.shape[2], y.shape[2], LAMBDA)
    ours, plain, full, training = [], [], [], []
    for _ in range(ROUNDS):
        ours.append(core.median_us(f"lagged_step_{size}", 0.3))
        plain.append(peers.median_us(plain_rls.step, 0.3 if small else 0.7, rows))
        full.append(peers.median_us(rls.step, 0.3 if small else 0.7, rows))
        training.append(peers.median_us(rls.train, 0.3 if small else 0.7, rows))
    name = f"lagged correlation {size}: every sample"
    return [
        figure(name, ours, "numpy RLS, usual", plain, TARGETS[size]),
        figure(name, ours, "numpy RLS, tuned", full, TARGETS[size]),
        figure(name, ours, "tuned, training only", training),
    ]


def batch_figure(core, size):
    """The large size: one MV of all, times their number."""
    mvs, cvs, g = SIZES[size]
    chosen = range(mvs) if size == "3x3" else [0]
    x, y = peers.random_rows(mvs, cvs, g, WINDOW, chosen)

    def all_chosen():
        for i in range(len(chosen)):
            peers.batch_correlations(x[:, i], y[:, i])

    ours, batch = [], []
    for _ in range(3 if size == "3x3" else 1):
        ours.append(core.median_us(f"lagged_step_{size}", 0.3))
        batch.append(peers.median_us(all_chosen, 0.3, itertools.repeat(())) * mvs / len(chosen))
    return figure(f"lagged correlation {size}: every sample", ours,
                  f"numpy lstsq, {WINDOW} rows", batch)


def latency_figures(build, push_us):
    unit = ROOT / "config/plants/shell3x3.yaml"
    output = subprocess.run([build / "bin/bench_latency", build / "bin/mpmd", unit], check=True,
                            stdout=subprocess.PIPE, text=True, timeout=120).stdout
    trips = {}
    for line in output.splitlines():
        name, median, p99, count = line.split()
        trips[name] = {"median": float(median), "p99": float(p99), "count": int(count)}
    figures = []
    for suffix, pace in (("", "back to back"), ("_paced", "every 4 ms")):
        udp = trips["udp" + suffix]
        figures.append({"name": f"UDP round trip, {pace}", "unit": "us", "value": udp})
        for kind, what in (("dds", "DDS round trip"), ("mpmd", "frame to all 9 statuses")):
            trip = trips[kind + suffix]
            result = {"name": f"{what}, {pace}", "unit": "us", "value": trip,
                      "peer": {"name": "UDP round trip", "value": udp},
                      "ratio_of_p99": trip["p99"] / udp["p99"]}
            if kind == "mpmd":
                result["computation_us"] = push_us
                result["without_computation"] = {
                    "median": trip["median"] - push_us, "p99": trip["p99"] - push_us}
                result["target"] = f"p99 <= {UDP_TARGET:g} x UDP"
                result["met"] = result["ratio_of_p99"] <= UDP_TARGET
            figures.append(result)
    return figures


RECORDER_TARGET = 10_000.0  # samples/s
WEEK = 604_800  # rows of 1 Hz
WEEK_PART = WEEK // 25
WEEK_TARGET_S = 60.0


def recording_figures(build):
    def measure(*arguments):
        output = subprocess.run([build / "bin/bench_recording", build / "bin/mpm", *arguments],
                                check=True, stdout=subprocess.PIPE, text=True, timeout=900).stdout
        return float(output.split()[1])

    recorded = measure("recorder")
    seconds = measure("week", str(WEEK_PART)) * WEEK / WEEK_PART
    return [
        {"name": "mpm record, ten values each: samples/s without a loss", "unit": "1/s",
         "value": recorded, "target": f">= {RECORDER_TARGET:g}",
         "met": recorded >= RECORDER_TARGET},
        {"name": "mpm replay --rate 0, one reader: samples/s", "unit": "1/s",
         "value": measure("replay")},
        {"name": "mpm detect, a week of 1 Hz of 10x10, from 4 % of it: s", "unit": "s",
         "value": seconds, "target": f"<= {WEEK_TARGET_S:g}", "met": seconds <= WEEK_TARGET_S},
    ]


DETECT_ROWS = 40_000  # of Shell 3x3, 12 signals
FLAT = 1.2  # memory for ten times the rows, at most so much more


def run_measured(*command):
    """Seconds and peak resident kB of one program."""
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command[0]} ended with {process.returncode}")
    return time.monotonic() - begin, usage.ru_maxrss


def file_figures(build):
    """Detect on either kind of file; size and memory of recordings."""
    unit = str(ROOT / "config/plants/shell3x3.yaml")
    mpm = build / "bin/mpm"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        peaks = {}
        for rows in (DETECT_ROWS // 10, DETECT_ROWS):
            csv, mcap = folder / f"{rows}.csv", folder / f"{rows}.mcap"
            run_measured(build / "bin/mpmsim", "--config", unit, "--scenario", "none", "--seed", "1",
                         "--samples", str(rows), "--csv", csv)
            run_measured(mpm, "convert", csv, mcap, "--config", unit)
            for file in (csv, mcap):
                peaks[file.suffix, rows] = [
                    run_measured(mpm, "detect", "--config", unit, "--data", file) for _ in range(3)]
        bytes_per_value = mcap.stat().st_size / (rows * 12)
    figures = [{"name": "MCAP, bytes per value (Shell 3x3, converted)", "unit": "byte",
                "value": bytes_per_value}]
    for suffix, what in ((".csv", "CSV"), (".mcap", "MCAP")):
        fast = min(seconds for seconds, _ in peaks[suffix, DETECT_ROWS])
        figures.append({"name": f"mpm detect from {what}, Shell 3x3: samples/s", "unit": "1/s",
                        "value": DETECT_ROWS / fast})
    growth = (max(kb for _, kb in peaks[".mcap", DETECT_ROWS]) /
              max(kb for _, kb in peaks[".mcap", DETECT_ROWS // 10]))
    figures.append({"name": "mpm detect from MCAP, memory for ten times the rows", "unit": "ratio",
                    "value": growth, "target": f"<= {FLAT:g}", "met": growth <= FLAT})
    return figures


DIAGNOSED_ROWS = 5000
DIAGNOSIS_TARGET_S = 10.0  # on one core


def diagnosis_figures(build):
    """One core and all of them in turns; what is written is compared too."""
    here = Path(__file__).resolve().parent
    unit = here / "two_by_two.yaml"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        data, out = folder / "data.csv", folder / "report"
        run_measured(build / "bin/mpmsim", "--config", unit, "--scenario",
                     here / "much_wrong.yaml", "--seed", "1", "--samples", str(DIAGNOSED_ROWS),
                     "--csv", data)

        def seconds(*options):
            took, _ = run_measured(build / "bin/mpm", "diagnose", "--config", unit, "--data", data,
                                   "--out", out, "--quiet", *options)
            report = json.loads((out / "report.json").read_text(encoding="utf-8"))
            del report["made_by"]["command"]
            return took, report

        alone, together = [], []
        for _ in range(ROUNDS):
            took, report = seconds("--threads", "1")
            alone.append(took)
            took, other = seconds()
            together.append(took)
            if other != report:
                sys.exit("mpm diagnose says something else on all cores than on one")
    one = statistics.median(alone)
    gain = statistics.median(a / b for a, b in zip(alone, together))
    what = f"mpm diagnose, 2x2 and two aux signals, {DIAGNOSED_ROWS} samples"
    return [
        {"name": f"{what}: s on one core", "unit": "s", "value": one,
         "target": f"<= {DIAGNOSIS_TARGET_S:g}", "met": one <= DIAGNOSIS_TARGET_S},
        {"name": f"  times faster on all {os.cpu_count()} cores", "unit": "ratio", "value": gain},
    ]


def number(value):
    return f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def verdict(item):
    if "target" not in item:
        return ""
    return f"{item['target']}: {'met' if item['met'] else 'MISSED'}"


def print_table(result):
    machine = result["machine"]
    print(f"{machine['cpu']}, {machine['cores']} cores; {machine['compiler']}; "
          f"numpy {machine['numpy']}, one thread, BLAS {machine['blas']}")
    line = "{:<44}{:>10}{:>10}{:>10}  {:<24}{:>10}{:>8}  {:<16}{}".format
    print()
    print(line("microseconds, medians of rounds", "min", "median", "max", "peer", "median",
               "ratio", "(min .. max)", "target"))
    for item in result["throughput"]:
        value, peer, ratio = item["value"], item.get("peer"), item.get("ratio")
        print(line(item["name"], number(value["min"]), number(value["median"]),
                   number(value["max"]), peer["name"] if peer else "",
                   number(peer["value"]["median"]) if peer else "",
                   number(ratio["median"]) if ratio else "",
                   f"({number(ratio['min'])} .. {number(ratio['max'])})" if ratio else "",
                   verdict(item)))
    print()
    line = "{:<44}{:>10}{:>10}{:>12}  {}".format
    print(line("latency, microseconds", "median", "p99", "p99 / UDP", "target"))
    for item in result["latency"]:
        ratio = item.get("ratio_of_p99")
        print(line(item["name"], number(item["value"]["median"]), number(item["value"]["p99"]),
                   f"{ratio:.3g}" if ratio else "", verdict(item)))
        if "computation_us" in item:
            rest = item["without_computation"]
            print(line(f"  less {number(item['computation_us'])} of computation",
                       number(rest["median"]), number(rest["p99"]), "", ""))


    print()
    line = "{:<60}{:>10}  {}".format
    print(line("recordings and their diagnosis", "", "target"))
    for item in result["recording"] + result["diagnosis"]:
        print(line(item["name"], number(item["value"]), verdict(item)))


def cpu_name():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown CPU"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path, help="folder of a Release build with MPM_BENCH=ON")
    parser.add_argument("--json", type=Path, help="write every figure to this file")
    options = parser.parse_args()
    program = options.build / "bin/bench_core"
    if not program.exists():
        sys.exit(f"{program} does not exist: build with -DMPM_BENCH=ON")

    core = Core(program)
    throughput = []
    for size in SIZES:
        throughput += recursive_figures(core, size)
        throughput.append(batch_figure(core, size))
    own = own_figures(core)
    throughput += own
    core.close()
    push_us = next(item["value"]["median"] for item in own if "whole monitor" in item["name"])
    result = {
        "machine": {"cpu": cpu_name(), "cores": os.cpu_count(), "compiler": core.compiler,
                    "numpy": numpy.__version__, "blas": peers.blas_library()},
        "throughput": throughput,
        "latency": latency_figures(options.build, push_us),
        "recording": recording_figures(options.build) + file_figures(options.build),
        "diagnosis": diagnosis_figures(options.build),
        "methods": kernels.costs(options.build, ["3x3"]),
    }
    print_table(result)
    print("\nmethods of docs/nonlinear.md\n", kernels.cost_table(result["methods"]), "",
          "share of a kernel that is missed; microseconds a point",
          kernels.kernel_tables(options.build, dimensions=(1, 2), sizes=(4, 16, 64)), sep="\n")
    if options.json:
        options.json.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
