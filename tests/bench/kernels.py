#!/usr/bin/python3
"""What the functions of the nonlinear test cost, and how near a kernel's approximations come to it,
beside scikit-learn's on the same points in the same run: kernels.py BUILD_DIR [--markdown FILE]."""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy
import numpy as np  # noqa: E402
from sklearn.decomposition import KernelPCA  # noqa: E402
from sklearn.kernel_approximation import Nystroem, RBFSampler  # noqa: E402
from sklearn.kernel_ridge import KernelRidge  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "foreign"))
from tables import replace_part  # noqa: E402

POINTS = 600
DIMENSIONS = (1, 2, 4)
SIZES = (4, 8, 16, 32, 64, 128)
LANDMARKS = 48  # of the shipped kernel test
ROUNDS = 3
SEED = 20261127


def points_of(dimension):
    """Autoregressive, standardised; and a bent response with noise."""
    random = np.random.default_rng(SEED + dimension)
    x = random.standard_normal((POINTS, dimension))
    for k in range(1, POINTS):
        x[k] += 0.8 * x[k - 1]
    x = (x - x.mean(axis=0)) / x.std(axis=0)
    y = np.tanh(2 * x[:, 0]) + 0.3 * x.sum(axis=1) ** 2 + 0.2 * random.standard_normal(POINTS)
    return x, y - y.mean()


class Ours:
    """bench_kernel on one set of points."""

    def __init__(self, program, x, y, folder):
        self.program = program
        self.file = Path(folder) / f"points{x.shape[1]}"
        with open(self.file, "w", encoding="ascii") as out:
            print(x.shape[1], len(x), file=out)
            np.savetxt(out, x, fmt="%.17g")
            np.savetxt(out, y, fmt="%.17g")

    def __call__(self, *what):
        """Its leading numbers, and the table behind them."""
        text = subprocess.run([self.program, self.file, *map(str, what)], check=True,
                              stdout=subprocess.PIPE, text=True, timeout=300).stdout
        head, rows = text.split("\n", 1)
        values = np.array(rows.split(), dtype=float)
        return [float(v) for v in head.split()], values.reshape(POINTS, -1)


def median_us(work):
    times = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return statistics.median(times) * 1e6


def nonlinear_part(x, rows):
    """What a constant and the points themselves leave of each column."""
    linear = np.column_stack([np.ones(len(x)), x])
    return rows - linear @ np.linalg.lstsq(linear, rows, rcond=None)[0]


def error_of(x, gram, features):
    """Of the kernel matrix of what is not linear: share that the features' products miss."""
    left = nonlinear_part(x, nonlinear_part(x, gram).T)
    mine = nonlinear_part(x, features)
    return np.linalg.norm(left - mine @ mine.T) / np.linalg.norm(left)


def peer(maker, x):
    """Features by scikit-learn, and microseconds per point of making them once fitted."""
    made = maker.fit(x)
    return made.transform(x), median_us(lambda: made.transform(x)) / len(x)


