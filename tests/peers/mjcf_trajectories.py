"""Trajectories of exported models in MuJoCo.

    python mjcf_trajectories.py CASES.json

Each case names an MJCF file, start angles of its joints, and the inputs of its actuators, held for
`period_s` each. Prints, per case, the joints' angles at the end of every period, rad.
"""

import json
import sys

import mujoco


def trajectory(case):
    model = mujoco.MjModel.from_xml_path(case["file"])
    data = mujoco.MjData(model)
    data.qpos[:] = case["start_rad"]
    steps = round(case["period_s"] / model.opt.timestep)
    rows = []
    for controls in case["inputs"]:
        data.ctrl[:] = controls
        for _ in range(steps):
            mujoco.mj_step(model, data)
        rows.append(data.qpos.tolist())
    return rows


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        cases = json.load(file)
    json.dump([trajectory(case) for case in cases], sys.stdout)


if __name__ == "__main__":
    main()
