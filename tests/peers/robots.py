"""Robots of URDF files in Pinocchio and of MJCF files in MuJoCo, their joints by name.

A case is a dictionary with `file`, `joints`, the names in the order of the answers, and what its
script asks. Joints that are not named are locked at zero.
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


class PinocchioRobot:
    """A URDF file: `model`, `data` and `at`, the places of the named joints in speeds."""

    def __init__(self, case):
        model = pinocchio.buildModelFromUrdf(case["file"])
        locked = [i for i, name in enumerate(model.names) if i > 0 and name not in case["joints"]]
        if locked:
            model = pinocchio.buildReducedModel(model, locked, pinocchio.neutral(model))
        self.model, self.data = model, model.createData()
        self.joints = [model.joints[model.getJointId(name)] for name in case["joints"]]
        self.at = [joint.idx_v for joint in self.joints]

    def pose(self, coordinates):
        """The configuration with these coordinates of the named joints, rad or m."""
        q = pinocchio.neutral(self.model)
        for joint, angle in zip(self.joints, coordinates):
            if joint.nq == 2:
                q[joint.idx_q : joint.idx_q + 2] = np.cos(angle), np.sin(angle)
            else:
                q[joint.idx_q] = angle
        return q

    def speeds(self, values):
        """Speeds or torques of all joints, those of the named ones given."""
        all_values = np.zeros(self.model.nv)
        all_values[self.at] = values
        return all_values


class MujocoRobot:
    """An MJCF file: `model`, `data`, and per named joint `ids`, `qpos` and `dof`, its places."""

    def __init__(self, case):
        self.model = mujoco.MjModel.from_xml_path(case["file"])
        self.data = mujoco.MjData(self.model)
        kind = mujoco.mjtObj.mjOBJ_JOINT
        self.ids = [mujoco.mj_name2id(self.model, kind, name) for name in case["joints"]]
        self.qpos = [self.model.jnt_qposadr[i] for i in self.ids]
        self.dof = [self.model.jnt_dofadr[i] for i in self.ids]


def answer_cases(by_pinocchio, by_mujoco):
    """Prints the answers to the cases of the file named on the command line, null for a case whose
    simulator is not installed. Each function takes a case and its robot."""
    of = {
        ".urdf": (pinocchio, PinocchioRobot, by_pinocchio),
        ".xml": (mujoco, MujocoRobot, by_mujoco),
    }

    def answer(case):
        simulator, robot, by = of[case["file"][case["file"].rindex(".") :]]
        return None if simulator is None else by(case, robot(case))

    with open(sys.argv[1], encoding="utf-8") as file:
        cases = json.load(file)
    json.dump([answer(case) for case in cases], sys.stdout)
