"""Logs of an arm in space with a hidden effect, simulated by MuJoCo, and the model that lacks it.

    python hidden_space.py FOLDER --effects coulomb --seed 3
    python hidden_space.py FOLDER --effects delay@2 --seed 1
    python hidden_space.py FOLDER --effects nothing --seed 1
    python hidden_space.py FOLDER --arm panda --effects coulomb --seed 3
    python hidden_space.py FOLDER --urdf so101.urdf --convention any --seed 1

The arm is a small desk arm of five joints about axes in three directions, one of seven like the
Panda, or the serial arm of a URDF. Its drives regulate their goal: duty = gain * (goal - reading)
up to full duty, torque = stall torque * duty - back-EMF; the Panda's are as much stronger as its
links ask for, and so are friction, rotors and what is hidden in them. Encoders have 4096 steps a
turn; rows come at 50 Hz. Its motions are those of people who record such arms: random targets, each
reached in some time and held for some. Two motions of 20 s to learn from, one held out.

Writes arm.urdf, nominal.toml (what the owner believes: viscous friction up to 30 % off and free,
the hidden effect absent; where damping is hidden, that joint has none), true.toml, the logs, and
truth.json; prints the latter. Equal arguments give equal bytes. The folder must not hold files.

With --convention one motion is to learn from and one held out, dry friction is in the file, too, up
to 30 % off and free, and the log of one joint is written by another convention than the file's,
readings and goals alike, as a calibration does it: reversed, from another zero, in another unit.

Nothing here is taken from the library whose diagnosis is measured: the rigid body, damping,
armature, dry friction and the gap of a gear are MuJoCo's own; drives, delay and encoders are
applied outside of it. A motor behind a gap has a rotor beside the armature that the file has.
"""

import argparse
import dataclasses
import json
import math
import pathlib
import sys

import mujoco
import numpy as np
import space_arm

# At 0.25 ms the step's error of some 3 % made Stribeck friction of dry friction.
STEP_S = 0.05e-3
# What a wrong convention does is far larger.
COARSE_STEP_S = 0.2e-3
SAMPLE_S = 0.02
ROWS = 1000
TICK_RAD = math.tau / 4096
GAIN_PER_RAD = 5.0
NO_LOAD_RAD_S = 6.0
ARMATURE_KG_M2 = 0.02
# Of the servos of small arms. The Panda's drives give up to 87 and 12 N m (its data sheet).
STALL_NM = 2.9
PANDA_STALL_NM = [87.0] * 4 + [12.0] * 3
# A link of the Panda against one of a desk arm.
PANDA_LINKS = 10.0
VISCOUS_NM_S_RAD = (0.05, 0.25)
COULOMB_NM = (0.02, 0.1)


def within(low, high):
    return lambda rng, _: rng.uniform(low, high)


def signed(low, high):
    return lambda rng, sign: sign * rng.uniform(low, high)


# Kind: the joints at which it shows, none for all; its values, of the servo of a small arm.
EFFECTS = {
    "coulomb": (None, {"torque_nm": within(0.06, 0.2)}),
    "viscous": (None, {"coefficient_nm_s_rad": within(0.1, 0.4)}),
    "armature": (None, {"inertia_kg_m2": within(0.01, 0.04)}),
    "delay": (None, {"delay_s": within(0.03, 0.1)}),
    "dead_zone": (None, {"width": within(0.03, 0.1), "punch": within(0.0, 0.0)}),
    "mass": (range(2, 6), {"added_kg": within(0.05, 0.2)}),
    "encoder_zero": (range(2, 5), {"offset_rad": signed(0.04, 0.1)}),
    "torque_saturation": (range(2, 5), {"limit_nm": within(0.5, 0.8)}),
    "gear_backlash": (None, {"inertia_kg_m2": within(0.005, 0.02), "gap_rad": within(0.02, 0.06)}),
}
# Values that are as much larger as the drive is stronger.
OF_THE_DRIVE = ("torque_nm", "inertia_kg_m2", "limit_nm", "coefficient_nm_s_rad")


def stream(seed, number):
    return np.random.default_rng([seed, number])


@dataclasses.dataclass(frozen=True)
class Drives:
    """How strong the drives are, N m, and how heavy the links against a desk arm's."""

    stall_nm: list
    links: float = 1.0

    def share(self, joint):
        """This joint's drive against a small arm's."""
        return self.stall_nm[joint] / STALL_NM

    def back_emf_nm_s_rad(self, joint):
        return self.stall_nm[joint] / NO_LOAD_RAD_S

    def armature_kg_m2(self, joint):
        return ARMATURE_KG_M2 * self.share(joint)


