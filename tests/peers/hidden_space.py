"""Logs of an arm in space with a hidden effect, simulated by MuJoCo, and the model that lacks it.

    python hidden_space.py FOLDER --effects coulomb --seed 3
    python hidden_space.py FOLDER --effects delay@2 --seed 1
    python hidden_space.py FOLDER --effects nothing --seed 1

The arm has five joints about axes in three directions, the masses of a small desk arm and servos
that regulate their goal: duty = gain * (goal - reading) up to full duty, torque = stall torque *
duty - back-EMF. Encoders have 4096 steps a turn; rows come at 50 Hz. Its motions are those of
people who record such arms: random targets, each reached in some time and held for some. Two
motions of 20 s to learn from, one held out.

Writes arm.urdf, nominal.toml (what the owner believes: viscous friction up to 30 % off and free,
the hidden effect absent), true.toml, the logs, and truth.json; prints the latter. Equal arguments
give equal bytes. The folder must not hold files.

Nothing here is taken from the library whose diagnosis is measured: the rigid body, damping,
armature and dry friction are MuJoCo's own; drives, delay and encoders are applied outside of it.
"""

import argparse
import json
import math
import pathlib
import sys

import mujoco
import numpy as np

# At 0.25 ms the step's error of some 3 % made Stribeck friction of dry friction.
STEP_S = 0.05e-3
SAMPLE_S = 0.02
STEPS = round(SAMPLE_S / STEP_S)
ROWS = 1000
TICK_RAD = math.tau / 4096
GAIN_PER_RAD = 5.0
STALL_NM = 2.9
NO_LOAD_RAD_S = 6.0
BACK_EMF_NM_S_RAD = STALL_NM / NO_LOAD_RAD_S
ARMATURE_KG_M2 = 0.02
VISCOUS_NM_S_RAD = (0.05, 0.25)

# Moments of the two long links, kg m^2.
LONG = (4e-5, 2e-4, 2e-4)
# Joint; where it stands in the link before, m; its axis; its range, rad; its link's centre of mass,
# m, mass, kg, and moments about the axes through it, kg m^2.
JOINTS = [
    ("pan", (0, 0, 0.06), (0, 0, 1), (-1.6, 1.6), (0.01, 0, 0.03), 0.12, (6e-5, 7e-5, 5e-5)),
    ("lift", (0.03, 0, 0.055), (0, 1, 0), (-0.9, 1.1), (0.09, 0.01, 0.02), 0.11, LONG),
    ("elbow", (0.113, 0, 0.028), (0, 1, 0), (-1.2, 1.2), (0.08, 0, 0.01), 0.1, LONG),
    ("wrist", (0.135, 0, 0.005), (0, 1, 0), (-1.4, 1.4), (0.04, 0.01, 0), 0.09, (3e-5, 6e-5, 6e-5)),
    ("roll", (0.061, 0, 0), (1, 0, 0), (-2.4, 2.4), (0.05, 0, 0.015), 0.12, (6e-5, 1e-4, 9e-5)),
]


def within(low, high):
    return lambda rng, _: rng.uniform(low, high)


def signed(low, high):
    return lambda rng, sign: sign * rng.uniform(low, high)


# Kind: the joints at which it shows, its values.
ANY = range(1, 6)
EFFECTS = {
    "coulomb": (ANY, {"torque_nm": within(0.06, 0.2)}),
    "armature": (ANY, {"inertia_kg_m2": within(0.01, 0.04)}),
    "delay": (ANY, {"delay_s": within(0.03, 0.1)}),
    "dead_zone": (ANY, {"width": within(0.03, 0.1), "punch": within(0.0, 0.0)}),
    "mass": (range(2, 6), {"added_kg": within(0.05, 0.2)}),
    "encoder_zero": (range(2, 5), {"offset_rad": signed(0.04, 0.1)}),
    "torque_saturation": (range(2, 5), {"limit_nm": within(0.5, 0.8)}),
}


def stream(seed, number):
    return np.random.default_rng([seed, number])


def drawn(word, seed):
    """An effect of this name, its joint and values drawn where the name has none."""
    kind, _, joint = word.partition("@")
    if kind not in EFFECTS:
        sys.exit(f"there is no effect {kind}: {', '.join(EFFECTS)}")
    joints, values = EFFECTS[kind]
    rng = stream(seed, 100 + sorted(EFFECTS).index(kind))
    at = int(joint) if joint else int(rng.choice(list(joints)))
    sign = float(rng.choice([-1.0, 1.0]))
    parameters = {key: round(float(draw(rng, sign)), 4) for key, draw in values.items()}
    return {"kind": kind, "joint": at, "parameters": parameters}


