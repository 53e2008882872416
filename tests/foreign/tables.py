"""Counts the cases of score.py, where the columns are explained, and prints them as Markdown."""
import math
import statistics

from effects import EFFECTS
from judge import ACCUSES
from regimes import REGIMES

SEEN = 100.0  # noncentrality
FARTHER, FAR = 0.05, 0.25
# What is claimed: shares of runs at most. A true share at its bound breaks it in one of 1000 scores.
BOUNDS = {"healthy accused": 0.02, "strong: wrong": 0.01, "repaired model farther": 0.01,
          "strong: neither named nor said to be unclear": 0.10, "failed": 0.0}
UNEXCITED_LIMITS = (1e-3, 1e-4, 1e-6)
CONFIDENCE = [(0.9, 0.99), (0.99, 0.999), (0.999, 1.01)]


def wilson(hits, runs):
    if runs == 0:
        return 0.0, 1.0
    z, share = 1.96, hits / runs
    middle = (share + z * z / (2 * runs)) / (1 + z * z / runs)
    half = z / (1 + z * z / runs) * math.sqrt(share * (1 - share) / runs + z * z / (4 * runs**2))
    return max(0.0, middle - half), min(1.0, middle + half)


def replace_part(text, name, lines):
    """What stands between the markers `study:begin NAME` and `study:end NAME`."""
    begin, end = f"<!-- study:begin {name} -->", f"<!-- study:end {name} -->"
    if begin not in text or end not in text:
        raise SystemExit(f"no markers for the table {name}")
    before, rest = text.split(begin)
    return before + begin + "\n\n" + "\n".join(lines) + "\n\n" + end + rest.split(end)[1]


def outcome(result):
    """Which columns a faulty run counts in."""
    is_ = [finding["is"] for finding in result["findings"]]
    mine = [f["is"] for f in result["findings"] if not of_regime(f, result)]
    columns = set()
    if "wrong" in is_:
        columns.add("wrong")
    if "right" in mine:
        columns.add("right")
        if mine[0] == "right":
            columns.add("first")
    elif "place" in mine:
        columns.add("place")
    elif result["verdict"] == "undetermined":
        columns.add("undetermined")
    elif "wrong" not in is_:
        columns.add("silent")
    return columns


def of_regime(finding, result):
    """Right, but not what the effect is."""
    truth = result["truth"]
    return finding["is"] == "right" and finding["cause"] not in ACCUSES and not (
        finding["cause"] == truth["cause"] and finding["cv"] == truth["cv"])


def share(hits, runs):
    low, high = wilson(hits, runs)
    return f"{hits}/{runs} ({100 * low:.0f}-{100 * high:.0f})"


def summary(results):
    """One row of the table."""
    ran = [r for r in results if r.get("made")]
    good = [r for r in ran if "failed" not in r]
    healthy = [r for r in good if r["effect"] == "none"]
    strong = [r for r in good if r["effect"] != "none" and r["noncentrality"] > SEEN]
    columns = [outcome(r) for r in strong]
    seconds = [r["seconds"] for r in ran] or [0.0]
    row = {"healthy": len(healthy), "strong": len(strong), "runs": len(good),
           "accused": sum(any(f["is"] == "wrong" for f in r["findings"]) for r in healthy),
           "farther": sum(r["after"] > r["before"] + FARTHER for r in good),
           "far": sum(r["after"] > r["before"] + FAR for r in good),
           "nearer": sum(r["after"] < r["before"] - FARTHER for r in good),
           "failed": len(ran) - len(good), "not_made": len(results) - len(ran),
           "cpu_median": statistics.median(seconds), "cpu_max": max(seconds)}
    for name in ("right", "first", "place", "undetermined", "silent", "wrong"):
        row[name] = sum(name in c for c in columns)
    row["wrong_any"] = sum(any(f["is"] == "wrong" for f in r["findings"]) for r in good)
    return row


def reliability(results):
    rows = []
    for low, high in CONFIDENCE:
        row = {"confidence": f"{low} .. {min(high, 1.0)}"}
        for name, causes in (("accusing", ACCUSES), ("all", None)):
            of = [f["is"] for r in results for f in r.get("findings", [])
                  if low <= f["confidence"] < high and f["is"] != "slight" and
                  (causes is None or f["cause"] in causes)]
            row[name] = {"right": of.count("right"), "place": of.count("place"), "of": len(of)}
        rows.append(row)
    return rows


