#!/usr/bin/env python3
"""Runs `mpm diagnose` on the cases of expected.json and scores what it says by that table.

    table.py [--mpm PROGRAM] [--half tuning|scoring] [--case NAME...] DATA_FOLDER OUTPUT_FOLDER
    table.py [--mpm PROGRAM] --hold docs/cases.md DATA_FOLDER OUTPUT_FOLDER

Prints the counts and a line per case as markdown. The cut recordings go to OUTPUT_FOLDER/data, each
run's report to a folder of its own beside it. Exit code 1 if a run failed. With --hold the cases of
both halves that are quick by that file's tables are run, and exit code 1 says that an outcome is
another one than is written there; 77 that there are no recordings.

An answer is a cause (something is named), nothing (nothing is, verdict match) or cannot tell
(nothing is, another verdict, or the data refused as too short). Noise alone, where it is allowed,
names nothing. It counts as

    right        one that is right there; a cause with all that is wrong named and nothing else but
                 what is allowed, its numbers in range, and the error after within bounds
    partly       a cause with something of that missing
    cannot tell  where more could be said, or nothing is wrong
    wrong        something named that never is to be, nothing named that is true, or "nothing" where
                 something is wrong
    harmful      the repair makes the free run on unseen samples worse by a tenth or more in some
                 CV, or what is repaired has a wild number: a ratio to the model not in 0..20
    failed       no report within the time limit
"""

import argparse
import collections
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUTCOMES = ("right", "partly", "cannot tell", "wrong", "harmful", "failed")
TIME_LIMIT_S = 120
WORSE = 1.1
WILD_RATIO = 20.0
QUICK_S = 3.0
NO_RECORDINGS = 77


def matches(finding, wanted):
    """One of the causes, about these signals, its numbers within the ranges given."""
    if finding["cause"] not in wanted["causes"] and wanted["causes"] != ["any"]:
        return False
    for key in ("mv", "cv", "tag"):
        tags = wanted.get(key)
        if tags and finding.get(key) not in (tags if isinstance(tags, list) else [tags]):
            return False
    numbers = finding.get("parameters") or {}
    return all(low <= numbers[name] <= high
               for name, (low, high) in wanted.get("values", {}).items() if name in numbers)


def assign(findings, named):
    """How many of `named` have a finding of their own, and which findings are left over. Those that
    ask for a signal choose first."""
    left = list(findings)
    hits = 0
    for wanted in sorted(named, key=lambda one: -sum(key in one for key in ("mv", "cv", "tag"))):
        found = next((finding for finding in left if matches(finding, wanted)), None)
        if found is not None:
            left.remove(found)
            hits += 1
    return hits, left


def harm(case, report):
    """What the repair makes worse, in words; empty if nothing."""
    for score in report["validation"]:
        if score["rmse_after"] > WORSE * score["rmse_before"]:
            return f"{score['cv']} worse"
    for finding in report["findings"]:
        if finding.get("in_model", True) is False:
            continue
        for name, value in (finding.get("parameters") or {}).items():
            lowest = -WILD_RATIO if case.get("sign_may_change") else 0.0
            if name.startswith(("gain_ratio", "time_constant_ratio")):
                if not lowest < value < WILD_RATIO:
                    return f"{name} {number(value)}"
    return ""


def judge(case, report):
    """Outcome and why."""
    allowed_noise = [one for one in case["allowed"] if "noise" in one["causes"]]
    findings = [finding for finding in report["findings"] if finding["cause"] != "noise"
                or not any(matches(finding, one) for one in allowed_noise)
                or any(matches(finding, one) for one in case["named"])]
    reason = harm(case, report)
    if reason:
        return "harmful", reason
    for finding in findings:
        if any(matches(finding, never) for never in case["never"]):
            return "wrong", f"never {finding['cause']}"
    hits, left = assign(findings, case["named"])
    false = [finding for finding in left
             if not any(matches(finding, one) for one in case["allowed"] + case["named"])]
    if not findings:
        answer = "nothing" if report["verdict"] == "match" else "cannot tell"
        if answer in case["right"]:
            return "right", ""
        return (answer, "") if answer == "cannot tell" else ("wrong", "says match")
    if "cause" not in case["right"]:
        return ("wrong", "nothing to name") if false else ("right", "")
    if false and hits == 0:
        return "wrong", "nothing true named"
    missing = []
    if hits < len(case["named"]):
        missing.append(f"{hits} of {len(case['named'])} named")
    if false:
        missing.append("besides " + ", ".join(dict.fromkeys(one["cause"] for one in false)))
    for score in report["validation"]:
        if score["rmse_after"] > case.get("after", {}).get(score["cv"], float("inf")):
            missing.append(f"{score['cv']} not repaired")
    return ("partly", "; ".join(missing)) if missing else ("right", "")


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
    out = "" if finding.get("in_model", True) else ", not in the model"
    return f"`{finding['cause']}` {subject}" + (": " + ", ".join(numbers) if numbers else "") + out