def accuracy(program, folder, dimension):
    x, y = points_of(dimension)
    ours = Ours(program, x, y, folder)
    (width, _, _), gram = ours("gram")
    gamma = 0.5 / width**2
    exact = np.exp(-gamma * ((x[:, None, :] - x[None, :, :]) ** 2).sum(axis=2))
    if np.abs(gram - exact).max() > 1e-12:
        sys.exit("the kernel matrix is not numpy's")
    rows = []
    for size in SIZES:
        cells = []

        def add(us, features):
            cells.append((error_of(x, gram, features), us))

        if size > dimension + 1:
            (us, _), features = ours("nystrom", size, size - dimension - 1)
            add(us, features)
        else:
            cells.append(None)
        add(*reversed(peer(Nystroem(gamma=gamma, n_components=size, random_state=SEED), x)))
        if size <= LANDMARKS - dimension - 1:
            (us, _), features = ours("nystrom", LANDMARKS, size)
            add(us, features)
        else:
            cells.append(None)
        pca = KernelPCA(n_components=size, kernel="rbf", gamma=gamma)
        add(*reversed(peer(pca, x)))
        (us, _), features = ours("random", size // 2)
        add(us, features)
        add(*reversed(peer(RBFSampler(gamma=gamma, n_components=size, random_state=SEED), x)))
        rows.append((dimension, size, cells))
    return rows


def exact_fit(program, folder, dimension):
    """Ours with its choice of 31 ridges, against one fit with the ridge that it chose."""
    x, y = points_of(dimension)
    ours = Ours(program, x, y, folder)
    (ridge, us, _), fitted = ours("exact")
    (width, _, _), _ = ours("gram")
    gamma = 0.5 / width**2
    gram = np.exp(-gamma * ((x[:, None, :] - x[None, :, :]) ** 2).sum(axis=2))
    centred = gram - gram.mean(axis=0) - gram.mean(axis=1)[:, None] + gram.mean()

    def fit():
        return KernelRidge(alpha=ridge, kernel="precomputed").fit(centred, y)

    other = fit().predict(centred)
    difference = np.abs(fitted[:, 0] - other).max() / np.abs(other).max()
    if difference > 1e-6:
        sys.exit(f"the exact kernel fit differs from scikit-learn's by {difference:g}")
    return dimension, us / 1e3, median_us(fit) / 1e3, difference


UNITS = {"3x3": 0.3, "10x20": 1.0}  # seconds a measurement
VARIANTS = (("linear test alone", "off"), ("polynomial", "polynomial"), ("kernel", "kernel"),
            ("random features", "random"))


def costs(build, sizes):
    """Per unit size: microseconds a sample that each variant adds, and the kilobytes of all."""
    process = subprocess.Popen([build / "bin/bench_core"], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    process.stdout.readline()

    def ask(line):
        process.stdin.write(line + "\n")
        process.stdin.flush()
        answer = process.stdout.readline()
        if not answer:
            sys.exit(f"bench_core ended at {line}")
        return float(answer)

    rows = []
    for size, seconds in sizes.items():
        taken = {name: [] for _, name in VARIANTS}
        for _ in range(ROUNDS if size == "3x3" else 1):
            for _, name in VARIANTS:
                taken[name].append(ask(f"monitor_{name}_{size} {seconds}"))
        base = statistics.median(taken["off"])
        base_kb = ask(f"memory_monitor_off_{size} 0")
        for title, name in VARIANTS:
            us = statistics.median(taken[name]) if name == "off" else statistics.median(
                a - b for a, b in zip(taken[name], taken["off"]))
            kilobytes = ask(f"memory_monitor_{name}_{size} 0") - (0 if name == "off" else base_kb)
            rows.append((size, title, us, base, kilobytes))
        ranks = statistics.median(ask(f"ranks_{size} 0.1") for _ in range(ROUNDS))
        rows.append((size, "ranks (Spearman, rank partial), window of 1000", ranks, base,
                     ask(f"memory_ranks_{size} 0")))
    process.stdin.close()
    process.wait(timeout=10)
    return rows


def number(value):
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def tables(build, sizes):
    """Two tables of Markdown."""
    lines = ["| unit | test | adds, us a sample | adds, kB |", "|---|---|---|---|"]
    for size, title, us, _, kilobytes in costs(build, sizes):
        note = " (all)" if title == "linear test alone" else ""
        lines.append(f"| {size} | {title} | {number(us)}{note} | {number(kilobytes)}{note} |")
    cost = "\n".join(lines)

    program = build / "bin/bench_kernel"
    lines = ["| inputs | columns | Nystrom | scikit-learn | components of 48 landmarks | "
             "scikit-learn's of all points | random features | scikit-learn |",
             "|---|---|---|---|---|---|---|---|"]
    fits = []
    with tempfile.TemporaryDirectory() as folder:
        for dimension in DIMENSIONS:
            for _, size, cells in accuracy(program, folder, dimension):
                text = " | ".join("-" if cell is None else f"{number(100 * cell[0])} %; "
                                  f"{number(cell[1])}" for cell in cells)
                lines.append(f"| {dimension} | {size} | {text} |")
            fits.append(exact_fit(program, folder, dimension))
    lines += ["", f"Exact kernel regression of {POINTS} points, ours with its choice among 31 ridges, "
              "scikit-learn's with the one chosen:", "",
              "| inputs | ours, ms | scikit-learn, ms | largest difference, relative |",
              "|---|---|---|---|"]
    lines += [f"| {dimension} | {number(ours)} | {number(other)} | {difference:.1g} |"
              for dimension, ours, other, difference in fits]
    return cost, "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path, help="folder of a Release build with MPM_BENCH=ON")
    parser.add_argument("--markdown", type=Path, help="write the table of kernels into this file")
    parser.add_argument("--units", nargs="+", choices=UNITS, default=list(UNITS),
                        help="3x3 takes a minute, 10x20 ten")
    options = parser.parse_args()
    cost, kernels = tables(options.build, {unit: UNITS[unit] for unit in options.units})
    if options.markdown:
        text = options.markdown.read_text(encoding="utf-8")
        options.markdown.write_text(replace_part(text, "kernels", [kernels]), encoding="utf-8")
    print(cost, kernels, sep="\n\n")


if __name__ == "__main__":
    main()
