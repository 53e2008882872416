#!/usr/bin/python3
"""What `mpm diagnose` says first of nonlinear plants, beside what another program says of the same
ones where one is given: confusion.py BUILD [--before MPM] [--seeds FIRST-LAST] [--markdown FILE].
mpm_hidden writes the cases with its hard setting, mpmsim those of a gain that goes with where the
channel stands.
Standard library only. Seeds below 1000 are for scores, from 100001 on for tuning."""
import argparse
import concurrent.futures
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/foreign"))
from tables import replace_part  # noqa: E402

SHELL = ROOT / "config/plants/shell3x3.yaml"
# Three kinds share the first class.
CLASSES = {"input_nonlinearity": 3, "output_nonlinearity": 1, "stiction": 1, "product": 1, "none": 1}
SCENARIO = "operating_point_gain"
SCENARIO_TRUTH = {"class": SCENARIO, "effects": [
    {"cause": "state_nonlinearity", "kind": "", "cv": "y2", "mv": "u2"}]}


def write_cases(build, first, last, folder):
    """Of the class with three kinds three times as many seeds, from the same first one on."""
    for name, times in CLASSES.items():
        end = first + times * (last - first + 1) - 1
        subprocess.run([build / "tests/mpm_hidden", "--class", name, "--seeds", f"{first}-{end}",
                        "--setting", "hard", "--write", folder], check=True)
    for seed in range(first, last + 1):
        case = folder / f"{SCENARIO}_shell3x3_{seed}"
        done = subprocess.run([build / "bin/mpmsim", "--config", SHELL, "--scenario", SCENARIO,
                               "--seed", str(seed), "--samples", "3000", "--csv",
                               case.with_suffix(".csv")], stdout=subprocess.DEVNULL)
        if done.returncode != 0:  # some of these loops diverge
            case.with_suffix(".csv").unlink(missing_ok=True)
            continue
        case.with_suffix(".yaml").write_text(SHELL.read_text(encoding="utf-8"), encoding="utf-8")
        case.with_suffix(".json").write_text(json.dumps(SCENARIO_TRUTH), encoding="utf-8")


def cases_of(folder):
    """Names and truths, in the order of the table."""
    order = [*CLASSES, SCENARIO]
    cases = [(file.stem, json.loads(file.read_text(encoding="utf-8")))
             for file in sorted(folder.glob("*.json"))]
    return sorted(cases, key=lambda case: (order.index(case[1]["class"]),
                                           [effect["kind"] for effect in case[1]["effects"]]))


def label(cause, kind):
    return f"{cause}: {kind}" if kind else cause


def first_said(mpm, case):
    """The first finding of report.json; what there is instead where there is none."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([mpm, "diagnose", "--config", case.with_suffix(".yaml"), "--data",
                               case.with_suffix(".csv"), "--out", f"{out}/report", "--quiet",
                               "--threads", "1"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True)
        report = pathlib.Path(out) / "report/report.json"
        if not report.exists():
            print(f"{case.name}: {mpm} failed: {done.stderr.strip()}", file=sys.stderr)
            return {"said": "failed"}
        report = json.loads(report.read_text(encoding="utf-8"))
    if not report["findings"]:
        return {"said": {"match": "none"}.get(report["verdict"], report["verdict"] + ", no cause")}
    finding = report["findings"][0]
    kind = finding["parameters"].get("kind", finding["parameters"].get("shape", ""))
    return {"said": label(finding["cause"], kind), "cause": finding["cause"], "kind": kind,
            "cv": finding["cv"], "mv": finding["mv"]}


def right(truth, said):
    """Cause and, where the truth has one, kind; its MV, and its CV where both name one."""
    if not truth["effects"]:
        return said["said"] == "none"
    effect = truth["effects"][0]
    return (said.get("cause") == effect["cause"] and effect["kind"] in ("", said["kind"]) and
            (effect["mv"] is None or said["mv"] == effect["mv"]) and
            (None in (effect["cv"], said["cv"]) or said["cv"] == effect["cv"]))


def table(cases, answers):
    """A row per true cause; cells in cases, of several programs with a slash between."""
    rows = {}
    for case, truth in cases:
        effect = truth["effects"][0] if truth["effects"] else {"cause": "none", "kind": ""}
        rows.setdefault(label(effect["cause"], effect["kind"]), []).append((case, truth))
    said = {answer["said"] for of_case in answers.values() for answer in of_case}
    order = [name for name in rows if name in said]
    order += sorted(said - set(order))
    lines = ["| truly | cases | right, and its signals | " + " | ".join(order) + " |",
             "|---|---|---|" + "---|" * len(order)]
    programs = range(len(next(iter(answers.values()))))
    for name, members in rows.items():
        def counts(is_so):
            return [sum(is_so(truth, answers[case][i]) for case, truth in members)
                    for i in programs]

        def cell(column):
            numbers = counts(lambda _, answer: answer["said"] == column)
            return " / ".join(map(str, numbers)) if any(numbers) else ""
        lines.append(f"| {name} | {len(members)} | {' / '.join(map(str, counts(right)))} | " +
                     " | ".join(map(cell, order)) + " |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="folder of a Release build")
    parser.add_argument("--before", type=pathlib.Path, help="another program mpm, told first")
    parser.add_argument("--seeds", default="801-810")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--markdown", type=pathlib.Path, help="write the table into this file")
    options = parser.parse_args()
    first, last = (int(seed) for seed in options.seeds.split("-"))
    programs = [*filter(None, [options.before]), options.build / "bin/mpm"]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_cases(options.build, first, last, folder)
        cases = cases_of(folder)
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            said = list(pool.map(lambda job: first_said(*job),
                                 [(mpm, folder / case) for case, _ in cases for mpm in programs]))
    count = len(programs)
    answers = {case: said[count * i:count * (i + 1)] for i, (case, _) in enumerate(cases)}
    for case, truth in cases:
        print(f"{case}: {'right' if right(truth, answers[case][-1]) else 'WRONG'}: " +
              ", now ".join(answer["said"] for answer in answers[case]))
    lines = table(cases, answers)
    print("\n".join(lines))
    if options.markdown:
        text = options.markdown.read_text(encoding="utf-8")
        options.markdown.write_text(replace_part(text, "confusion", lines), encoding="utf-8")


if __name__ == "__main__":
    main()
