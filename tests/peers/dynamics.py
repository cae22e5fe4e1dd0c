"""Time of one forward-dynamics evaluation of a planar chain, in microseconds.

Prints one JSON object. Each table maps n to the median over the repeats, and
its "_min" twin to the fastest repeat:

  mujoco               mj_forward, called through its C address in a compiled
                       loop (numba), so no Python call is timed
  mujoco_python        mujoco.mj_forward called from Python
  pinocchio            ABA, looped over states in C++ (abaInParallel, 1 thread)
  pinocchio_raw        pin.aba called from Python
  pinocchio_corrected  pinocchio_raw less the same call on a one-link chain,
                       plus the one-link ABA as timed in the C++ loop
  python_call          that difference: what one pin.aba call from Python costs

With --robot FILE, it times a URDF file's tree on a fixed base instead, under the
file's name without its ending.

With --accelerations FILE, it also writes seeded states of the n = 3 and n = 30
chains and both peers' accelerations (rad, rad/s, N m, rad/s^2).
"""

import argparse
import ctypes
import json
import pathlib
import sys
import time
from statistics import median

import mujoco
import numba
import numpy as np
import pinocchio as pin

import chain

BATCH = 64  # states evaluated by one call of Pinocchio's C++ loop


def c_forward():
    """mj_forward of the library the bindings have loaded, as a C function."""
    folder = pathlib.Path(mujoco.__file__).parent
    library = ctypes.CDLL(str(next(folder.glob("libmujoco.so*"))))
    function = library.mj_forward
    function.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    function.restype = None
    return function


FORWARD = c_forward()


@numba.njit
def forward_loop(model, data, q, calls):
    """Call mj_forward `calls` times; q (rad) moves a little on each."""
    for _ in range(calls):
        q[0] += 1e-9
        FORWARD(model, data)


def mujoco_at(n, model=None):
    """(model, data) of the n-link chain, or another one, at its test state."""
    model = model or chain.mujoco_model(n)
    data = mujoco.MjData(model)
    data.qpos, data.qvel, data.qfrc_applied = chain.test_state(n)
    return model, data


def microseconds(run, repeats, seconds=0.02):
    """(median, min) microseconds of one call, where run(k) makes k calls."""
    calls = 1
    while True:
        start = time.perf_counter()
        run(calls)
        if time.perf_counter() - start > seconds:
            break
        calls *= 2
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        run(calls)
        times.append((time.perf_counter() - start) / calls * 1e6)
    return median(times), min(times)


def time_mujoco(n, repeats, model=None):
    """((median, min) in the C loop, (median, min) from Python), us."""
    model, data = mujoco_at(n, model)
    q = data.qpos

    def in_c(calls):
        forward_loop(model._address, data._address, q, calls)

    def in_python(calls):
        forward = mujoco.mj_forward
        for _ in range(calls):
            forward(model, data)

    in_c(1)  # compiles
    return microseconds(in_c, repeats), microseconds(in_python, repeats)


def time_pinocchio(n, repeats, model=None):
    """((median, min) in the C++ loop, (median, min) from Python), us."""
    model = model or chain.pinocchio_model(n)
    data = model.createData()
    q, dq, tau = chain.test_state(n)
    pool = pin.ModelPool(model, 1)
    many = [np.asfortranarray(np.tile(x[:, None], BATCH)) for x in (q, dq, tau)]
    many[0] += 1e-9 * np.arange(BATCH)
    out = np.zeros((n, BATCH), order="F")

    def in_cpp(calls):
        for _ in range(calls):
            pin.abaInParallel(1, pool, *many, out)

    def in_python(calls):
        aba = pin.aba
        for _ in range(calls):
            aba(model, data, q, dq, tau)

    batch = tuple(us / BATCH for us in microseconds(in_cpp, repeats))
    return batch, microseconds(in_python, repeats)


def accelerations(n):
    """A test state of the n-link chain and both peers' answers to it."""
    q, dq, tau = chain.test_state(n)
    model, data = mujoco_at(n)
    mujoco.mj_forward(model, data)
    other = chain.pinocchio_model(n)
    answer = pin.aba(other, other.createData(), q, dq, tau)
    return {
        "links": [
            dict(zip(("length_m", "com_m", "mass_kg", "inertia_kgm2"), row))
            for row in chain.links(n)
        ],
        "q_rad": q.tolist(),
        "dq_rad_s": dq.tolist(),
        "tau_nm": tau.tolist(),
        "mujoco_rad_s2": data.qacc.tolist(),
        "pinocchio_rad_s2": answer.tolist(),
    }


def time_robot(file, repeats):
    """Both peers' median microseconds at a robot's file."""
    name = pathlib.Path(file).stem
    in_mujoco = mujoco.MjModel.from_xml_path(file)
    in_pinocchio = pin.buildModelFromUrdf(file)
    assert in_mujoco.nv == in_pinocchio.nv == in_pinocchio.nq
    in_c, _ = time_mujoco(in_mujoco.nv, repeats, in_mujoco)
    in_cpp, _ = time_pinocchio(in_pinocchio.nv, repeats, in_pinocchio)
    return {"mujoco": {name: in_c[0]}, "pinocchio": {name: in_cpp[0]}, "unit": "us"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--links", type=int, nargs="+", default=[3, 30, 100])
    parser.add_argument("--accelerations", metavar="FILE")
    parser.add_argument("--robot", metavar="FILE")
    args = parser.parse_args()
    if args.robot:
        print(json.dumps(time_robot(args.robot, args.repeats)))
        return

    result = {}

    def note(name, n, pair):
        print(f"n = {n}: {name} {pair[0]:.3f} us", file=sys.stderr)
        result.setdefault(name, {})[str(n)] = round(pair[0], 4)
        result.setdefault(f"{name}_min", {})[str(n)] = round(pair[1], 4)

    one_loop, one_python = time_pinocchio(1, args.repeats)
    call = tuple(max(0.0, a - b) for a, b in zip(one_python, one_loop))
    for n in args.links:
        in_c, in_python = time_mujoco(n, args.repeats)
        note("mujoco", n, in_c)
        note("mujoco_python", n, in_python)
        in_cpp, in_python = time_pinocchio(n, args.repeats)
        note("pinocchio", n, in_cpp)
        note("pinocchio_raw", n, in_python)
        note("pinocchio_corrected", n, tuple(a - b for a, b in zip(in_python, call)))
    result["python_call"] = round(call[0], 4)
    result["unit"] = "us"
    result["versions"] = {"mujoco": mujoco.__version__, "pinocchio": pin.__version__}
    if args.accelerations:
        answers = {str(n): accelerations(n) for n in (3, 30)}
        worst = {}
        for n, a in answers.items():
            ours, theirs = np.array(a["mujoco_rad_s2"]), np.array(a["pinocchio_rad_s2"])
            worst[n] = float(np.max(np.abs(ours - theirs)) / np.max(np.abs(theirs)))
        result["accelerations_differ"] = worst
        pathlib.Path(args.accelerations).write_text(json.dumps(answers, indent=1) + "\n")
    print(json.dumps(result))


if __name__ == "__main__":
    main()
