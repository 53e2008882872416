#!/usr/bin/env python3
"""check.py BUILD SOURCE: a real Prometheus scrapes /metrics of a monitor whose model is wrong, and the
shipped rules fire; those that wait for minutes are played by promtool. What the shipped dashboard asks
has an answer. Exit 77 (skipped) where prometheus is not installed."""

import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.parse
import urllib.request

# By its path too: Debian's is not in everybody's.
tools = {name: shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/bin:/usr/sbin")
         for name in ("prometheus", "promtool")}
if None in tools.values():
    print("SKIPPED: no prometheus on this machine (Debian package prometheus)", file=sys.stderr)
    sys.exit(77)

RULES_PLAYED = """
rule_files: [RULES]
evaluation_interval: 1m
tests:
  # A unit whose samples stop after ten minutes, and which says that it is out of specification.
  - interval: 1m
    input_series:
      - {series: 'mpm_frames_total{unit="shell"}', values: '0+60x10 600x40'}
      - {series: 'mpm_health{unit="shell",state="out_of_specification"}', values: '0x10 1x40'}
      - {series: 'mpm_build_info{version="x"}', values: '1x30'}
    alert_rule_test:
      - {eval_time: 15m, alertname: MpmNobodySpeaks, exp_alerts: []}
      - {eval_time: 15m, alertname: MpmNoData, exp_alerts: []}
      - {eval_time: 12m, alertname: MpmUnhealthy, exp_alerts: []}
      - eval_time: 30m
        alertname: MpmNoData
        exp_alerts:
          - exp_labels: {severity: warning, unit: shell}
            exp_annotations: {summary: "shell: no complete sample for ten minutes"}
      - eval_time: 30m
        alertname: MpmUnhealthy
        exp_alerts:
          - exp_labels: {severity: warning, unit: shell, state: out_of_specification}
            exp_annotations: {summary: "shell: out_of_specification"}
      - {eval_time: 30m, alertname: MpmDown, exp_alerts: []}
      - eval_time: 45m
        alertname: MpmDown
        exp_alerts:
          - exp_labels: {severity: critical}
            exp_annotations: {summary: "no monitor of model-plant mismatch answers"}
  # Of two monitors one goes after ten minutes, as the target of another job does.
  - interval: 1m
    input_series:
      - {series: 'up{job="mpm",instance="a"}', values: '1x40'}
      - {series: 'up{job="mpm",instance="b"}', values: '1x10 0x30'}
      - {series: 'up{job="node",instance="c"}', values: '1x10 0x30'}
      - {series: 'mpm_build_info{job="mpm",instance="a"}', values: '1x40'}
      - {series: 'mpm_build_info{job="mpm",instance="b"}', values: '1x10 _x30'}
    alert_rule_test:
      - {eval_time: 10m, alertname: MpmDown, exp_alerts: []}
      - eval_time: 20m
        alertname: MpmDown
        exp_alerts:
          - exp_labels: {severity: critical, job: mpm, instance: b}
            exp_annotations: {summary: "b: the monitor does not answer"}
  # The only one goes: that is told once.
  - interval: 1m
    input_series:
      - {series: 'up{job="mpm",instance="a"}', values: '1x10 0x30'}
      - {series: 'mpm_build_info{job="mpm",instance="a"}', values: '1x10 _x30'}
    alert_rule_test:
      - eval_time: 20m
        alertname: MpmDown
        exp_alerts:
          - exp_labels: {severity: critical, job: mpm, instance: a}
            exp_annotations: {summary: "a: the monitor does not answer"}
  # Two that stand by for one another; the one that speaks goes after ten minutes, and nobody goes on.
  - interval: 1m
    input_series:
      - {series: 'mpm_speaks{unit="shell",instance="a"}', values: '1x10 _x40'}
      - {series: 'mpm_speaks{unit="shell",instance="b"}', values: '0x50'}
      - {series: 'mpm_controller_alarm_active{unit="shell",instance="a"}', values: '1x10 _x40'}
      - {series: 'mpm_controller_alarm_active{unit="shell",instance="b"}', values: '1x50'}
    alert_rule_test:
      - eval_time: 5m
        alertname: MpmControllerAlarm
        exp_alerts:
          - exp_labels: {severity: warning, unit: shell, instance: a}
            exp_annotations: {summary: "shell: the controller's model does not match the plant"}
      - {eval_time: 5m, alertname: MpmNobodySpeaks, exp_alerts: []}
      - eval_time: 20m
        alertname: MpmNobodySpeaks
        exp_alerts:
          - exp_labels: {severity: critical, unit: shell}
            exp_annotations: {summary: "shell: 0 monitors speak for it, which should be one"}
"""


class Failed(Exception):
    pass


