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
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
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


def kernel_of(x, width):
    return np.exp(-0.5 / width**2 * ((x[:, None, :] - x[None, :, :]) ** 2).sum(axis=2))


def accuracy(program, folder, dimension, sizes):
    """A map is held against the kernel of its own width: the median rule's of its landmarks."""
    x, y = points_of(dimension)
    ours = Ours(program, x, y, folder)
    (width, _, _), gram = ours("gram")
    gamma = 0.5 / width**2
    if np.abs(gram - kernel_of(x, width)).max() > 1e-12:
        sys.exit("the kernel matrix is not numpy's")
    rows = []
    for size in sizes:
        cells = []

        def add(us, features):
            cells.append((error_of(x, gram, features), us))

        def add_nystrom(landmarks, components):
            if components < 1 or components > landmarks - dimension - 1:
                cells.append(None)
                return
            (own, us, _), features = ours("nystrom", landmarks, components)
            cells.append((error_of(x, kernel_of(x, own), features), us))

        add_nystrom(size, size - dimension - 1)
        add(*reversed(peer(Nystroem(gamma=gamma, n_components=size, random_state=SEED), x)))
        add_nystrom(LANDMARKS, size)
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
    gram = kernel_of(x, width)
    centred = gram - gram.mean(axis=0) - gram.mean(axis=1)[:, None] + gram.mean()

    def fit():
        return KernelRidge(alpha=ridge, kernel="precomputed").fit(centred, y)

    other = fit().predict(centred)
    difference = np.abs(fitted[:, 0] - other).max() / np.abs(other).max()
    if difference > 1e-6:
        sys.exit(f"the exact kernel fit differs from scikit-learn's by {difference:g}")
    return dimension, us / 1e3, median_us(fit) / 1e3, difference


UNITS = {"3x3": (3, 3, 0.3), "10x20": (10, 20, 1.0)}  # MVs, CVs, seconds a measurement
METHODS = {  # of bench_methods
    "correlation": "correlation", "lagged_partial": "(3.15)",
    "spearman": "Spearman", "rank_partial": "rank partial",
    "linear": "linear F test", "polynomial": "linear and polynomial",
    "kernel": "linear and kernel", "random_features": "linear and random features"}


def costs(build, units):
    """Of each unit and method what bench_methods measures, as a list of dictionaries."""
    rows = []
    for unit in units:
        mvs, cvs, seconds = UNITS[unit]
        text = subprocess.run([build / "bin/bench_methods", str(mvs), str(cvs), str(seconds),
                               str(ROUNDS)], check=True, stdout=subprocess.PIPE, text=True,
                              timeout=3600).stdout
        for line in text.splitlines():
            name, sample, read, kilobytes = line.split()
            rows.append({"unit": unit, "method": METHODS[name], "us": float(sample),
                         "read_us": float(read), "kB": float(kilobytes)})
    return rows


def number(value):
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def cost_table(rows):
    """A row a method, and of each unit three columns."""
    units = list(dict.fromkeys(row["unit"] for row in rows))
    lines = ["| method | " + " | ".join(f"{unit}: us a sample | us to read off | MB"
                                        for unit in units) + " |",
             "|---|" + "---|---|---|" * len(units)]
    for method in METHODS.values():
        cells = []
        for row in (row for row in rows if row["method"] == method):
            cells += [number(row["us"]), number(row["read_us"]) if row["read_us"] else "-",
                      number(row["kB"] / 1024)]
        lines.append(f"| {method} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def kernel_tables(build, dimensions=DIMENSIONS, sizes=SIZES):
    """Two tables of Markdown, a line between them."""
    program = build / "bin/bench_kernel"
    lines = ["| inputs | columns | Nystrom | scikit-learn | components of 48 landmarks | "
             "scikit-learn's of all points | random features | scikit-learn |",
             "|---|---|---|---|---|---|---|---|"]
    fits = []
    with tempfile.TemporaryDirectory() as folder:
        for dimension in dimensions:
            for _, size, cells in accuracy(program, folder, dimension, sizes):
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
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path, help="folder of a Release build with MPM_BENCH=ON")
    parser.add_argument("--markdown", type=Path, help="write the tables into this file")
    parser.add_argument("--units", nargs="+", choices=UNITS, default=list(UNITS),
                        help="of the costs")
    options = parser.parse_args()
    cost, kernels = cost_table(costs(options.build, options.units)), kernel_tables(options.build)
    if options.markdown:
        text = options.markdown.read_text(encoding="utf-8")
        text = replace_part(text, "costs", [cost])
        options.markdown.write_text(replace_part(text, "kernels", [kernels]), encoding="utf-8")
    print(cost, kernels, sep="\n\n")


if __name__ == "__main__":
    main()
