"""Whether python-control reads what `handstand gains --state-space FILE.json` writes, and agrees with it.

Prints the largest differences: poles of the loop that python-control closes, K by its own dlqr, and the poles of
the loop with the estimator.
"""

import argparse
import json

import control
import numpy as np


def radius(poles):
    return float(np.max(np.abs(poles)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=argparse.FileType())
    design = json.load(parser.parse_args().file)

    s = design["sampled"]
    plant = control.ss(s["a"], s["b"], s["c"], s["d"], s["ts_s"])
    k = np.array(design["k"])
    states = plant.nstates
    q = np.zeros((states, states))
    given = np.array(design["q"])
    q[: len(given), : len(given)] = given
    theirs, _, _ = control.dlqr(plant.A, plant.B, q, np.array(design["r"]))
    ours = radius([complex(*z) for z in design["loop_poles"]])
    result = {
        "k": float(np.max(np.abs(theirs - k)) / np.max(np.abs(k))),
        "radius": abs(radius(np.linalg.eigvals(plant.A - plant.B @ k)) - ours),
    }
    if design["estimator"]:
        estimator = design["estimator"]
        c = estimator["controller"]
        controller = control.ss(c["a"], c["b"], c["c"], c["d"], s["ts_s"])
        outputs = len(estimator["outputs"])
        measured = control.ss(s["a"], s["b"], s["c"][:outputs], s["d"][:outputs], s["ts_s"])
        loop = control.feedback(measured, controller, sign=1)
        found = radius([complex(*z) for z in estimator["loop_poles"]])
        result["radius_estimator"] = abs(radius(loop.poles()) - found)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