def wait_for(what, seconds, done):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = done()
        if found:
            return found
        time.sleep(0.2)
    raise Failed(f"no {what}")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Prometheus:
    def __init__(self, url):
        self.url = url

    def get(self, path, **query):
        text = urllib.parse.urlencode(query)
        with urllib.request.urlopen(f"{self.url}/api/v1/{path}?{text}", timeout=10) as reply:
            answer = json.load(reply)
        if answer["status"] != "success":
            raise Failed(f"{path} {query}: {answer}")
        return answer["data"]

    def value(self, expression):
        result = self.get("query", query=expression)["result"]
        return float(result[0]["value"][1]) if result else None

    def firing(self):
        return {alert["labels"]["alertname"]: alert for alert in self.get("alerts")["alerts"]
                if alert["state"] == "firing"}


def expressions(dashboard):
    """What panels and variables ask, as with the unit of this test chosen."""
    for panel in dashboard["panels"]:
        for target in panel.get("targets", []):
            yield panel["title"], target["expr"].replace("$unit", "shell").replace(
                "$__rate_interval", "10s")


def check(build, source, work, running):
    rules = source / "daemon/package/prometheus-rules.yml"
    subprocess.run([tools["promtool"], "check", "rules", rules], check=True, capture_output=True)
    played = work / "played.yml"
    played.write_text(RULES_PLAYED.replace("RULES", str(rules)))
    subprocess.run([tools["promtool"], "test", "rules", played], check=True)

    def start(*command):
        log = open(work / (pathlib.Path(command[0]).name + ".log"), "w")
        running.append(subprocess.Popen(command, stdout=log, stderr=log))
        return pathlib.Path(log.name)

    unit = source / "config/plants/shell3x3.yaml"
    tag = f"mpm-prometheus-{os.getpid()}"
    log = start(build / "bin/mpmd", "--config", unit, "--partition", tag, "--http", "0")
    page = wait_for("monitor", 20, lambda: re.search(r"operator page at http://(\S+)/", log.read_text()))
    (work / "prometheus.yml").write_text(
        f"global: {{scrape_interval: 1s, evaluation_interval: 1s}}\nrule_files: [{rules}]\n"
        f"scrape_configs: [{{job_name: mpm, static_configs: [{{targets: ['{page[1]}']}}]}}]\n")
    port = free_port()
    start(tools["prometheus"], f"--config.file={work}/prometheus.yml", f"--storage.tsdb.path={work}/data",
          f"--web.listen-address=127.0.0.1:{port}")
    prometheus = Prometheus(f"http://127.0.0.1:{port}")

    def answers():
        try:
            return prometheus.value("up") == 1.0
        except OSError:
            return False
    wait_for("scrape", 60, answers)
    if prometheus.firing():
        raise Failed(f"fires before anything is wrong: {prometheus.firing()}")
    start(build / "bin/mpmsim", "--config", unit, "--scenario", "hidden_gain", "--seed", "3",
          "--samples", "3000", "--speed", "300", "--wait-readers", "10", "--partition", tag)
    fired = wait_for("alert of the rules", 90, lambda: prometheus.firing() if
                     {"MpmModelMismatch", "MpmControllerAlarm"} <= set(prometheus.firing()) else None)
    summary = fired["MpmModelMismatch"]["annotations"]["summary"]
    if summary != "shell: the model of u3 -> y3 does not match the plant":
        raise Failed(f"another channel than the one whose gain is wrong: {summary}")
    unexpected = set(fired) - {"MpmModelMismatch", "MpmControllerAlarm"}
    if unexpected:
        raise Failed(f"fires without a cause: {unexpected}")
    if prometheus.value('sum(mpm_verdict{unit="shell",mv="u3",cv="y3",verdict="mismatch"})') != 1.0:
        raise Failed("the verdict is not told")

    dashboard = json.loads((source / "daemon/package/grafana-dashboard.json").read_text())
    asked = 0
    for title, expression in expressions(dashboard):
        asked += 1
        if prometheus.value(expression) is None:
            raise Failed(f"dashboard: {title}: nothing answers {expression}")
    print(f"fired: {', '.join(sorted(fired))}; {asked} questions of the dashboard answered")


def main():
    build, source = map(pathlib.Path, sys.argv[1:])
    running = []
    with tempfile.TemporaryDirectory(prefix="mpm-prometheus-") as work:
        try:
            check(build, source, pathlib.Path(work), running)
        except (Failed, subprocess.CalledProcessError) as error:
            print(error, file=sys.stderr)
            for log in pathlib.Path(work).glob("*.log"):
                print(f"{log.name}:\n" + "\n".join(log.read_text().splitlines()[-15:]), file=sys.stderr)
            return 1
        finally:
            for process in running:
                process.send_signal(signal.SIGTERM)
            for process in running:
                try:
                    process.wait(20)
                except subprocess.TimeoutExpired:
                    process.kill()
    return 0


sys.exit(main())
