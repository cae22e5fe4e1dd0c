"""Time of one DLQR synthesis (Riccati equation and gain) by SciPy and Drake, and how right the gains are.

Prints one JSON object: for each peer, seconds by number of states (median of the repeats; chains of 3, 10 and 30
equal links, all but the first joint driven, sampled at 10 ms, Q = I, R = I), and `off`: how far K of 60 states is
from 60 digits, relative, in its largest entry. FIXTURE is `host/tests/data/riccati_chain.f64`, made by riccati.py.
Drake is left out where it is not installed.
"""

import argparse
import json
import time
from statistics import median

import numpy as np

import riccati


def drake():
    try:
        from pydrake.systems.controllers import DiscreteTimeLinearQuadraticRegulator
    except ImportError:
        return None
    return lambda a, b, q, r: DiscreteTimeLinearQuadraticRegulator(a, b, q, r)[0]


def seconds(solve, matrices, repeats, least=0.05):
    """Median time of one call, many calls to a measurement where they are short."""
    calls = 1
    while True:
        start = time.perf_counter()
        for _ in range(calls):
            solve(*matrices)
        if time.perf_counter() - start > least:
            break
        calls *= 2
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        for _ in range(calls):
            solve(*matrices)
        times.append((time.perf_counter() - start) / calls)
    return median(times)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fixture")
    parser.add_argument("--repeats", type=int, default=7)
    args = parser.parse_args()

    values = np.fromfile(args.fixture, dtype="<f8")
    a, b, exact = np.split(values, [60 * 60, 60 * 60 + 60 * 29])
    long_chain = a.reshape(60, 60), b.reshape(60, 29), np.eye(60), np.eye(29)
    exact = exact.reshape(29, 60)

    peers = {"scipy": riccati.discrete, "drake": drake()}
    result = {}
    for name, solve in peers.items():
        if solve is None:
            continue
        result[name] = {"off": riccati.off(solve(*long_chain), exact)}
        for links in (3, 10, 30):
            a, b = riccati.chain(links)
            matrices = a, b, np.eye(2 * links), np.eye(links - 1)
            result[name][str(2 * links)] = seconds(solve, matrices, args.repeats)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