def processor_time():
    """Of the programs that were run, in s: what a run takes, however busy the machine is."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(case, options, cut):
    """Report (None = failed), seconds of processor time, and why it failed."""
    folder = options.out / case["name"]
    command = [options.mpm, "diagnose", "--config",
               str(ROOT / f"config/cases/{case['unit']}.yaml"),
               "--data", str(cut / f"{case['data']}.csv"), "--out", str(folder), "--threads", "1"]
    if "unseen" in case:
        command += ["--validate", str(cut / f"{case['unseen']}.csv")]
    before = processor_time()
    done = subprocess.run(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (options.limit, options.limit)))
    took = processor_time() - before
    if done.returncode == 3:
        return {"verdict": "refused", "reason": done.stderr.strip().split("error: ")[-1],
                "findings": [], "validation": []}, took, ""
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return None, took, f"stopped after {options.limit} s"
    if done.returncode != 0:
        return None, took, f"exit code {done.returncode}: {done.stderr.strip()}"
    return json.loads((folder / "report.json").read_text()), took, ""


def rows_of(case, report, took, outcome, why):
    findings = "<br>".join(finding_text(finding) for finding in report["findings"])
    if not findings:
        findings = "nothing" + (f" ({report['reason']})" if report.get("reason") else "")
    first = [case["name"], f"**{outcome}**" + (f": {why}" if why else ""), f"{took:.1f}"]
    last = [report["verdict"], findings, case["wrong"]]
    scores = [[score["cv"], number(score["rmse_before"]), number(score["rmse_after"])]
              for score in report["validation"]]
    for score in scores or [["", "", ""]]:
        yield first + score + last
        first, last = ["", "", ""], ["", "", ""]


def written(path):
    """Case: outcome, of those that took QUICK_S at most, as the tables of `path` say."""
    outcomes = {}
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) > 4 and cells[2].startswith("**") and float(cells[3]) <= QUICK_S:
            outcomes[cells[1]] = cells[2].split("**")[1]
    return outcomes


def hold(options, expected, cut):
    """How many outcomes are not as written."""
    said = written(options.hold)
    others = ran = 0
    for case in expected:
        if case["name"] not in said:
            continue
        if not (cut / f"{case['data']}.csv").exists():
            print(f"{case['name']}: SKIPPED, no data")
            continue
        ran += 1
        report, _, failure = run(case, options, cut)
        outcome, why = judge(case, report) if report is not None else ("failed", failure)
        if outcome != said[case["name"]]:
            others += 1
            print(f"{case['name']}: {outcome} ({why}), written: {said[case['name']]}")
    print(f"{ran} cases, {others} with another outcome than {options.hold} says")
    return others


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--mpm", default=str(ROOT / "build/release/bin/mpm"), help="the program")
    parser.add_argument("--half", choices=("tuning", "scoring"), default="tuning")
    parser.add_argument("--case", nargs="*", help="only these")
    parser.add_argument("--limit", type=int, default=TIME_LIMIT_S,
                        help="seconds of processor time per run")
    parser.add_argument("--hold", type=pathlib.Path, help="the document whose outcomes are held")
    parser.add_argument("data", help="folder with the public recordings")
    parser.add_argument("out", type=pathlib.Path, help="folder for what is written")
    options = parser.parse_args()

    if options.hold:
        options.data = os.environ.get("MPM_DATA_DIR", options.data)
        if not pathlib.Path(options.data).is_dir():
            print(f"SKIPPED: no recordings in {options.data}; MPM_DATA_DIR names their folder")
            sys.exit(NO_RECORDINGS)
    cut = options.out / "data"
    subprocess.run([sys.executable, str(ROOT / "docs/cases/prepare.py"), options.data, str(cut)],
                   check=True)
    expected = json.loads((ROOT / "docs/cases/expected.json").read_text())["cases"]
    if options.hold:
        sys.exit(1 if hold(options, expected, cut) else 0)
    table, counts, plants = [], collections.Counter(), {}
    for case in expected:
        if case["half"] != options.half or (options.case and case["name"] not in options.case):
            continue
        if not (cut / f"{case['data']}.csv").exists():
            print(f"{case['name']}: SKIPPED, no data", file=sys.stderr)
            continue
        report, took, failure = run(case, options, cut)
        if report is None:
            outcome = "failed"
            table.append([case["name"], f"**failed**: {failure}", f"{took:.1f}", "", "", "", "", "",
                          case["wrong"]])
        else:
            outcome, why = judge(case, report)
            table += rows_of(case, report, took, outcome, why)
        counts[outcome] += 1
        plants.setdefault(case["plant"], collections.Counter())[outcome] += 1
        print(f"{case['name']}: {outcome}, {took:.1f} s", file=sys.stderr, flush=True)

    head = ["plant"] + list(OUTCOMES)
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for name, of in list(plants.items()) + [("all", counts)]:
        print("| " + " | ".join([name] + [str(of[outcome] or "") for outcome in OUTCOMES]) + " |")
    head = ["case", "outcome", "s", "CV", "error before", "after", "verdict", "findings",
            "truly wrong"]
    print("\n| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in table:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    sys.exit(1 if counts["failed"] else 0)


if __name__ == "__main__":
    main()
