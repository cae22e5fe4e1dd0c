"""Fit four parameters of a servo arm's logs with mujoco.sysid.

The arm of arm_log.py as an MJCF hinge: joint damping (N m s/rad), frictionloss
(N m), armature (kg m^2: the inertia about the joint less the known point mass)
and the motor's gear (N m per N m of command). MuJoCo steps by 1 ms
(implicitfast); the command is held over each sample; the residual is the joint
angle (qpos) at every sample of one free run from rest. mujoco.sysid resamples
commands linearly, so it is given them already held at every step.

The start is a factor 2 off the truth, as in fit_scipy.py, with bounds a factor
20 about the truth (inertia: above that of the point mass). mujoco.sysid does
not count simulations; its residual function is wrapped and the columns counted.
MuJoCo's friction is a soft constraint, not the log's tanh: the rms at the truth
shows how far apart the two are. Prints one JSON object; if mujoco.sysid cannot
be imported it holds "error".
"""

import argparse
import contextlib
import json
import pathlib
import sys
import time
from statistics import median

import numpy as np

import arm_log

STEP = 1e-3  # s
HELD = round(1.0 / (arm_log.RATE * STEP))  # steps per sample
BODY = 1e-6  # kg m^2, the least inertia the body needs about its own centre
FIXED = arm_log.MASS * arm_log.ARM**2 + BODY  # kg m^2, not the armature's
START = {"viscous": 2.0, "coulomb": 0.5, "inertia": 2.0, "torque_constant": 0.5}

XML = f"""
<mujoco>
  <option gravity="0 {-arm_log.GRAVITY} 0" timestep="{STEP}" integrator="implicitfast">
    <flag contact="disable"/>
  </option>
  <worldbody>
    <body>
      <joint name="joint" axis="0 0 1" damping="1" frictionloss="1" armature="1"/>
      <inertial pos="0 {-arm_log.ARM} 0" mass="{arm_log.MASS}"
                diaginertia="{BODY} {BODY} {BODY}"/>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="joint"/></actuator>
  <sensor><jointpos name="angle" joint="joint"/></sensor>
</mujoco>
"""


def set_viscous(spec, p):
    """Write the damping (N m s/rad): the linear term of three."""
    spec.joint("joint").damping[0] = p.value[0]


def set_coulomb(spec, p):
    """Write the frictionloss (N m)."""
    spec.joint("joint").frictionloss = p.value[0]


def set_inertia(spec, p):
    """Write the armature from the whole inertia (kg m^2)."""
    spec.joint("joint").armature = p.value[0] - FIXED


def set_torque_constant(spec, p):
    """Write the motor's gear (N m per N m of command)."""
    spec.actuator("motor").gear[0] = p.value[0]


SETTERS = {
    "viscous": set_viscous,
    "coulomb": set_coulomb,
    "inertia": set_inertia,
    "torque_constant": set_torque_constant,
}


def sequences(mujoco, sysid, logs):
    """The logs as measured sequences of one model."""
    spec = mujoco.MjSpec.from_string(XML)
    model = spec.compile()
    initial = sysid.create_initial_state(model, np.zeros(1), np.zeros(1))
    commands, angles = [], []
    for log in logs:
        table = np.loadtxt(log, delimiter=",", skiprows=1)
        held = np.repeat(table[:, 2], HELD)
        # A hair short of the last step, lest rounding adds one to the count.
        end = (held.size - 1) * STEP * (1.0 - 1e-12)
        commands.append(
            sysid.TimeSeries.from_control_names(
                np.linspace(0.0, end, held.size), held[:, None], model
            )
        )
        angles.append(
            sysid.TimeSeries.from_names(
                table[:, 0],
                table[:, 1:2],
                model,
                names=[("joint", sysid.SignalType.MjStateQPos)],
            )
        )
    names = [log.stem for log in logs]
    initials = [initial] * len(logs)
    return sysid.ModelSequences("arm", spec, names, initials, commands, angles)


def parameters(sysid, truth):
    """The four parameters, at their start, with their bounds."""
    params = sysid.ParameterDict()
    for name, setter in SETTERS.items():
        true = truth[name]
        low = max(true / 20.0, FIXED * 1.01) if name == "inertia" else true / 20.0
        params.add(
            sysid.Parameter(name, true * START[name], low, true * 20.0, modifier=setter)
        )
    return params


class Counter:
    """A residual function of mujoco.sysid that counts its simulations."""

    def __init__(self, function, logs):
        self.function, self.logs, self.simulations = function, logs, 0

    def __call__(self, x, params, **options):
        columns = 1 if x.ndim == 1 else x.shape[1]
        self.simulations += columns * self.logs
        return self.function(x, params, **options)

    def rms(self, x, params):
        """Root mean square difference of the angles (mrad) at x."""
        _, predicted, measured = self.function(np.asarray(x), params.copy())
        error = [
            p.data - m.data
            for group in zip(predicted, measured)
            for p, m in zip(*group)
        ]
        return 1e3 * float(np.sqrt(np.mean(np.concatenate(error) ** 2)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("logs", type=pathlib.Path, nargs="+")
    parser.add_argument(
        "--optimizer", choices=["mujoco", "scipy", "scipy_parallel_fd"], default="mujoco"
    )
    parser.add_argument("--threads", type=int, help="of the rollouts; default every core")
    parser.add_argument("--repeats", type=int, default=1)
    args = parser.parse_args()

    try:
        import mujoco
        from mujoco import sysid

        options = {"n_threads": args.threads} if args.threads else {}
        build = sysid.build_residual_fn
    except (ImportError, AttributeError) as error:
        # Without its extra requirements the package imports, but is empty.
        print(json.dumps({"error": f"mujoco.sysid cannot be used: {error}"}))
        sys.exit(1)

    truth_file = args.logs[0].with_suffix(".truth.json")
    truth = json.loads(truth_file.read_text())["truth"]
    measured = sequences(mujoco, sysid, args.logs)
    residual = Counter(build(models_sequences=[measured], **options), len(args.logs))
    exact = np.array([truth[name] for name in SETTERS])
    truth_rms = residual.rms(exact, parameters(sysid, truth))

    seconds = []
    for _ in range(args.repeats):
        residual.simulations = 0
        begin = time.perf_counter()
        # The optimisers report on stdout whatever verbose says.
        with contextlib.redirect_stdout(sys.stderr):
            fitted, _ = sysid.optimize(
                initial_params=parameters(sysid, truth),
                residual_fn=residual,
                optimizer=args.optimizer,
                verbose=False,
            )
        seconds.append(time.perf_counter() - begin)
        print(f"{seconds[-1]:.3f} s", file=sys.stderr)

    found = {name: float(fitted[name].value[0]) for name in SETTERS}
    print(
        json.dumps(
            {
                "logs": len(args.logs),
                "optimizer": args.optimizer,
                "threads": args.threads,
                "seconds": round(median(seconds), 4),
                "seconds_min": round(min(seconds), 4),
                "simulations": residual.simulations,
                "truth_rms_mrad": round(truth_rms, 4),
                "rms_mrad": round(residual.rms(list(found.values()), fitted), 4),
                "parameters": {name: float(f"{v:.6g}") for name, v in found.items()},
                "error_percent": {
                    name: round(100.0 * (v / truth[name] - 1.0), 3)
                    for name, v in found.items()
                },
                "versions": {"mujoco": mujoco.__version__},
            }
        )
    )


if __name__ == "__main__":
    main()
