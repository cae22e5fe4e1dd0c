"""Joint accelerations of URDF files by Pinocchio and of MJCF files by MuJoCo.

    python forward_dynamics.py CASES.json

Each case names a file, its joints in the chain's order, and per state the coordinates `q`, speeds
`dq` and torques `tau`. Other joints are locked at zero. Prints, per case and state, the
accelerations in the same order, or null for a case whose simulator is not installed.
"""

import json
import sys

import numpy as np

try:
    import mujoco
except ImportError:
    mujoco = None
try:
    import pinocchio
except ImportError:
    pinocchio = None


def by_mujoco(case):
    if mujoco is None:
        return None
    model = mujoco.MjModel.from_xml_path(case["file"])
    data = mujoco.MjData(model)
    ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in case["joints"]]
    at = [model.jnt_qposadr[i] for i in ids]
    dof = [model.jnt_dofadr[i] for i in ids]
    rows = []
    for state in case["states"]:
        mujoco.mj_resetData(model, data)
        data.qpos[at] = state["q"]
        data.qvel[dof] = state["dq"]
        data.qfrc_applied[dof] = state["tau"]
        mujoco.mj_forward(model, data)
        rows.append(data.qacc[dof].tolist())
    return rows


def by_pinocchio(case):
    if pinocchio is None:
        return None
    model = pinocchio.buildModelFromUrdf(case["file"])
    locked = [i for i, name in enumerate(model.names) if i > 0 and name not in case["joints"]]
    if locked:
        model = pinocchio.buildReducedModel(model, locked, pinocchio.neutral(model))
    data = model.createData()
    joints = [model.joints[model.getJointId(name)] for name in case["joints"]]
    rows = []
    for state in case["states"]:
        q = pinocchio.neutral(model)
        v, tau = np.zeros(model.nv), np.zeros(model.nv)
        for joint, angle, speed, torque in zip(joints, state["q"], state["dq"], state["tau"]):
            if joint.nq == 2:
                q[joint.idx_q : joint.idx_q + 2] = np.cos(angle), np.sin(angle)
            else:
                q[joint.idx_q] = angle
            v[joint.idx_v], tau[joint.idx_v] = speed, torque
        a = pinocchio.aba(model, data, q, v, tau)
        rows.append([a[joint.idx_v] for joint in joints])
    return rows


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        cases = json.load(file)
    of = {".urdf": by_pinocchio, ".xml": by_mujoco}
    json.dump([of[case["file"][case["file"].rindex("."):]](case) for case in cases], sys.stdout)


if __name__ == "__main__":
    main()
