"""Random linear-quadratic problems and a long chain, for SciPy, mpmath and the library alike.

Problems come from splitmix64, written out here and in `host/tests/it/riccati.rs`, so both sides solve the same bits:
`problem(seed)` gives A, B, Q, R. `chain(n)` is n equal links standing upright, joint 1 passive, sampled at 10 ms.

As a program, writes the fixtures of `host/tests/it/riccati.rs`, little-endian doubles, matrices row by row:

  riccati_random.f64   for seeds 0..999 the discrete K, by SciPy and to 60 digits by mpmath, then the continuous K
  riccati_chain.f64    A, B of the chain of 30, then its K to 60 digits; Q = I, R = I

and prints how far SciPy's own K are from 60 digits: relative, in the largest entry of K. It takes some minutes.
"""

import argparse
import json
import math
import pathlib

import mpmath as mp
import numpy as np
import scipy.linalg as sl

MASK = (1 << 64) - 1
UNIFORM_LINK = (0.15, 0.075, 0.2, 3.75e-4)  # length m, centre of mass m, mass kg, inertia kg m^2
GRAVITY = 9.81


class SplitMix:
    def __init__(self, seed):
        self.state = seed

    def next(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return z ^ (z >> 31)

    def uniform(self):
        """In [-1, 1)."""
        return (self.next() >> 11) * 2.0**-52 - 1.0

    def matrix(self, rows, columns):
        return np.array([[self.uniform() for _ in range(columns)] for _ in range(rows)])


def gram(c):
    """C'C, summed in the order of C's rows."""
    n = c.shape[1]
    total = np.zeros((n, n))
    for row in c:
        total += np.outer(row, row)
    return total


def problem(seed):
    """A, B, Q, R: 1 to 8 states, 1 to 3 inputs, Q of any rank."""
    random = SplitMix(seed)
    n = 1 + random.next() % 8
    m = 1 + random.next() % min(n, 3)
    p = 1 + random.next() % n
    a = random.matrix(n, n) * (1.2 * math.sqrt(3.0 / n))
    b = random.matrix(n, m)
    q = gram(random.matrix(p, n))
    r = gram(random.matrix(m, m)) + 0.1 * np.eye(m)
    return a, b, q, r


def chain(n, ts=0.01):
    """A and B of n links upright, driven but for joint 1, held over ts seconds."""
    length, com, mass, inertia = UNIFORM_LINK
    beyond = mass * np.arange(n - 1, -1, -1)
    first = mass * com + length * beyond
    m = np.empty((n, n))
    for i in range(n):
        m[i, i] = inertia + mass * com**2 + length**2 * beyond[i]
        for j in range(i + 1, n):
            m[i, j] = m[j, i] = length * first[j]
    lower = np.tril(np.ones((n, n)))
    m = lower.T @ m @ lower
    weight = lower.T @ np.diag(GRAVITY * first) @ lower
    block = np.zeros((3 * n - 1, 3 * n - 1))
    block[:n, n : 2 * n] = np.eye(n)
    block[n : 2 * n, :n] = np.linalg.solve(m, weight)
    block[n : 2 * n, 2 * n :] = np.linalg.solve(m, np.eye(n)[:, 1:])
    exponential = sl.expm(block * ts)
    return exponential[: 2 * n, : 2 * n].copy(), exponential[: 2 * n, 2 * n :].copy()


def discrete(a, b, q, r):
    x = sl.solve_discrete_are(a, b, q, r)
    return np.linalg.solve(r + b.T @ x @ b, b.T @ x @ a)


def continuous(a, b, q, r):
    x = sl.solve_continuous_are(a, b, q, r)
    return np.linalg.solve(r, b.T @ x)


def doubled(f, g, h, digits):
    """Structure-preserving doubling in many digits."""
    for _ in range(200):
        w = (mp.eye(f.rows) + g * h) ** -1
        fw = f * w
        more = f.T * (h * (w * f))
        g += fw * g * f.T
        f = fw * f
        h += more
        if mp.norm(more, mp.inf) < mp.mpf(10) ** (8 - digits) * mp.norm(h, mp.inf):
            return h
    raise ArithmeticError("doubling did not converge")


def exact(matrices, digits):
    mp.mp.dps = digits
    return [mp.matrix(m.tolist()) for m in matrices]


def discrete_exact(*matrices, digits=60):
    a, b, q, r = exact(matrices, digits)
    h = doubled(a.copy(), b * (r**-1) * b.T, q.copy(), digits)
    k = ((r + b.T * h * b) ** -1) * (b.T * h * a)
    return np.array(k.tolist(), dtype=float)


def continuous_exact(*matrices, digits=60):
    """By Cayley's transform (Chu, Fan, Lin, Linear Algebra and its Applications 396 (2005) 55)."""
    a, b, q, r = exact(matrices, digits)
    g, shift = b * (r**-1) * b.T, mp.mpf("1.7")
    inverse = (a - shift * mp.eye(a.rows)) ** -1
    w = (a.T - shift * mp.eye(a.rows) + q * inverse * g) ** -1
    f = mp.eye(a.rows) + 2 * shift * w.T
    h = doubled(f, 2 * shift * inverse * g * w, 2 * shift * w * q * inverse, digits)
    return np.array(((r**-1) * b.T * h).tolist(), dtype=float)


def off(k, exact):
    return float(np.max(np.abs(k - exact)) / np.max(np.abs(exact)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=1000)
    args = parser.parse_args()

    worst, rows = [0.0, 0.0], []
    for seed in range(args.seeds):
        matrices = problem(seed)
        pairs = (discrete, discrete_exact), (continuous, continuous_exact)
        for time, (theirs, reference) in enumerate(pairs):
            k, reference = theirs(*matrices), reference(*matrices)
            rows += [k.ravel(), reference.ravel()]
            worst[time] = max(worst[time], off(k, reference))
    (args.folder / "riccati_random.f64").write_bytes(np.concatenate(rows).astype("<f8").tobytes())

    a, b = chain(30)
    q, r = np.eye(60), np.eye(29)
    reference = discrete_exact(a, b, q, r)
    matrices = np.concatenate([a.ravel(), b.ravel(), reference.ravel()])
    (args.folder / "riccati_chain.f64").write_bytes(matrices.astype("<f8").tobytes())
    found = {
        "scipy_discrete": worst[0],
        "scipy_continuous": worst[1],
        "scipy_chain": off(discrete(a, b, q, r), reference),
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
