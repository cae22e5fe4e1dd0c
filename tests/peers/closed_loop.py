"""Closed-loop runs of the paper's robot per second, by MuJoCo and by numba.

The task: three links upright, torque at shoulder and hip, classical Runge-Kutta of
fourth order in steps of 1 ms, u = -K x every 10 ms with the gains of chain.py's
robot for Q = 100 I, R = I; exact sensors, no limits; 5 s a run, on `--threads`
threads. Prints one JSON object:

  numba        the equations written out by hand for three links, compiled with
               fastmath, runs spread over threads by prange
  mujoco_rk4   mj_step in a compiled loop (no Python call is timed), RK4
  mujoco_euler the same with MuJoCo's default integrator, semi-implicit Euler
  final_rad    relative angles after one run from START by each, for comparison:
               joint 1 from upright

With `--effects` the drives at shoulder and hip have Coulomb friction, a dead zone, a limit
and a delay. MuJoCo has the friction as `frictionloss`; numba's is tanh(speed / 0.01 rad/s),
which never sticks and needs no search for the moment a joint stops.
"""

import argparse
import ctypes
import json
import math
import pathlib
import threading
import time
from statistics import median

import mujoco
import numba
import numpy as np

import chain

STEP_S, STEPS_PER_SAMPLE, SAMPLES = 1e-3, 10, 500
START = np.array([0.01, -0.02, 0.02])
GAINS = np.array(
    [
        [-75.758443, -32.187228, -11.454290, -13.004784, -6.2134254, -2.3441985],
        [-62.056988, -26.928273, -9.0350845, -10.653945, -5.1619377, -1.8225471],
    ]
)
(L1, C1, M1, I1), (L2, C2, M2, I2), (_, C3, M3, I3) = chain.links(3)
G = chain.GRAVITY
# With --effects: friction, N m; dead zone and limit of a command, N m; its delay in steps.
COULOMB_NM, DEAD_ZONE_NM, LIMIT_NM, DELAY_STEPS = 0.005, 0.02, 2.0, 5
SMOOTH_RAD_S = 0.01

# Absolute angles from upright. Diagonal of the mass matrix, its couplings, and gravity.
J1 = I1 + M1 * C1**2 + (M2 + M3) * L1**2
J2 = I2 + M2 * C2**2 + M3 * L2**2
J3 = I3 + M3 * C3**2
A12, A13, A23 = L1 * (M2 * C2 + M3 * L2), L1 * M3 * C3, L2 * M3 * C3
G1, G2, G3 = (M1 * C1 + (M2 + M3) * L1) * G, (M2 * C2 + M3 * L2) * G, M3 * C3 * G


@numba.njit(fastmath=True, inline="always")
def accelerate(a, b, c, u, v, w, t2, t3):
    """Accelerations at absolute angles a, b, c and speeds u, v, w under the two joint torques."""
    sa, ca = math.sin(a), math.cos(a)
    sb, cb = math.sin(b), math.cos(b)
    sc, cc = math.sin(c), math.cos(c)
    m12, s12 = A12 * (ca * cb + sa * sb), A12 * (sa * cb - ca * sb)
    m13, s13 = A13 * (ca * cc + sa * sc), A13 * (sa * cc - ca * sc)
    m23, s23 = A23 * (cb * cc + sb * sc), A23 * (sb * cc - cb * sc)
    r1 = -t2 + G1 * sa - s12 * v * v - s13 * w * w
    r2 = t2 - t3 + G2 * sb + s12 * u * u - s23 * w * w
    r3 = t3 + G3 * sc + s13 * u * u + s23 * v * v
    i1 = 1.0 / J1
    l2, l3 = m12 * i1, m13 * i1
    d2, e = J2 - l2 * m12, m23 - l3 * m12
    l32 = e / d2
    d3 = J3 - l3 * m13 - l32 * e
    r2 -= l2 * r1
    r3 -= l3 * r1 + l32 * r2
    z = r3 / d3
    y = r2 / d2 - l32 * z
    x = r1 * i1 - l2 * y - l3 * z
    return x, y, z


@numba.njit(fastmath=True, inline="always")
def rubbed(a, b, c, u, v, w, t2, t3, effects):
    """Accelerations with the friction of shoulder and hip, if there is any."""
    if effects:
        t2 -= COULOMB_NM * math.tanh((v - u) / SMOOTH_RAD_S)
        t3 -= COULOMB_NM * math.tanh((w - v) / SMOOTH_RAD_S)
    return accelerate(a, b, c, u, v, w, t2, t3)


@numba.njit(fastmath=True, inline="always")
def driven(command):
    """Torque of a drive with dead zone and limit."""
    if abs(command) <= DEAD_ZONE_NM:
        return 0.0
    return min(max(command, -LIMIT_NM), LIMIT_NM)


