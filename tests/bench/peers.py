"""What a careful numpy user would write for the job of LaggedCorrelation: the partial correlations
of all inputs, CVs and lags, afresh after every sample."""

import time

import numpy as np

FIRST_LAG, LAST_LAG = -10, 20
LAGS = LAST_LAG - FIRST_LAG + 1


def random_rows(mvs, cvs, g, count, chosen, seed=1):
    """Regressor rows (count x MVs x p) and response rows (count x MVs x r) of the chosen MVs, laid
    out as in core/mismatch/lagged_correlation, from autoregressive noise."""
    random = np.random.default_rng(seed)
    length = count + g + LAGS
    u = random.standard_normal((length, mvs))
    e = random.standard_normal((length, cvs))
    for k in range(1, length):
        u[k] += 0.5 * u[k - 1]
        e[k] += 0.5 * e[k - 1]
    now = np.arange(count) + g + LAST_LAG
    t = now - LAST_LAG
    lagged = u[t[:, None] - np.arange(g + 1)]  # rows x (g + 1) x mvs
    residuals = e[now[:, None] - np.arange(LAGS)].transpose(0, 2, 1).reshape(count, cvs * LAGS)
    x, y = [], []
    for i in chosen:
        others = np.delete(lagged, i, axis=2).transpose(0, 2, 1).reshape(count, -1)
        x.append(np.hstack([np.ones((count, 1)), others]))
        y.append(np.hstack([u[t, i : i + 1], residuals]))
    return np.stack(x, axis=1), np.stack(y, axis=1)


def residual_sums(squares, products, lam, error, leverage):
    """Forgets and adds what one row leaves, a priori times a posteriori error."""
    after = error * (lam / (lam + leverage))[:, None]
    squares *= lam
    squares += after * error
    products *= lam
    products += after[:, :1] * error


class PlainRls:
    """Recursive least squares as numpy users write it, in place and for all right-hand sides of an
    MV at once: matrix products by BLAS, P and the coefficients apart."""

    def __init__(self, mvs, columns, responses, lam):
        self.lam = lam
        self.p = np.tile(np.eye(columns), (mvs, 1, 1))
        self.coefficients = np.zeros((mvs, columns, responses))
        self.squares = np.zeros((mvs, responses))
        self.products = np.zeros((mvs, responses))
        self.correlations = np.zeros((mvs, responses))
        self.error = np.empty((mvs, responses))
        self.leverage = np.empty(mvs)

    def step(self, x, y):
        for i, (p, coefficients) in enumerate(zip(self.p, self.coefficients)):
            px = p @ x[i]
            self.leverage[i] = x[i] @ px
            root = np.sqrt(self.lam + self.leverage[i])
            px /= root
            self.error[i] = y[i] - x[i] @ coefficients
            coefficients += np.outer(px, self.error[i] / root)
            p -= np.outer(px, px)  # symmetric to the bit, or it diverges after 30 000 rows
            p *= 1.0 / self.lam
        residual_sums(self.squares, self.products, self.lam, self.error, self.leverage)
        np.divide(self.products, np.sqrt(self.squares * self.squares[:, :1]), out=self.correlations)


class Rls:
    """The same, as fast as numpy allows.

    P and the coefficients lie side by side, as both are multiplied by x' and get a rank-one update
    with the same left factor; P is kept as P lambda^k, so that forgetting costs no pass; einsum,
    because it beats BLAS at these shapes. All MVs in one call where that fits the cache, else MV by
    MV.
    """

    def __init__(self, mvs, columns, responses, lam, batched):
        self.lam, self.columns, self.batched = lam, columns, batched
        self.both = np.zeros((mvs, columns, columns + responses))
        self.both[:, np.arange(columns), np.arange(columns)] = 1.0
        self.scale = 1.0  # P = both[..., :columns] * scale
        self.row = np.empty((mvs, columns + responses))
        self.right = np.empty((mvs, columns + responses))
        self.work = np.empty((mvs if batched else 1, columns, columns + responses))
        self.squares = np.zeros((mvs, responses))
        self.products = np.zeros((mvs, responses))
        self.term = np.empty((mvs, responses))
        self.correlations = np.zeros((mvs, responses))

    def train(self, x, y):
        p, both, row = self.columns, self.both, self.row
        np.einsum("mi,mij->mj", x, both, out=row)  # [(P x)', prediction]
        leverage = self.scale * np.einsum("mi,mi->m", x, row[:, :p])
        error = row[:, p:]
        np.subtract(error, y, out=error)
        np.multiply(row, np.sqrt(self.scale / (self.lam + leverage))[:, None], out=self.right)
        if self.batched:
            np.einsum("mi,mj->mij", self.right[:, :p], self.right, out=self.work)
            both -= self.work
        else:
            for own, right in zip(both, self.right):
                np.einsum("i,j->ij", right[:p], right, out=self.work[0])
                own -= self.work[0]
        self.scale /= self.lam
        if self.scale > 1e100:
            both[:, :, :p] *= self.scale
            self.scale = 1.0
        return error, leverage

    def step(self, x, y):
        error, leverage = self.train(x, y)
        residual_sums(self.squares, self.products, self.lam, error, leverage)
        np.multiply(self.squares, self.squares[:, :1], out=self.term)
        np.sqrt(self.term, out=self.term)
        np.divide(self.products, self.term, out=self.correlations)


def batch_correlations(x, y):
    """One MV: all correlations from a window of rows by one least-squares solution."""
    coefficients = np.linalg.lstsq(x, y, rcond=None)[0]
    left = y - x @ coefficients
    squares = np.einsum("ki,ki->i", left, left)
    return (left[:, 0] @ left) / np.sqrt(squares[0] * squares)


def median_us(step, seconds, inputs):
    """Median microseconds of step(*next(inputs)), in batches of >= 0.2 ms."""
    begin = time.perf_counter()
    batch, times = 1, []
    while not times or time.perf_counter() - begin < seconds:
        start = time.perf_counter()
        for _ in range(batch):
            step(*next(inputs))
        elapsed = time.perf_counter() - start
        if elapsed < 0.2e-3:
            batch *= 2
        else:
            times.append(elapsed / batch)
    return float(np.median(times)) * 1e6


def blas_library():
    """The file that numpy's linear algebra comes from."""
    with open("/proc/self/maps", encoding="ascii") as maps:
        files = {line.split()[-1] for line in maps if "blas" in line}
    return ", ".join(sorted(files)) or "inside numpy"
