"""Margins of random sampled loops by python-control, for the library's own.

Writes `host/tests/data/margins.json` on stdout: per loop A, B, K of x(k+1) = A x + B u, u = -K x, and what
python-control finds of L = K (zI - A)^-1 B: `stability_margins` of each channel with the others closed (all crossings,
those at the ends of the circle added, reduced to the nearest), `disk_margins`, `linfnorm` of S and T. Common margins
of several channels are not in python-control: they are eigenvalues of A - g B K, by bisection, and of L on the circle.

    VENV/bin/pip install control==0.10.2 slycot==0.7.1 mpmath
    VENV/bin/python margins.py > ../../host/tests/data/margins.json
"""

import json

import control
import numpy as np
import scipy.optimize as so

from riccati import SplitMix

TS = 0.01


def loop(seed):
    random = SplitMix(seed)
    n, m = 2 + random.next() % 4, 1 + seed % 3
    a = random.matrix(n, n) * 0.6 + np.eye(n)
    b, weight = random.matrix(n, m), 10 ** (2 * random.uniform())
    k, _, _ = control.dlqr(a, b, np.eye(n), weight * np.eye(m))
    return a, b, k


def nearest(gains, phases, frequencies):
    """Of all crossings: gains below and above 1, phase rad, delay s."""
    below = [g for g in gains if 0 < g < 1]
    above = [g for g in gains if g > 1]
    turn = np.radians(np.mod(phases, 360.0))
    return {
        "gain": [max(below, default=0.0), min(above, default=None)],
        "phase_rad": min((min(t, 2 * np.pi - t) for t in turn), default=None),
        "delay_s": min((t / w for t, w in zip(turn, frequencies)), default=None),
    }


def single(a, b, k, channel):
    """The loop of one channel, the others closed."""
    others = [i for i in range(b.shape[1]) if i != channel]
    closed = a - b[:, others] @ k[others]
    own = control.ss(closed, b[:, [channel]], k[[channel]], 0, TS)
    gains, phases, _, _, frequencies, _ = control.stability_margins(own, returnall=True)
    # It leaves out crossings at the ends of the circle.
    ends = [-1 / own(z).real for z in (1, -1)]
    return nearest([*gains, *ends], phases, frequencies)


def common(a, b, k):
    def radius(gain):
        return max(abs(np.linalg.eigvals(a - gain * b @ k)))

    def edge(towards):
        logs = np.linspace(0, towards * 12, 24001)
        outside = [i for i, log in enumerate(logs) if radius(np.exp(log)) >= 1]
        if not outside:
            return None
        at = so.brentq(lambda log: radius(np.exp(log)) - 1, logs[outside[0] - 1], logs[outside[0]], xtol=1e-15)
        return float(np.exp(at))

    def values(theta):
        lam = np.linalg.eigvals(k @ np.linalg.solve(np.exp(1j * theta) * np.eye(len(a)) - a, b))
        return lam[np.argsort(abs(lam))]

    grid = np.pi * (np.arange(40000) + 0.5) / 40000
    sizes = np.array([abs(values(theta)) for theta in grid]) - 1
    turns, frequencies = [], []
    for i, which in zip(*np.nonzero(sizes[:-1] * sizes[1:] < 0)):
        at = so.brentq(lambda theta: abs(values(theta)[which]) - 1, grid[i], grid[i + 1], xtol=1e-15)
        turns.append(np.degrees(np.angle(values(at)[which]) + np.pi))
        frequencies.append(at / TS)
    found = nearest([], turns, frequencies)
    found["gain"] = [edge(-1) or 0.0, edge(1)]
    return found


def disk(system):
    """The least over ever closer frequencies."""
    low, high = 1e-3, np.pi / TS
    omega = np.linspace(low, high, 4001)
    for _ in range(4):
        alpha, _, _ = control.disk_margins(system, omega, returnall=True)
        at, step = omega[np.argmin(alpha)], omega[1] - omega[0]
        omega = np.linspace(max(at - 2 * step, low), min(at + 2 * step, high), 401)
    return float(min(alpha))


def margins(seed):
    a, b, k = loop(seed)
    m = b.shape[1]
    system = control.ss(a, b, k, np.zeros((m, m)), TS)
    sensitivity = control.ss(a - b @ k, b, -k, np.eye(m), TS)
    complementary = control.ss(a - b @ k, b, k, np.zeros((m, m)), TS)
    return {
        "a": a.tolist(),
        "b": b.tolist(),
        "k": k.tolist(),
        "common": common(a, b, k),
        "single": [single(a, b, k, i) for i in range(m)],
        "disk": disk(system),
        "sensitivity": control.linfnorm(sensitivity, 1e-12)[0],
        "complementary": control.linfnorm(complementary, 1e-12)[0],
    }


if __name__ == "__main__":
    print(json.dumps({"ts_s": TS, "loops": [margins(seed) for seed in range(20)]}, indent=1))
