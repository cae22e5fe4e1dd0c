"""Fit four parameters of a servo arm's log with SciPy or CMA-ES.

The simulator is the arm of arm_log.py integrated by RK4 in steps of 1 ms
(20,000 steps for 20 s), compiled by numba. Viscous friction (N m s/rad),
Coulomb friction (N m), inertia (kg m^2) and the torque constant (1) are fitted
as logarithms, so that they stay positive; the gravity torque is known.
Residuals are the angles (rad) at every sample of one free run from rest.

Prints one JSON object. Compile time is not counted. With --starts N the fit
runs from N seeded random starts, each parameter up to a factor 5 off the truth
(log-uniform); a start converges when it ends at no more than 1.1 times the
floor, the lower of the truth's rms and of a fit that starts from the truth.
"""

import argparse
import json
import math
import pathlib
import sys
import time
from statistics import median

import cma
import numba
import numpy as np
import scipy
from scipy.optimize import least_squares

import arm_log

NAMES = ["viscous", "coulomb", "inertia", "torque_constant"]
SUBSTEPS = 10  # RK4 steps of 1 ms per sample
# One fixed start, each parameter a factor 2 off the truth, in the order of NAMES.
FIXED_START = np.log([2.0, 0.5, 2.0, 0.5])
LOST = 1e3  # rad, in place of an angle that overflowed
RANGE = math.log(100.0)  # CMA-ES stays within a factor 100 of its start


@numba.njit
def simulate(p, torque, weight, h):
    """Angles (rad) of the arm under the held torque (N m), from rest.

    p holds the logarithms of NAMES, weight is m g l in N m, h the step in s.
    """
    b, c, inertia, k = np.exp(p)
    out = np.empty(torque.size)
    q = w = 0.0
    for i in range(torque.size):
        out[i] = q
        drive = k * torque[i]
        for _ in range(SUBSTEPS):
            a1 = (drive - weight * math.sin(q) - b * w - c * math.tanh(100.0 * w)) / inertia
            w2, q2 = w + 0.5 * h * a1, q + 0.5 * h * w
            a2 = (drive - weight * math.sin(q2) - b * w2 - c * math.tanh(100.0 * w2)) / inertia
            w3, q3 = w + 0.5 * h * a2, q + 0.5 * h * w2
            a3 = (drive - weight * math.sin(q3) - b * w3 - c * math.tanh(100.0 * w3)) / inertia
            w4, q4 = w + h * a3, q + h * w3
            a4 = (drive - weight * math.sin(q4) - b * w4 - c * math.tanh(100.0 * w4)) / inertia
            q += h / 6.0 * (w + 2.0 * w2 + 2.0 * w3 + w4)
            w += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    return out


class Problem:
    """The residuals of one log, counting the simulations they cost."""

    def __init__(self, log):
        table = np.loadtxt(log, delimiter=",", skiprows=1)
        self.angle, self.torque = table[:, 1], np.ascontiguousarray(table[:, 2])
        self.step = (table[1, 0] - table[0, 0]) / SUBSTEPS
        self.weight = arm_log.MASS * arm_log.GRAVITY * arm_log.ARM
        self.simulations = 0

    def residuals(self, p):
        self.simulations += 1
        p = np.clip(p, -30.0, 30.0)
        error = simulate(p, self.torque, self.weight, self.step) - self.angle
        return np.nan_to_num(np.clip(error, -LOST, LOST), nan=LOST)

    def rms(self, p):
        """Root mean square of the residuals, in mrad."""
        return 1e3 * float(np.sqrt(np.mean(self.residuals(p) ** 2)))


def fit(problem, start, method, seed=1):
    """(parameters as logarithms, seconds, simulations) of one fit."""
    before, begin = problem.simulations, time.perf_counter()
    if method == "cma":
        best, _ = cma.fmin2(
            lambda p: float(np.sum(problem.residuals(np.asarray(p)) ** 2)),
            start,
            0.5,
            {
                "seed": seed,
                "verbose": -9,
                "bounds": [list(start - RANGE), list(start + RANGE)],
                "maxfevals": 2000,
                "tolfun": 1e-6,
                "tolx": 1e-5,
            },
        )
    else:
        best = least_squares(problem.residuals, start, method=method).x
    seconds = time.perf_counter() - begin
    return np.asarray(best), seconds, problem.simulations - before


def named(p):
    return {name: float(f"{v:.6g}") for name, v in zip(NAMES, np.exp(p))}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("log", type=pathlib.Path)
    parser.add_argument("--method", choices=["trf", "lm", "dogbox", "cma"], default="trf")
    parser.add_argument("--starts", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=5, help="of the single fit")
    args = parser.parse_args()

    problem = Problem(args.log)
    truth_file = args.log.with_suffix(".truth.json")
    truth = json.loads(truth_file.read_text())["truth"]
    centre = np.log([truth[name] for name in NAMES])
    problem.rms(centre)  # compiles
    begin = time.perf_counter()
    truth_rms = problem.rms(centre)
    simulation = time.perf_counter() - begin
    floor = min(truth_rms, problem.rms(fit(problem, centre, "trf")[0]))
    result = {
        "method": args.method,
        "simulation_ms": round(1e3 * simulation, 4),
        "truth_rms_mrad": round(truth_rms, 4),
        "floor_rms_mrad": round(floor, 4),
    }
    if args.starts:
        rng = np.random.default_rng(args.seed)
        reach = math.log(5.0)
        starts = centre + rng.uniform(-reach, reach, (args.starts, len(NAMES)))
        rows = []
        for index, start in enumerate(starts):
            p, seconds, simulations = fit(problem, start, args.method, index + 1)
            rows.append((problem.rms(p), seconds, simulations))
            print(f"start {index + 1}: {rows[-1][0]:.3f} mrad", file=sys.stderr)
        result |= {
            "starts": args.starts,
            "converged": sum(row[0] <= 1.1 * floor for row in rows),
            "seconds": round(sum(row[1] for row in rows), 4),
            "seconds_median": round(median(row[1] for row in rows), 4),
            "simulations_median": median(row[2] for row in rows),
            "rms_mrad": [round(row[0], 4) for row in rows],
        }
    else:
        runs = [
            fit(problem, centre + FIXED_START, args.method, args.seed)
            for _ in range(args.repeats)
        ]
        p = runs[0][0]
        result |= {
            "seconds": round(median(run[1] for run in runs), 4),
            "seconds_min": round(min(run[1] for run in runs), 4),
            "simulations": runs[0][2],
            "rms_mrad": round(problem.rms(p), 4),
            "parameters": named(p),
            "error_percent": {
                name: round(100.0 * (value / truth[name] - 1.0), 3)
                for name, value in named(p).items()
            },
        }
    result["versions"] = {
        "scipy": scipy.__version__, "numba": numba.__version__, "cma": cma.__version__
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
