"""Joint accelerations of URDF files by Pinocchio and of MJCF files by MuJoCo.

    python forward_dynamics.py CASES.json

Each case names a file, its joints in the chain's order, and per state the coordinates `q`, speeds
`dq` and torques `tau`. Other joints are locked at zero. Prints, per case and state, the
accelerations in the same order, or null for a case whose simulator is not installed.
"""

from robots import answer_cases, mujoco, pinocchio


def by_mujoco(case, robot):
    model, data = robot.model, robot.data
    rows = []
    for state in case["states"]:
        mujoco.mj_resetData(model, data)
        data.qpos[robot.qpos] = state["q"]
        data.qvel[robot.dof] = state["dq"]
        data.qfrc_applied[robot.dof] = state["tau"]
        mujoco.mj_forward(model, data)
        rows.append(data.qacc[robot.dof].tolist())
    return rows


def by_pinocchio(case, robot):
    rows = []
    for state in case["states"]:
        q, v, tau = robot.pose(state["q"]), robot.speeds(state["dq"]), robot.speeds(state["tau"])
        rows.append(pinocchio.aba(robot.model, robot.data, q, v, tau)[robot.at].tolist())
    return rows


if __name__ == "__main__":
    answer_cases(by_pinocchio, by_mujoco)