def urdf():
    lines = ['<robot name="desk_arm">', '<link name="base"/>']
    for name, _, _, _, com, mass, (x, y, z) in JOINTS:
        lines += [
            f'<link name="{name}_link"><inertial><origin xyz="{com[0]} {com[1]} {com[2]}"/>',
            f'<mass value="{mass}"/><inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0"',
            'iyz="0"/></inertial></link>',
        ]
    before = "base"
    for name, at, axis, (low, high), *_ in JOINTS:
        lines += [
            f'<joint name="{name}" type="revolute"><parent link="{before}"/>',
            f'<child link="{name}_link"/><origin xyz="{at[0]} {at[1]} {at[2]}"/>',
            f'<axis xyz="{axis[0]} {axis[1]} {axis[2]}"/>',
            f'<limit lower="{low}" upper="{high}" effort="10" velocity="10"/></joint>',
        ]
        before = f"{name}_link"
    return "\n".join(lines + ["</robot>"]) + "\n"


class Arm:
    """The arm with its friction and what is hidden in it."""

    def __init__(self, viscous, effects):
        self.viscous = viscous
        self.of = {(e["kind"], e["joint"] - 1): e["parameters"] for e in effects}

    def value(self, kind, joint, key, otherwise=0.0):
        return self.of.get((kind, joint), {}).get(key, otherwise)

    def mjcf(self):
        """Dry friction is a soft constraint: stiff, so that a joint at rest does not creep."""
        head = (
            f'<mujoco><compiler angle="radian"/><option timestep="{STEP_S}" gravity="0 0 -9.81" '
            'integrator="implicitfast"/><worldbody>'
        )
        body = ""
        for j, (name, at, axis, _, com, mass, inertia) in enumerate(JOINTS):
            added = self.value("mass", j, "added_kg")
            share = (mass + added) / mass
            armature = ARMATURE_KG_M2 + self.value("armature", j, "inertia_kg_m2")
            damping = self.viscous[j] + (0.0 if self.limit_nm(j) else BACK_EMF_NM_S_RAD)
            rub = self.value("coulomb", j, "torque_nm")
            body += (
                f'<body name="{name}_link" pos="{at[0]} {at[1]} {at[2]}">'
                f'<inertial pos="{com[0]} {com[1]} {com[2]}" mass="{mass * share}" '
                f'diaginertia="{inertia[0] * share} {inertia[1] * share} {inertia[2] * share}"/>'
                f'<joint name="{name}" axis="{axis[0]} {axis[1]} {axis[2]}" damping="{damping}" '
                f'armature="{armature}" frictionloss="{rub}" '
                f'solreffriction="{2 * STEP_S} 1" solimpfriction="0.9999 0.9999 0.001"/>'
            )
        return head + body + "</body>" * len(JOINTS) + "</worldbody></mujoco>"

    def limit_nm(self, joint):
        return self.value("torque_saturation", joint, "limit_nm")

    def torque_nm(self, joint, goal, angle, speed):
        """What the servo gives; its back-EMF is the joint's damping where nothing limits both."""
        reading = angle + self.value("encoder_zero", joint, "offset_rad")
        duty = min(1.0, max(-1.0, GAIN_PER_RAD * (goal - reading)))
        if abs(duty) <= self.value("dead_zone", joint, "width", -1.0):
            duty = 0.0
        limit = self.limit_nm(joint)
        if not limit:
            return STALL_NM * duty
        return min(limit, max(-limit, STALL_NM * duty - BACK_EMF_NM_S_RAD * speed))

    def record(self, goals):
        """Readings at each row, rad, of a motion that begins at rest at its first goals."""
        model = mujoco.MjModel.from_xml_string(self.mjcf())
        data = mujoco.MjData(model)
        count = len(JOINTS)
        late = [round(self.value("delay", j, "delay_s") / STEP_S) for j in range(count)]
        zero = [self.value("encoder_zero", j, "offset_rad") for j in range(count)]
        data.qpos[:] = goals[0] - zero
        for step in range(round(2.0 / STEP_S)):
            self.push(data, goals[0])
            mujoco.mj_step(model, data)
        rows = []
        for step in range(ROWS * STEPS):
            if step % STEPS == 0:
                rows.append(np.round((data.qpos + zero) / TICK_RAD) * TICK_RAD)
            heard = [goals[max(0, step - late[j]) // STEPS][j] for j in range(count)]
            self.push(data, heard)
            mujoco.mj_step(model, data)
        return np.array(rows)

    def push(self, data, goals):
        for joint, goal in enumerate(goals):
            angle, speed = data.qpos[joint], data.qvel[joint]
            data.qfrc_applied[joint] = self.torque_nm(joint, goal, angle, speed)


def reaching(rng):
    """Goals of each row: targets reached on smooth ways, each held for a while."""
    goals = np.zeros((ROWS, len(JOINTS)))
    low = np.array([joint[3][0] for joint in JOINTS])
    high = np.array([joint[3][1] for joint in JOINTS])
    here, row = rng.uniform(0.5 * low, 0.5 * high), 0
    while row < ROWS:
        there = rng.uniform(low, high)
        way, rest = rng.integers(20, 60), rng.integers(5, 25)
        s = np.minimum(1.0, np.arange(1, way + rest + 1) / way)
        smooth = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        part = here + smooth[:, None] * (there - here)
        end = min(ROWS, row + len(part))
        goals[row:end] = part[: end - row]
        here, row = there, end
    return np.round(goals / TICK_RAD) * TICK_RAD


def model_toml(viscous, effects):
    lines = ["[rig]", 'name = "desk arm"', 'robot = "arm.urdf"', ""]
    for name, *_ in JOINTS:
        lines += [
            "[[joint]]",
            f'name = "{name}"',
            'drive = "position"',
            f"gain_per_rad = {GAIN_PER_RAD}",
            f"stall_torque_nm = {STALL_NM}",
            f"no_load_speed_rad_s = {NO_LOAD_RAD_S}",
            "",
        ]
    own = [("armature", "inertia_kg_m2", [ARMATURE_KG_M2] * len(JOINTS))]
    own.append(("viscous", "coefficient_nm_s_rad", viscous))
    for kind, key, values in own:
        for joint, value in enumerate(values, start=1):
            more = [e for e in effects if (e["kind"], e["joint"]) == (kind, joint)]
            value += sum(e["parameters"][key] for e in more)
            lines += effect_toml(kind, joint, {key: value})
    for effect in effects:
        if effect["kind"] not in ("armature", "viscous"):
            lines += effect_toml(effect["kind"], effect["joint"], effect["parameters"])
    free = ", ".join(f'"viscous@{joint + 1}.coefficient_nm_s_rad"' for joint in range(len(JOINTS)))
    lines += ["[fit]", f"free = [{free}]", "", "[log]"]
    lines += ['time = { column = "time_s", unit = "s" }', ""]
    for name, *_ in JOINTS:
        step = f"resolution_rad = {TICK_RAD:.9f}"
        lines += [
            "[[log.joint]]",
            f'position = {{ column = "{name}.position", unit = "rad", {step} }}',
            f'input = {{ column = "{name}.goal", unit = "rad" }}',
            "",
        ]
    return "\n".join(lines)


def effect_toml(kind, joint, parameters):
    values = [f"{key} = {float(value)!r}" for key, value in parameters.items()]
    return ["[[effect]]", f'kind = "{kind}"', f"joint = {joint}", *values, ""]


def csv(goals, angles):
    head = ["time_s"]
    for name, *_ in JOINTS:
        head += [f"{name}.position", f"{name}.goal"]
    lines = [",".join(head)]
    for row in range(ROWS):
        cells = [f"{row * SAMPLE_S:.2f}"]
        for angle, goal in zip(angles[row], goals[row]):
            cells += [f"{angle:.6f}", f"{goal:.6f}"]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--effects", default="nothing", help="kind[@joint],... or nothing")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    if args.folder.is_dir() and any(args.folder.iterdir()):
        sys.exit(f"{args.folder} holds files: name a new folder, nothing is overwritten")
    words = [] if args.effects == "nothing" else args.effects.split(",")
    effects = [drawn(word, args.seed) for word in words]
    rng = stream(args.seed, 1)
    viscous = [round(float(rng.uniform(*VISCOUS_NM_S_RAD)), 4) for _ in JOINTS]
    believed = [round(own * float(rng.uniform(0.7, 1.3)), 4) for own in viscous]
    arm = Arm(viscous, effects)

    args.folder.mkdir(parents=True, exist_ok=True)
    logs = []
    for number, name in enumerate("abc"):
        goals = reaching(stream(args.seed, 2 + number))
        (args.folder / f"{name}.csv").write_text(csv(goals, arm.record(goals)))
        logs.append(f"{name}.csv")
    (args.folder / "arm.urdf").write_text(urdf())
    (args.folder / "nominal.toml").write_text(model_toml(believed, []))
    (args.folder / "true.toml").write_text(model_toml(viscous, effects))
    truth = {
        "seed": args.seed,
        "effects": effects,
        "in_library": True,
        "fit": logs[:2],
        "held_out": logs[2:],
    }
    text = json.dumps(truth, indent=1)
    (args.folder / "truth.json").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