@numba.njit(fastmath=True)
def one_run(q1, q2, q3, effects):
    """The relative angles after one run from rest."""
    a, b, c = q1, q1 + q2, q1 + q2 + q3
    u = v = w = 0.0
    h = STEP_S
    t2 = t3 = 0.0
    for _ in range(SAMPLES):
        s = (a, b - a, c - b, u, v - u, w - v)
        c2 = c3 = 0.0
        for k in range(6):
            c2 -= GAINS[0, k] * s[k]
            c3 -= GAINS[1, k] * s[k]
        if effects:
            c2, c3 = driven(c2), driven(c3)
        for step in range(STEPS_PER_SAMPLE):
            if step == DELAY_STEPS or not effects:
                t2, t3 = c2, c3
            x1, y1, z1 = rubbed(a, b, c, u, v, w, t2, t3, effects)
            u2, v2, w2 = u + h / 2 * x1, v + h / 2 * y1, w + h / 2 * z1
            x2, y2, z2 = rubbed(
                a + h / 2 * u, b + h / 2 * v, c + h / 2 * w, u2, v2, w2, t2, t3, effects
            )
            u3, v3, w3 = u + h / 2 * x2, v + h / 2 * y2, w + h / 2 * z2
            x3, y3, z3 = rubbed(
                a + h / 2 * u2, b + h / 2 * v2, c + h / 2 * w2, u3, v3, w3, t2, t3, effects
            )
            u4, v4, w4 = u + h * x3, v + h * y3, w + h * z3
            x4, y4, z4 = rubbed(
                a + h * u3, b + h * v3, c + h * w3, u4, v4, w4, t2, t3, effects
            )
            a += h / 6 * (u + 2 * u2 + 2 * u3 + u4)
            b += h / 6 * (v + 2 * v2 + 2 * v3 + v4)
            c += h / 6 * (w + 2 * w2 + 2 * w3 + w4)
            u += h / 6 * (x1 + 2 * x2 + 2 * x3 + x4)
            v += h / 6 * (y1 + 2 * y2 + 2 * y3 + y4)
            w += h / 6 * (z1 + 2 * z2 + 2 * z3 + z4)
    return a, b - a, c - b


@numba.njit(fastmath=True, parallel=True)
def many_runs(starts, ends, effects):
    """Runs from every start, side by side."""
    for i in numba.prange(len(starts)):
        x, y, z = one_run(starts[i, 0], starts[i, 1], starts[i, 2], effects)
        ends[i, 0], ends[i, 1], ends[i, 2] = x, y, z


def c_function(name):
    """A function of the library the bindings have loaded, called with model and data."""
    folder = pathlib.Path(mujoco.__file__).parent
    function = getattr(ctypes.CDLL(str(next(folder.glob("libmujoco.so*")))), name)
    function.argtypes, function.restype = [ctypes.c_void_p, ctypes.c_void_p], None
    return function


STEP = c_function("mj_step")


@numba.njit(nogil=True)
def mujoco_run(model, data, q, dq, torque, samples, effects):
    """`samples` periods of the loop; q, dq and torque are MuJoCo's own memory."""
    for _ in range(samples):
        t2 = t3 = 0.0
        for k in range(3):
            angle = q[k] - math.pi if k == 0 else q[k]
            t2 -= GAINS[0, k] * angle + GAINS[0, 3 + k] * dq[k]
            t3 -= GAINS[1, k] * angle + GAINS[1, 3 + k] * dq[k]
        if effects:
            t2, t3 = driven(t2), driven(t3)
        for step in range(STEPS_PER_SAMPLE):
            if step == DELAY_STEPS or not effects:
                torque[1], torque[2] = t2, t3
            STEP(model, data)


class Mujoco:
    """One simulation, ready to be run from START."""

    def __init__(self, integrator, effects):
        self.effects = effects
        self.model = chain.mujoco_model(3)
        if effects:
            self.model.dof_frictionloss[1:] = COULOMB_NM
        self.model.opt.timestep = STEP_S
        self.model.opt.integrator = integrator
        self.data = mujoco.MjData(self.model)
        # Kept: the views share memory with the simulation.
        self.views = self.data.qpos, self.data.qvel, self.data.qfrc_applied

    def run(self, samples=SAMPLES):
        mujoco.mj_resetData(self.model, self.data)
        self.data.qfrc_applied[:] = 0.0
        self.data.qpos[:] = START
        self.data.qpos[0] += math.pi
        mujoco_run(self.model._address, self.data._address, *self.views, samples, self.effects)
        return self.data.qpos - [math.pi, 0.0, 0.0]


def mujoco_rate(integrator, threads, runs, effects):
    """Runs per second on that many threads."""
    simulations = [Mujoco(integrator, effects) for _ in range(threads)]
    simulations[0].run(1)  # compiles

    def work(simulation):
        for _ in range(runs):
            simulation.run()

    workers = [threading.Thread(target=work, args=(s,)) for s in simulations]
    begun = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return threads * runs / (time.perf_counter() - begun)


def numba_rate(runs, effects):
    """Runs per second on numba's threads."""
    starts = START + 1e-6 * np.arange(runs)[:, None]
    ends = np.empty_like(starts)
    begun = time.perf_counter()
    many_runs(starts, ends, effects)
    return runs / (time.perf_counter() - begun)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--runs", type=int, default=1000, help="runs of numba in a repeat")
    parser.add_argument("--mujoco-runs", type=int, default=15, help="runs per thread")
    parser.add_argument("--effects", action="store_true", help="friction, dead zone, limit, delay")
    args = parser.parse_args()
    numba.set_num_threads(args.threads)
    numba_rate(args.threads, args.effects)  # compiles
    rk4, euler = mujoco.mjtIntegrator.mjINT_RK4, mujoco.mjtIntegrator.mjINT_EULER

    def rate(measure):
        return round(median(measure() for _ in range(args.repeats)), 1)

    result = {
        "numba": rate(lambda: numba_rate(args.runs, args.effects)),
        "mujoco_rk4": rate(lambda: mujoco_rate(rk4, args.threads, args.mujoco_runs, args.effects)),
        "mujoco_euler": rate(lambda: mujoco_rate(euler, args.threads, args.mujoco_runs, args.effects)),
        "unit": "5-s runs per second",
        "final_rad": {
            "numba": list(one_run(*START, args.effects)),
            "mujoco_rk4": Mujoco(rk4, args.effects).run().tolist(),
        },
        # Before the loop forgets where it began.
        "half_second_rad": {"mujoco_rk4": Mujoco(rk4, args.effects).run(50).tolist()},
        "versions": {"mujoco": mujoco.__version__, "numba": numba.__version__},
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
