"""Slopes of joint accelerations at rest: of URDF files by Pinocchio, of MJCF files by MuJoCo.

    python linearise.py CASES.json

Each case names a file, its joints in the model's order, a pose `q`, and `ctrl`, the input of each
joint that an actuator of the file drives, null of the others. Joints that are not named are locked
at zero. What no actuator holds is held by a constant torque. Prints per case `q`, `dq` and `u`: the
slopes of the accelerations per coordinate, per speed and per input, a row per joint, where an input
is the joint's actuator's or, without one, its torque; and `rest`, the accelerations at the pose; null
for a case whose simulator is not installed.

Pinocchio's slopes are exact (computeABADerivatives), MuJoCo's are central differences of a step
(mjd_transitionFD).
"""

import numpy as np

from robots import answer_cases, mujoco, pinocchio

STEP_S = 1e-3
DIFFERENCE = 1e-6


def by_pinocchio(case, robot):
    model, data, at = robot.model, robot.data, robot.at
    q = robot.pose(case["q"])
    torque = pinocchio.computeGeneralizedGravity(model, data, q).copy()
    rest = pinocchio.aba(model, data, q, np.zeros(model.nv), torque).copy()
    per_q, per_dq, per_u = (
        np.array(slope)
        for slope in pinocchio.computeABADerivatives(model, data, q, np.zeros(model.nv), torque)
    )
    # Half of the last one may be all that is filled in.
    per_u = np.triu(per_u) + np.triu(per_u, 1).T
    slopes = [slope[np.ix_(at, at)].tolist() for slope in (per_q, per_dq, per_u)]
    return dict(zip(("q", "dq", "u"), slopes), rest=rest[at].tolist())


def by_mujoco(case, robot):
    model, data, dof = robot.model, robot.data, robot.dof
    model.opt.timestep = STEP_S
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    data.qpos[robot.qpos] = case["q"]
    actuator = {model.actuator_trnid[a, 0]: a for a in range(model.nu)}
    driven = [actuator.get(i) for i in robot.ids]
    for own, value in zip(driven, case["ctrl"]):
        if own is not None:
            data.ctrl[own] = value
    mujoco.mj_forward(model, data)
    free = [d for d, own in zip(dof, driven) if own is None]
    held = data.qfrc_bias - data.qfrc_passive
    data.qfrc_applied[free] = held[free]
    mujoco.mj_forward(model, data)
    rest = data.qacc.copy()
    nv = model.nv
    a, b = np.zeros((2 * nv, 2 * nv)), np.zeros((2 * nv, model.nu)) if model.nu else None
    mujoco.mjd_transitionFD(model, data, DIFFERENCE, True, a, b, None, None)
    mass = np.zeros((nv, nv))
    mujoco.mj_fullM(model, data, mass)
    per_q, per_dq = a[nv:, :nv] / STEP_S, (a[nv:, nv:] - np.eye(nv)) / STEP_S
    per_torque = np.linalg.inv(mass)
    columns = [
        per_torque[dof, d] if own is None else b[nv:, own][dof] / STEP_S
        for d, own in zip(dof, driven)
    ]
    return {
        "q": per_q[np.ix_(dof, dof)].tolist(),
        "dq": per_dq[np.ix_(dof, dof)].tolist(),
        "u": np.array(columns).T.tolist(),
        "rest": rest[dof].tolist(),
    }


if __name__ == "__main__":
    answer_cases(by_pinocchio, by_mujoco)
