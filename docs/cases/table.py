#!/usr/bin/env python3
"""Runs `mpm diagnose` on every case of docs/cases.md and prints the outcome as a markdown table.

    table.py [--mpm build/release/bin/mpm] DATA_FOLDER OUTPUT_FOLDER

The cut recordings go to OUTPUT_FOLDER/data, each run's report to a folder of its own beside it.
Exit code 1 if a run failed.
"""

import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Unit file, recording, unseen recording (None = the last third of the first one).
RUNS = [
    ("tclab", "tclab", None),
    ("tclab", "tclab", "tclab_mpc_ann"),
    ("tclab", "tclab", "tclab_mpc_physics"),
    ("tclab", "tclab", "tclab_mpc_arx"),
    ("heating_lamp", "heating_lamp", None),
    ("silverbox", "silverbox", "silverbox_multisine"),
    ("silverbox", "silverbox", "silverbox_arrow"),
    ("cascaded_tanks", "cascaded_tanks", "cascaded_tanks_val"),
    ("varennes", "varennes", None),
    ("refinery_sticking", "refinery_sticking", None),
    ("refinery_sound", "refinery_sound", None),
    ("refinery_sound", "refinery_sound", "refinery_sound_2"),
    ("hairdryer", "hairdryer", None),
]


def number(value):
    return f"{value:.3g}" if isinstance(value, (int, float)) else str(value)


def finding_text(finding):
    """`cause` of what: its numbers with their intervals."""
    subject = " -> ".join(finding[key] for key in ("tag", "mv", "cv") if finding.get(key))
    intervals = finding.get("interval") or {}
    numbers = []
    for name, value in (finding.get("parameters") or {}).items():
        text = f"{name} {number(value)}"
        if name in intervals:
            low, high = intervals[name]
            text += f" ({number(low)} to {number(high)})"
        numbers.append(text)
    return f"`{finding['cause']}` {subject}" + (": " + ", ".join(numbers) if numbers else "")


def rows_of(report, name):
    findings = "<br>".join(finding_text(finding) for finding in report["findings"])
    if not findings:
        findings = "nothing" + (f" ({report['reason']})" if report.get("reason") else "")
    rows = []
    for score in report["validation"]:
        rows.append([name, score["cv"], number(score["rmse_before"]), number(score["rmse_after"]),
                     f"{score['fit_before']:.1f}", f"{score['fit_after']:.1f}",
                     report["verdict"], findings])
        name = findings = ""
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--mpm", default=str(ROOT / "build/release/bin/mpm"), help="the program")
    parser.add_argument("data", help="folder with the public recordings")
    parser.add_argument("out", type=pathlib.Path, help="folder for what is written")
    options = parser.parse_args()

    cut = options.out / "data"
    subprocess.run([sys.executable, str(ROOT / "docs/cases/prepare.py"), options.data, str(cut)],
                   check=True)
    print("| recording | CV | error before | after | fit % before | after | verdict | findings |")
    print("|---|---|---|---|---|---|---|---|")
    failed = False
    for unit, recording, unseen in RUNS:
        name = recording + (f", unseen {unseen}" if unseen else "")
        if not (cut / f"{recording}.csv").exists():
            print(f"| {name} | | | | | | SKIPPED: no data | |")
            continue
        folder = options.out / "_on_".join(filter(None, (recording, unseen)))
        command = [options.mpm, "diagnose", "--config", str(ROOT / f"config/cases/{unit}.yaml"),
                   "--data", str(cut / f"{recording}.csv"), "--out", str(folder)]
        if unseen:
            command += ["--validate", str(cut / f"{unseen}.csv")]
        done = subprocess.run(command, stdout=subprocess.DEVNULL)
        if done.returncode != 0:
            failed = True
            print(f"| {name} | | | | | | failed with {done.returncode} | |")
            continue
        report = json.loads((folder / "report.json").read_text())
        for row in rows_of(report, name):
            print("| " + " | ".join(row) + " |", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