def most(runs, share_of_runs):
    """The most that a binomial with that share gives in all but one of 1000 times."""
    if share_of_runs == 0.0:
        return 0
    log_in, log_out = math.log(share_of_runs), math.log1p(-share_of_runs)  # no power overflows
    left, count = 1.0, 0
    while True:
        ways = math.lgamma(runs + 1) - math.lgamma(count + 1) - math.lgamma(runs - count + 1)
        left -= math.exp(ways + count * log_in + (runs - count) * log_out)
        if left < 1e-3 or count == runs:
            return count
        count += 1


def beyond(results):
    """Lines that say which bounds do not hold."""
    s = summary(results)
    missed = s["strong"] - s["right"] - s["undetermined"]
    counts = {"healthy accused": (s["accused"], s["healthy"]),
              "strong: wrong": (s["wrong"], s["strong"]),
              "repaired model farther": (s["farther"], s["runs"]),
              "strong: neither named nor said to be unclear": (missed, s["strong"]),
              "failed": (s["failed"], len(results))}
    return [f"{name}: {count} of {runs}, more than {most(runs, BOUNDS[name])}"
            for name, (count, runs) in counts.items() if count > most(runs, BOUNDS[name])]


def detect_row(results):
    seen = [r for r in results if r.get("detect")]
    strong = [r for r in seen if r["effect"] not in ("none", "aux", "output_step", "output_drift")
              and r["noncentrality"] > SEEN]
    false = sum(bool(r["detect"]["false"]) for r in seen)
    found = sum(r["detect"]["found"] for r in strong)
    values = [p for r in seen for p in r["detect"].get("unexcited", [])]
    low = ", ".join(str(sum(p < limit for p in values)) for limit in UNEXCITED_LIMITS)
    return f"{share(false, len(seen))} | {share(found, len(strong))} | {len(values)} | {low}"


def tables(results, detect):
    groups = [(regime, [r for r in results if r["regime"] == regime]) for regime in REGIMES]
    groups = [(name, group) for name, group in groups if group] + [("all", results)]
    lines = ["| regime | healthy accused | strong: right | first | place | undetermined | silent |"
             " wrong | all runs: farther | far | nearer | CPU s median, max | failed |",
             "|---" * 13 + "|"]
    for name, group in groups:
        s = summary(group)
        lines.append(
            f"| {name} | {share(s['accused'], s['healthy'])} | {share(s['right'], s['strong'])} | "
            f"{s['first']} | {s['place']} | {s['undetermined']} | {s['silent']} | "
            f"{share(s['wrong'], s['strong'])} | {share(s['farther'], s['runs'])} | {s['far']} | "
            f"{s['nearer']} | {s['cpu_median']:.1f}, {s['cpu_max']:.1f} | {s['failed']} |")
    lines += ["", "| effect (all regimes) | strong: right | first | place | undetermined | silent |"
              " wrong |", "|---" * 7 + "|"]
    for effect in EFFECTS[1:]:
        s = summary([r for r in results if r["effect"] == effect])
        lines.append(f"| {effect} | {share(s['right'], s['strong'])} | {s['first']} | {s['place']} "
                     f"| {s['undetermined']} | {s['silent']} | {share(s['wrong'], s['strong'])} |")
    lines += ["", "| confidence | accusing: right | or of the place | all: right |",
              "|---" * 4 + "|"]
    for row in reliability(results):
        a, b = row["accusing"], row["all"]
        lines.append(f"| {row['confidence']} | {share(a['right'], a['of'])} | "
                     f"{share(a['right'] + a['place'], a['of'])} | {share(b['right'], b['of'])} |")
    if detect:
        limits = ", ".join(f"{limit:g}" for limit in UNEXCITED_LIMITS)
        lines += ["", "| detect | runs with a healthy channel called wrong | strong effects seen | "
                  f"healthy channels not excited | of these p < {limits} |", "|---" * 5 + "|"]
        lines += [f"| {name} | {detect_row(group)} |" for name, group in groups]
    return "\n".join(lines) + "\n"
