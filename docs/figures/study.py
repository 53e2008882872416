#!/usr/bin/env python3
"""The tables of docs/validation.md, "The thesis": python3 docs/figures/study.py [SEEDS]

Standard library only; prints Markdown. 40 seeds take some ten minutes of one core.
"""
import sys
import tempfile

import runs

CHANNELS = [(cv, mv) for cv in range(3) for mv in range(3)]


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else float("nan")


def short(value, digits=2):
    """.34"""
    return f"{value:.{digits}f}".lstrip("0")


def matrix(of_channel, true_channels, digits=2):
    """Rows CV, columns MV, the channels to be found in bold."""
    return " / ".join(
        " ".join(("**{}**" if (cv, mv) in true_channels else "{}").format(
            short(of_channel((cv, mv)), digits)) for mv in range(3)) for cv in range(3))


def on_top(correlations, true_channels):
    order = sorted(CHANNELS, key=lambda c: -correlations.largest[c])
    return set(order[:len(true_channels)]) == set(true_channels)


def percent(share):
    return f"{100 * share:.0f} %"


def rates(all_correlations, true_channels):
    """True channels are the top ones; true above the line; false above the line."""
    top = percent(mean(on_top(c, true_channels) for c in all_correlations))
    above = {found: percent(mean(c.largest[channel] > c.line for c in all_correlations
                                 for channel in CHANNELS
                                 if (channel in true_channels) == found))
             for found in (True, False)
             if any((channel in true_channels) == found for channel in CHANNELS)}
    return (top, above[True], above[False]) if true_channels else (above[False],)


def test_rates(all_correlations, true_channels):
    """Of the mismatch detector on the same runs: true channels and others with p below the
    rate of one channel of nine."""
    def count(found):
        below = [c.p_value[channel] < 0.01 / 9 for c in all_correlations
                 for channel in CHANNELS if (channel in true_channels) == found]
        return f"{sum(below)} of {len(below)}" if below else "-"
    return f"{count(True)} / {count(False)}"


def study_methods(seeds, folder):
    variances, largest, rate_rows = [], [], []
    for name, _, plant, scenario, true_channels in runs.STUDIES:
        found = {method: [] for method, _ in runs.METHODS}
        variance = []
        for seed in seeds:
            path = runs.simulate(plant, scenario, seed, folder)
            columns = runs.read(path)
            variance.append([runs.control_error_variance(columns, cv) for cv in range(3)])
            for method, _ in runs.METHODS:
                found[method].append(runs.Correlations(plant, path, method))
        variances.append(f"| {name} | " + " ".join(
            short(mean(v[cv] for v in variance), 4) for cv in range(3)) + " |")
        for method, equation in runs.METHODS:
            all_correlations = found[method]
            largest.append(
                f"| {name} | {method.replace('_', ' ')} ({equation}) | " +
                matrix(lambda c: mean(x.largest[c] for x in all_correlations), true_channels) +
                f" | {short(mean(x.line for x in all_correlations), 3)} |")
        rate_rows.append(f"| {name} | " + " | ".join(
            " / ".join(rates(found[method], true_channels)) for method, _ in runs.METHODS) +
            f" | {test_rates(found['lagged_partial'], true_channels)} |")
        if not true_channels:
            rate_rows.append(f"| {name}, all lags | " + " | ".join(
                percent(mean(max(map(abs, c.values[channel])) > c.line
                                          for c in found[method] for channel in CHANNELS))
                for method, _ in runs.METHODS) + " | |")
        print(name, "done", file=sys.stderr, flush=True)
    return variances, largest, rate_rows


def study_sweep(seeds, folder):
    rows = []
    for name, (_, _, plant, _, true_channels) in (("S3", runs.STUDIES[-2]),
                                                  ("S4", runs.STUDIES[-1])):
        for g in runs.LAGS_SWEPT:
            found = [runs.Correlations(plant, runs.simulate(plant, f"{name.lower()}_g{g}", seed,
                                                            folder), "lagged_partial", g)
                     for seed in seeds]
            rows.append(f"| {name} | {g} | " +
                        matrix(lambda c: mean(x.largest[c] for x in found), true_channels) +
                        f" | {short(mean(x.line for x in found), 3)} | " +
                        " / ".join(rates(found, true_channels)) + " |")
        print(name, "sweep done", file=sys.stderr, flush=True)
    return rows


def main():
    seeds = range(1, 1 + (int(sys.argv[1]) if len(sys.argv) > 1 else 40))
    with tempfile.TemporaryDirectory() as folder:
        variances, largest, rate_rows = study_methods(seeds, folder)
        sweep = study_sweep(seeds, folder)
    print("| scenario | CV1 CV2 CV3 |\n|---|---|", *variances, "", sep="\n")
    print("| scenario | correlation | CV1 / CV2 / CV3, each MV1 MV2 MV3 | line |\n|---|---|---|---|",
          *largest, "", sep="\n")
    print("| scenario | " + " | ".join(m.replace("_", " ") for m, _ in runs.METHODS) +
          " | mismatch detector |\n|---|---|---|---|---|---|", *rate_rows, "", sep="\n")
    print("| scenario | g | CV1 / CV2 / CV3, each MV1 MV2 MV3 | line | rates |\n|---|---|---|---|---|",
          *sweep, sep="\n")


if __name__ == "__main__":
    main()
