"""Write the log of a simulated servo arm (one joint) and its true parameters.

The arm obeys

  J q'' = k u(t) - m g l sin q - b q' - c tanh(q' / 0.01)

with q (rad) from hanging, counter-clockwise, J (kg m^2) the whole inertia about
the joint, u (N m) the commanded torque, k (1) the torque constant, b (N m s/rad)
viscous and c (N m) Coulomb friction. It starts at rest at q = 0. The command is
a seeded sum of sines held for each 10-ms sample; the motion is integrated by
RK4 in steps of 0.1 ms and read at 100 Hz by an encoder of 300 degrees in 1024
counts (its steps only: the reading does not stop at the ends of the 300
degrees).

Writes FILE (columns time_s, position_rad, torque_nm) and, beside it, FILE with
the ending .truth.json. Prints one JSON object with both.
"""

import argparse
import json
import math
import pathlib
import random

RATE = 100  # samples per second
SUBSTEPS = 100  # RK4 steps of 0.1 ms per sample
COUNT = math.radians(300.0) / 1024  # rad per encoder count
MASS, ARM, GRAVITY = 0.2, 0.1, 9.81  # kg, m, m/s^2
SLIP = 0.01  # rad/s, width of the Coulomb step

# kg m^2, 1, N m s/rad, N m
ARM_TRUTH = {"inertia": 0.004, "torque_constant": 1.0, "viscous": 0.02, "coulomb": 0.03}
OVER_TRUTH = {"inertia": 0.004, "torque_constant": 1.0, "viscous": 0.01, "coulomb": 0.015}

# Sines of the command: (amplitude N m, lowest Hz, highest Hz).
ARM_SINES = [(0.10, 0.1, 0.4), (0.08, 0.4, 1.0), (0.06, 1.0, 2.0), (0.04, 2.0, 4.0)]
OVER_SINES = [(0.16, 0.2, 0.5), (0.10, 0.5, 1.0), (0.05, 1.0, 2.0)]


def command(sines, seed, samples):
    """Commanded torque (N m) of each sample, fading in over half a second."""
    rng = random.Random(seed)
    waves = [
        (amplitude, rng.uniform(low, high), rng.uniform(0.0, 2.0 * math.pi))
        for amplitude, low, high in sines
    ]
    torque = []
    for i in range(samples):
        t = i / RATE
        u = sum(a * math.sin(2.0 * math.pi * f * t + p) for a, f, p in waves)
        torque.append(round(u * min(1.0, t / 0.5), 6) + 0.0)  # no -0
    return torque


def simulate(truth, torque):
    """Angle (rad) at every sample under the held torque (N m), from rest."""
    inertia, k = truth["inertia"], truth["torque_constant"]
    b, c = truth["viscous"], truth["coulomb"]
    weight, h = MASS * GRAVITY * ARM, 1.0 / (RATE * SUBSTEPS)

    def acceleration(q, w, u):
        friction = b * w + c * math.tanh(w / SLIP)
        return (k * u - weight * math.sin(q) - friction) / inertia

    q, w, angles = 0.0, 0.0, []
    for u in torque:
        angles.append(q)
        for _ in range(SUBSTEPS):
            a1 = acceleration(q, w, u)
            w2 = w + 0.5 * h * a1
            a2 = acceleration(q + 0.5 * h * w, w2, u)
            w3 = w + 0.5 * h * a2
            a3 = acceleration(q + 0.5 * h * w2, w3, u)
            w4 = w + h * a3
            a4 = acceleration(q + h * w3, w4, u)
            q += h / 6.0 * (w + 2.0 * w2 + 2.0 * w3 + w4)
            w += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    return angles


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument(
        "--over-the-top",
        action="store_true",
        help="less friction and more torque: the arm passes upright repeatedly",
    )
    args = parser.parse_args()

    truth = OVER_TRUTH if args.over_the_top else ARM_TRUTH
    sines = OVER_SINES if args.over_the_top else ARM_SINES
    torque = command(sines, args.seed, round(args.seconds * RATE))
    angles = simulate(truth, torque)
    with args.file.open("w", newline="") as out:
        out.write("time_s,position_rad,torque_nm\n")
        for i, (q, u) in enumerate(zip(angles, torque)):
            out.write(f"{i / RATE:.2f},{round(q / COUNT) * COUNT:.6f},{u:.6f}\n")

    turns = [math.floor((q + math.pi) / (2.0 * math.pi)) for q in angles]
    sidecar = args.file.with_suffix(".truth.json")
    report = {
        "log": str(args.file),
        "truth_file": str(sidecar),
        "truth": truth,
        "gravity_torque_nm": MASS * GRAVITY * ARM,
        "largest_angle_rad": round(max(abs(q) for q in angles), 4),
        "passes_upright": sum(a != b for a, b in zip(turns, turns[1:])),
        "quantiser_rms_mrad": round(1e3 * COUNT / math.sqrt(12.0), 4),
    }
    sidecar.write_text(json.dumps(report, indent=1) + "\n")
    print(json.dumps(report))


if __name__ == "__main__":
    main()