def drawn(word, seed, drives):
    """An effect of this name, its joint and values drawn where the name has none."""
    kind, _, joint = word.partition("@")
    if kind not in EFFECTS:
        sys.exit(f"there is no effect {kind}: {', '.join(EFFECTS)}")
    joints, values = EFFECTS[kind]
    rng = stream(seed, 100 + sorted(EFFECTS).index(kind))
    joints = joints or range(1, len(drives.stall_nm) + 1)
    at = int(joint) if joint else int(rng.choice(list(joints)))
    sign = float(rng.choice([-1.0, 1.0]))
    scale = dict.fromkeys(OF_THE_DRIVE, drives.share(at - 1)) | {"added_kg": drives.links}
    parameters = {
        key: round(float(draw(rng, sign)) * scale.get(key, 1.0), 4) for key, draw in values.items()
    }
    return {"kind": kind, "joint": at, "parameters": parameters}


class Arm:
    """The arm with its friction and what is hidden in it.

    MuJoCo's step is that of the leapfrog: speeds are half a step behind angles. What acts with the
    speed after the step (MuJoCo's damping) leads by half a step, what acts with the one before it
    lags by as much, and either is an inertia of half a step times its coefficient, which is taken
    off or added. Inputs act half a step early, so angles are read half a step back.
    """

    def __init__(self, joints, drives, step_s, friction, effects):
        self.joints = joints
        self.drives = drives
        self.step_s = step_s
        self.viscous = friction["viscous"]
        self.dry = friction.get("coulomb", [0.0] * len(joints))
        self.of = {(e["kind"], e["joint"] - 1): e["parameters"] for e in effects}

    def value(self, kind, joint, key, otherwise=0.0):
        return self.of.get((kind, joint), {}).get(key, otherwise)

    def mjcf(self):
        """Dry friction is a soft constraint: stiff, so that a joint at rest does not creep."""
        head = (
            f'<mujoco>{space_arm.COMPILER}<option timestep="{self.step_s}" gravity="0 0 -9.81" '
            'integrator="implicitfast"/><worldbody>'
        )
        body, gaps = "", ""
        for j, joint in enumerate(self.joints):
            back_emf = self.drives.back_emf_nm_s_rad(j)
            outside = back_emf if self.limit_nm(j) else 0.0
            damping = self.viscous[j] + self.value("viscous", j, "coefficient_nm_s_rad")
            rotor = self.value("gear_backlash", j, "inertia_kg_m2")
            if rotor:
                body += self.rotor(j, rotor, back_emf)
                gaps += self.gap(j)
            else:
                damping += back_emf - outside
            armature = self.drives.armature_kg_m2(j) + self.value("armature", j, "inertia_kg_m2")
            armature -= 0.5 * self.step_s * (damping - outside)
            rub = self.dry[j] + self.value("coulomb", j, "torque_nm")
            body += space_arm.body(
                joint,
                self.value("mass", j, "added_kg"),
                f'damping="{damping}" armature="{armature}" frictionloss="{rub}" '
                f'solreffriction="{2 * self.step_s} 1" solimpfriction="0.9999 0.9999 0.001"',
            )
        ends = "</body>" * len(self.joints) + "</worldbody>"
        return f"{head}{body}{ends}<tendon>{gaps}</tendon></mujoco>"

    def rotor(self, j, inertia_kg_m2, damping):
        """The motor in front of a gap: it turns about its joint's axis beside the link."""
        joint = self.joints[j]
        armature = inertia_kg_m2 - 0.5 * self.step_s * damping
        weightless = dataclasses.replace(
            joint,
            name=f"{joint.name}_rotor",
            mass_kg=1e-9,
            inertia_kg_m2=(1e-12, 1e-12, 1e-12, 0.0, 0.0, 0.0),
        )
        of_joint = f'damping="{damping}" armature="{armature}"'
        return space_arm.body(weightless, 0.0, of_joint) + "</body>"

    def gap(self, j):
        """The flanks between motor and link, stiff, from which neither rebounds."""
        name = self.joints[j].name
        half = 0.5 * self.value("gear_backlash", j, "gap_rad")
        return (
            f'<fixed limited="true" range="{-half} {half}" solreflimit="{2 * self.step_s} 1" '
            f'solimplimit="0.9999 0.9999 0.001"><joint joint="{name}" coef="1"/>'
            f'<joint joint="{name}_rotor" coef="-1"/></fixed>'
        )

    def limit_nm(self, joint):
        return self.value("torque_saturation", joint, "limit_nm")

    def torque_nm(self, joint, goal, angle, speed):
        """What the servo gives; its back-EMF is the joint's damping where nothing limits both."""
        reading = angle + self.value("encoder_zero", joint, "offset_rad")
        duty = min(1.0, max(-1.0, GAIN_PER_RAD * (goal - reading)))
        if abs(duty) <= self.value("dead_zone", joint, "width", -1.0):
            duty = 0.0
        limit = self.limit_nm(joint)
        torque_nm = self.drives.stall_nm[joint] * duty
        if not limit:
            return torque_nm
        return min(limit, max(-limit, torque_nm - self.drives.back_emf_nm_s_rad(joint) * speed))

    def record(self, goals):
        """Readings at each row, rad, of a motion that begins at rest at its first goals."""
        model = mujoco.MjModel.from_xml_string(self.mjcf())
        data = mujoco.MjData(model)
        count, steps = len(self.joints), round(SAMPLE_S / self.step_s)
        late = [round(self.value("delay", j, "delay_s") / self.step_s) for j in range(count)]
        zero = np.array([self.value("encoder_zero", j, "offset_rad") for j in range(count)])
        names = [joint.name for joint in self.joints]
        links = [model.joint(name).dofadr[0] for name in names]
        behind = [("gear_backlash", j) in self.of for j in range(count)]
        driven = [f"{name}_rotor" if gap else name for name, gap in zip(names, behind)]
        motors = [model.joint(name).dofadr[0] for name in driven]
        data.qpos[links] = goals[0] - zero
        data.qpos[motors] = goals[0] - zero

        def step(goals):
            for joint, goal in enumerate(goals):
                angle, speed = data.qpos[links[joint]], data.qvel[links[joint]]
                data.qfrc_applied[motors[joint]] = self.torque_nm(joint, goal, angle, speed)
            mujoco.mj_step(model, data)

        for _ in range(round(2.0 / self.step_s)):
            step(goals[0])
        rows = []
        for at in range(ROWS * steps):
            if at % steps == 0:
                angles = data.qpos[links] - 0.5 * self.step_s * data.qvel[links] + zero
                rows.append(np.round(angles / TICK_RAD) * TICK_RAD)
            step([goals[max(0, at - late[j]) // steps][j] for j in range(count)])
        return np.array(rows)


def reaching(joints, rng):
    """Goals of each row: targets reached on smooth ways, each held for a while."""
    goals = np.zeros((ROWS, len(joints)))
    low = np.array([joint.low_rad for joint in joints])
    high = np.array([joint.high_rad for joint in joints])
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


def convention(word, joints, seed):
    """The joint whose log follows another convention, and what is written of an angle there:
    factor * angle + offset.
    """
    rng = stream(seed, 50)
    kind = str(rng.choice(["sign", "zero", "unit"])) if word == "any" else word
    joint = 1 + int(rng.integers(len(joints)))
    drawn = {"kind": kind, "joint": joint, "factor": 1.0, "offset": 0.0}
    if kind == "sign":
        drawn["factor"] = -1.0
    elif kind == "zero":
        offset_deg = float(rng.uniform(5.0, 90.0)) * float(rng.choice([-1.0, 1.0]))
        drawn["offset"] = round(math.radians(offset_deg), 4)
    else:
        drawn["factor"] = float(rng.choice([180.0 / math.pi, 4096.0 / math.tau]))
    return drawn


# Effects that are part of what the owner's file has, and the value of each.
OWN = {
    "armature": "inertia_kg_m2",
    "viscous": "coefficient_nm_s_rad",
    "coulomb": "torque_nm",
}


def model_toml(joints, drives, friction, effects):
    lines = ["[rig]", 'name = "arm in space"', 'robot = "arm.urdf"', ""]
    for joint, stall_nm in zip(joints, drives.stall_nm):
        lines += [
            "[[joint]]",
            f'name = "{joint.name}"',
            'drive = "position"',
            f"gain_per_rad = {GAIN_PER_RAD}",
            f"stall_torque_nm = {stall_nm}",
            f"no_load_speed_rad_s = {NO_LOAD_RAD_S}",
            "",
        ]
    rotors = [round(drives.armature_kg_m2(j), 4) for j in range(len(joints))]
    own = {"armature": rotors, **friction}
    for kind, values in own.items():
        for joint, value in enumerate(values, start=1):
            if value is None:
                continue
            more = [e for e in effects if (e["kind"], e["joint"]) == (kind, joint)]
            value += sum(e["parameters"][OWN[kind]] for e in more)
            lines += effect_toml(kind, joint, {OWN[kind]: value})
    for effect in effects:
        if effect["kind"] not in own:
            lines += effect_toml(effect["kind"], effect["joint"], effect["parameters"])
    free = ", ".join(
        f'"{kind}@{joint}.{OWN[kind]}"'
        for kind, values in friction.items()
        for joint, value in enumerate(values, start=1)
        if value is not None
    )
    lines += ["[fit]", f"free = [{free}]", "", "[log]"]
    lines += ['time = { column = "time_s", unit = "s" }', ""]
    for joint in joints:
        step = f"resolution_rad = {TICK_RAD:.9f}"
        lines += [
            "[[log.joint]]",
            f'position = {{ column = "{joint.name}.position", unit = "rad", {step} }}',
            f'input = {{ column = "{joint.name}.goal", unit = "rad" }}',
            "",
        ]
    return "\n".join(lines)


def effect_toml(kind, joint, parameters):
    values = [f"{key} = {float(value)!r}" for key, value in parameters.items()]
    return ["[[effect]]", f'kind = "{kind}"', f"joint = {joint}", *values, ""]


def csv(joints, goals, angles):
    head = ["time_s"]
    for joint in joints:
        head += [f"{joint.name}.position", f"{joint.name}.goal"]
    lines = [",".join(head)]
    for row in range(ROWS):
        cells = [f"{row * SAMPLE_S:.2f}"]
        for angle, goal in zip(angles[row], goals[row]):
            cells += [f"{angle:.6f}", f"{goal:.6f}"]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def write(args):
    """The files, and what is true of them."""
    urdf = args.urdf.read_text() if args.urdf else space_arm.urdf_of(args.arm)
    joints = space_arm.joints(urdf)
    drives = Drives([STALL_NM] * len(joints))
    if args.arm == "panda" and not args.urdf:
        drives = Drives(PANDA_STALL_NM, PANDA_LINKS)
    words = [] if args.effects == "nothing" else args.effects.split(",")
    effects = [drawn(word, args.seed, drives) for word in words]
    rng = stream(args.seed, 1)
    off = {"viscous": VISCOUS_NM_S_RAD}
    if args.convention:
        off["coulomb"] = COULOMB_NM
    true, believed = {}, {}
    for kind, bounds in off.items():
        true[kind] = [
            round(float(rng.uniform(*bounds)) * drives.share(j), 4) for j in range(len(joints))
        ]
        believed[kind] = [round(own * float(rng.uniform(0.7, 1.3)), 4) for own in true[kind]]
    for effect in (effect for effect in effects if effect["kind"] in true):
        at = effect["joint"] - 1
        true[effect["kind"]][at], believed[effect["kind"]][at] = 0.0, None
    arm = Arm(joints, drives, COARSE_STEP_S if args.convention else STEP_S, true, effects)

    written = None
    if args.convention not in (None, "file"):
        written = convention(args.convention, joints, args.seed)
    args.folder.mkdir(parents=True, exist_ok=True)
    logs = []
    for number, name in enumerate("ab" if args.convention else "abc"):
        goals = reaching(joints, stream(args.seed, 2 + number))
        angles = arm.record(goals)
        for values in (goals, angles) if written else ():
            at = written["joint"] - 1
            values[:, at] = written["factor"] * values[:, at] + written["offset"]
        (args.folder / f"{name}.csv").write_text(csv(joints, goals, angles))
        logs.append(f"{name}.csv")
    (args.folder / "arm.urdf").write_text(urdf)
    (args.folder / "nominal.toml").write_text(model_toml(joints, drives, believed, []))
    (args.folder / "true.toml").write_text(model_toml(joints, drives, true, effects))
    truth = {
        "seed": args.seed,
        "effects": effects,
        "in_library": True,
        "fit": logs[:-1],
        "held_out": logs[-1:],
    }
    return truth | ({"convention": written} if args.convention else {})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--effects", default="nothing", help="kind[@joint],... or nothing")
    parser.add_argument("--arm", choices=space_arm.ARMS, default="desk")
    parser.add_argument("--urdf", type=pathlib.Path, help="the file of another serial arm")
    parser.add_argument(
        "--convention",
        choices=["any", "sign", "zero", "unit", "file"],
        help="write one joint's log by another convention than the file's; file: by none",
    )
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    if args.folder.is_dir() and any(args.folder.iterdir()):
        sys.exit(f"{args.folder} holds files: name a new folder, nothing is overwritten")
    truth = write(args)
    text = json.dumps(truth, indent=1)
    (args.folder / "truth.json").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
