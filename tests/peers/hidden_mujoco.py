"""Logs of a rig with hidden effects, simulated by MuJoCo, and the model that lacks them.

    python hidden_mujoco.py FOLDER --motions arm --effects delay --seed 3
    python hidden_mujoco.py FOLDER --motions balancing --effects coulomb@1,mass@3 --seed 1
    python hidden_mujoco.py FOLDER --motions arm --effects nothing --seed 1

Rigs: `arm` is one driven link, two motions to learn from and one held out; `hanging` three links,
of which the second and the third are driven, likewise; `balancing` the same three hanging motions
and two more of the robot balanced upright on its bar, one to learn from, one held out. Every
motion lasts 20 s.

Writes nominal.toml (what the owner believes: friction values up to 30 % off, the hidden effects
absent), true.toml (what the library can say of the truth; absent where an effect is outside of
it), the logs, and truth.json; prints the latter. Equal arguments give equal bytes. The folder
must not hold files.

An effect that would make the rig fall is drawn smaller until it does not.
"""

import argparse
import json
import math
import pathlib
import sys

import numpy as np

from hidden_motion import balance, hang
from hidden_rig import ENCODER_RAD, GRAVITY_M_S2, GYRO_RAD_S, OF_GYRO, PAYLOAD_AT_M, Rig

SUPPLY_V = 9.8
ARM_STALL_NM = 1.5
ROBOT_STALL_NM = 3.0
SECONDS = 20.0
# Length, centre of mass, mass, inertia: arms, torso with head, legs.
ROBOT = [
    (0.1436, 0.0687, 0.3676, 7890.7e-7),
    (0.1158, 0.0575, 0.9815, 32898.6e-7),
    (0.1840, 0.1163, 0.5764, 11328.0e-7),
]
# N m/rad, N m s/rad and the weight's torque that is held, N m, of shoulder and hip.
ROBOT_GAINS = [(1.6, 0.12, 0.9), (0.8, 0.05, 0.4)]

ANY, DRIVEN, WHOLE = "any", "driven", "whole"


def within(low, high):
    return lambda rng, _: rng.uniform(low, high)


def signed(low, high):
    return lambda rng, sign: sign * rng.uniform(low, high)


def factor(low, high):
    return lambda rng, sign: 1.0 + sign * rng.uniform(low, high)


# Kind: where it acts, its values (how each is drawn at the arm, and at the robot), whether the
# library has it.
EFFECTS = {
    "viscous": (ANY, {"coefficient_nm_s_rad": (within(0.01, 0.04), within(0.01, 0.04))}),
    "coulomb": (ANY, {"torque_nm": (within(0.02, 0.06), within(0.02, 0.06))}),
    "stribeck": (
        ANY,
        {
            "excess_nm": (within(0.02, 0.06), within(0.03, 0.08)),
            "speed_rad_s": (within(0.1, 0.5), within(0.1, 0.5)),
        },
    ),
    "direction_asymmetry": (
        DRIVEN,
        {"half_difference_nm": (signed(0.008, 0.02), signed(0.008, 0.02))},
    ),
    "dead_zone": (
        DRIVEN,
        {
            "width": (within(0.03, 0.08), within(0.02, 0.05)),
            "punch": (within(0.0, 0.0), within(0.0, 0.0)),
        },
    ),
    "backlash": (ANY, {"gap_rad": (within(0.03, 0.1), within(0.03, 0.1))}),
    "delay": (DRIVEN, {"delay_s": (within(0.02, 0.08), within(0.008, 0.03))}),
    "supply_sensitivity": (DRIVEN, {"sensitivity": (within(0.6, 1.2), within(0.6, 1.2))}),
    "supply_sag": (DRIVEN, {"drop_share": (within(0.15, 0.4), within(0.2, 0.5))}),
    "torque_saturation": (DRIVEN, {"limit_nm": (within(0.2, 0.4), within(0.4, 0.8))}),
    "speed_limit": (DRIVEN, {"no_load_speed_rad_s": (within(6.0, 15.0), within(6.0, 15.0))}),
    "com_angle": (ANY, {"angle_rad": (signed(0.05, 0.15), signed(0.05, 0.15))}),
    "mass": (ANY, {"added_kg": (signed(0.03, 0.08), signed(0.05, 0.15))}),
    "armature": (ANY, {"inertia_kg_m2": (within(5e-4, 2e-3), within(1e-3, 4e-3))}),
    "cable_spring": (
        ANY,
        {
            "stiffness_nm_rad": (within(0.03, 0.15), within(0.1, 0.4)),
            "rest_angle_rad": (within(-0.5, 0.5), within(-0.5, 0.5)),
        },
    ),
    "base_tilt": (WHOLE, {"angle_rad": (signed(0.05, 0.15), signed(0.05, 0.15))}),
    "air_drag": (ANY, {"coefficient_nm_s2_rad2": (within(0.001, 0.004), within(0.002, 0.008))}),
    "encoder_zero": (ANY, {"offset_rad": (signed(0.03, 0.1), signed(0.03, 0.1))}),
    "encoder_scale": (ANY, {"factor": (factor(0.02, 0.06), factor(0.02, 0.06))}),
    "sensor_lag": (ANY, {"time_constant_s": (within(0.02, 0.06), within(0.02, 0.06))}),
    "cogging": (
        DRIVEN,
        {
            "amplitude_nm": (within(0.01, 0.03), within(0.03, 0.08)),
            "periods_per_turn": (lambda rng, _: math.floor(rng.uniform(6.0, 25.0)),) * 2,
            "phase_rad": (within(-math.pi, math.pi),) * 2,
        },
    ),
    "torque_scale": (DRIVEN, {"factor": (factor(0.08, 0.25), factor(0.08, 0.25))}),
    "slew_limit": (DRIVEN, {"rate_per_s": (within(0.6, 2.0), within(0.6, 2.0))}),
    "thermal_drift": (
        DRIVEN,
        {
            "rise": (within(10.0, 30.0), within(10.0, 30.0)),
            "time_constant_s": (within(4.0, 12.0), within(4.0, 12.0)),
        },
    ),
    "fold_back": (
        DRIVEN,
        {
            "remaining_share": (within(0.3, 0.7), within(0.3, 0.7)),
            "level": (within(0.06, 0.12), within(0.06, 0.12)),
            "after_s": (within(0.15, 0.4), within(0.15, 0.4)),
        },
    ),
    "pre_sliding": (
        ANY,
        {
            "torque_nm": (within(0.02, 0.06), within(0.03, 0.08)),
            "stiffness_nm_rad": (within(0.3, 1.5), within(0.5, 2.0)),
        },
    ),
    "gear_compliance": (
        DRIVEN,
        {
            "inertia_kg_m2": (within(1e-3, 3e-3), within(1e-3, 3e-3)),
            "stiffness_nm_rad": (within(0.5, 2.0), within(4.0, 12.0)),
            "damping_ratio": (within(0.05, 0.25), within(0.05, 0.25)),
        },
    ),
    "gear_backlash": (
        DRIVEN,
        {
            "inertia_kg_m2": (within(1e-3, 3e-3), within(1e-3, 3e-3)),
            "gap_rad": (within(0.03, 0.12), within(0.02, 0.06)),
        },
    ),
    "torque_offset": (ANY, {"offset_nm": (signed(0.01, 0.04), signed(0.02, 0.06))}),
    "position_friction": (
        ANY,
        {
            "below_nm": (within(0.02, 0.06), within(0.03, 0.08)),
            "above_nm": (within(0.0, 0.02), within(0.0, 0.02)),
            "span_rad": (within(0.4, 1.0), within(0.4, 1.0)),
        },
    ),
    "base_compliance": (
        WHOLE,
        {
            "stiffness_n_m": (within(60.0, 200.0), within(500.0, 2000.0)),
            "mass_kg": (within(0.2, 0.6), within(0.5, 2.0)),
            "damping_ratio": (within(0.05, 0.25), within(0.05, 0.25)),
        },
    ),
    "grip_slip": (ANY, {"acceleration_rad_s2": (within(40.0, 100.0), within(40.0, 100.0))}),
    "time_offset": (ANY, {"offset_s": (signed(0.01, 0.03), signed(0.01, 0.03))}),
    "rate_bias": (ANY, {"bias_rad_s": (signed(0.01, 0.05), signed(0.01, 0.05))}),
    "rate_scale": (ANY, {"factor": (factor(0.02, 0.06), factor(0.02, 0.06))}),
    "rate_lag": (ANY, {"time_constant_s": (within(0.005, 0.03), within(0.005, 0.03))}),
}

OUTSIDE = {
    # Magnets that hold the joint at an angle.
    "position_trap": (
        ANY,
        {
            "peak_nm": (within(0.03, 0.08), within(0.1, 0.25)),
            "at_rad": (within(-0.4, 0.4), within(-0.4, 0.4)),
            "width_rad": (within(0.08, 0.15), within(0.08, 0.15)),
        },
    ),
    # -k q^2: a bent cable that pulls to one side.
    "quadratic_stiffness": (ANY, {"stiffness_nm_rad2": (signed(0.04, 0.12), signed(0.1, 0.4))}),
    # A cable that creeps: spring and damper in series.
    "viscoelastic": (
        ANY,
        {
            "stiffness_nm_rad": (within(0.04, 0.1), within(0.2, 0.6)),
            "time_constant_s": (within(0.15, 0.5), within(0.15, 0.5)),
        },
    ),
    # Something that dangles from the end of the last link.
    "hidden_pendulum": ("last", {"mass_kg": (within(0.03, 0.06), within(0.08, 0.15))}),
    # A part that rubs within a range of angles only.
    "rub": (
        ANY,
        {
            "torque_nm": (within(0.04, 0.08), within(0.06, 0.15)),
            "at_rad": (within(-0.2, 0.2), within(-0.2, 0.2)),
            "half_width_rad": (within(0.1, 0.2), within(0.1, 0.2)),
        },
    ),
    # Friction of cold grease, gone after some seconds.
    "warm_up": (
        ANY,
        {
            "torque_nm": (within(0.05, 0.1), within(0.06, 0.15)),
            "time_constant_s": (within(3.0, 8.0), within(3.0, 8.0)),
        },
    ),
}


def stream(seed, *purpose):
    """Independent random numbers for each purpose: one seed is one rig whatever it hides."""
    return np.random.default_rng([seed, *purpose])


def parsed(text, robot, seed):
    """The effects of `--effects`, their values drawn."""
    known = {**EFFECTS, **OUTSIDE}
    places = list(known)
    effects = []
    for word in [] if text == "nothing" else text.split(","):
        kind, _, joint = word.partition("@")
        if kind not in known:
            sys.exit(f"--effects {word}: no such effect; known are {', '.join(known)}")
        scope, keys = known[kind]
        rng = stream(seed, 100 + places.index(kind))
        joints = {ANY: [1, 2, 3], DRIVEN: [2, 3], "last": [3]}.get(scope) if robot else [1]
        drawn = joints[rng.integers(len(joints))] if joints else None
        sign = rng.choice([-1.0, 1.0])
        effects.append(
            {
                "kind": kind,
                "joint": None if scope == WHOLE else int(joint) if joint else drawn,
                "parameters": {
                    key: round(float(draw[robot](rng, sign)), 6) for key, draw in keys.items()
                },
            }
        )
        if kind == "delay":
            # In whole steps of the simulation.
            delay = effects[-1]["parameters"]
            delay["delay_s"] = round(round(delay["delay_s"] / 0.25e-3) * 0.25e-3, 6)
    return effects


def weaker(effect):
    """The same effect at four fifths of its strength, or nearer to what the rig bears."""
    values = dict(effect["parameters"])
    keys = {"limit_nm": 1.25, "no_load_speed_rad_s": 1.25, "acceleration_rad_s2": 1.25}
    if effect["kind"] == "base_compliance":
        keys |= {"stiffness_n_m": 1.25, "mass_kg": 1.0}
    for key in values:
        if key in ("factor",):
            values[key] = round(1.0 + 0.8 * (values[key] - 1.0), 6)
        elif key == "delay_s":
            values[key] = round(round(0.8 * values[key] / 0.25e-3) * 0.25e-3, 6)
        elif key not in (
            "punch speed_rad_s rest_angle_rad periods_per_turn phase_rad at_rad width_rad from_rad"
            " time_constant_s damping_ratio"
        ).split() or effect["kind"] == "sensor_lag":
            values[key] = round(keys.get(key, 0.8) * values[key], 6)
    return {**effect, "parameters": values}


class Bench:
    """A rig, what is hidden in it, and what its owner believes."""

    def __init__(self, motions, effects, seed):
        self.motions, self.effects = motions, effects
        self.robot = motions != "arm"
        rng = stream(seed, 1)
        if self.robot:
            self.links, self.stall_nm = ROBOT, [None, ROBOT_STALL_NM, ROBOT_STALL_NM]
            ranges = [None, (0.01, 0.03, 0.02, 0.05), (0.01, 0.03, 0.02, 0.05)]
        else:
            com, mass = rng.uniform(0.08, 0.1), rng.uniform(0.21, 0.29)
            inertia = rng.uniform(4.8e-4, 7.2e-4)
            self.links = [(0.15, round(com, 4), round(mass, 4), round(inertia, 7))]
            self.stall_nm, ranges = [ARM_STALL_NM], [(0.008, 0.02, 0.015, 0.035)]
        self.friction, self.believed = [], []
        for joint, span in enumerate(ranges, start=1):
            true, believed = [0.0, 0.0], [0.0, 0.0]
            for place, kind in enumerate(("viscous", "coulomb")):
                if span is None or any((e["kind"], e["joint"]) == (kind, joint) for e in effects):
                    continue
                value = rng.uniform(*span[2 * place : 2 * place + 2])
                true[place] = round(value, 5)
                believed[place] = round(value * rng.uniform(0.7, 1.3), 4)
            self.friction.append(tuple(true))
            self.believed.append(tuple(believed))
        for effect in effects:
            # Friction that differs by direction is friction in both: never less than none.
            if effect["kind"] == "direction_asymmetry":
                most = 0.8 * self.friction[effect["joint"] - 1][1]
                half = effect["parameters"]["half_difference_nm"]
                half = math.copysign(min(abs(half), most), half)
                effect["parameters"]["half_difference_nm"] = round(half, 6)

    def rig(self, mount):
        return Rig(self.links, self.stall_nm, SUPPLY_V, self.friction, self.effects, mount)

    def toml(self, friction, effects):
        lines = [
            "[rig]",
            f'name = "{"robot on a bar" if self.robot else "bench arm"}"',
            'angle_zero = "hanging"',
            f"gravity_m_s2 = {GRAVITY_M_S2}",
        ]
        for length, com, mass, inertia in self.links:
            lines += ["", "[[link]]", f"length_m = {length!r}", f"com_m = {com!r}"]
            lines += [f"mass_kg = {mass!r}", f"inertia_kg_m2 = {inertia!r}"]
        for stall in self.stall_nm:
            lines += ["", "[[joint]]"]
            if stall is None:
                lines.append('drive = "passive"')
                continue
            lines += ['drive = "duty"', f"stall_torque_nm = {stall!r}"]
            lines.append(f"nominal_supply_v = {SUPPLY_V!r}")
        for joint, (viscous, coulomb) in enumerate(friction, start=1):
            for kind, key, value in (
                ("viscous", "coefficient_nm_s_rad", viscous),
                ("coulomb", "torque_nm", coulomb),
            ):
                if value > 0.0:
                    lines += effect_toml(kind, joint, {key: value})
        for effect in effects:
            lines += effect_toml(effect["kind"], effect["joint"], effect["parameters"])
        payload = f'{{ column = "payload_kg", unit = "kg", at_m = {PAYLOAD_AT_M} }}'
        lines += [
            "",
            "[log]",
            'time = { column = "time_s", unit = "s" }',
            'supply = { column = "supply_v", unit = "V" }',
            'torque_on = "torque_on"',
            f"payload = {payload}",
            'turned = "turned"',
        ]
        for joint, stall in enumerate(self.stall_nm, start=1):
            step = f"resolution_rad = {ENCODER_RAD:.7f}"
            lines += ["", "[[log.joint]]"]
            lines.append(f'position = {{ column = "q{joint}_rad", unit = "rad", {step} }}')
            if stall is not None:
                lines.append(f'input = {{ column = "duty{joint}", unit = "1" }}')
            if any((e["kind"] in OF_GYRO, e["joint"]) == (True, joint) for e in self.effects):
                step = f"resolution_rad_s = {GYRO_RAD_S}"
                lines.append(f'gyro = {{ column = "gyro{joint}_rad_s", unit = "rad/s", {step} }}')
        return "\n".join(lines) + "\n"

    def gains(self, mount):
        if self.robot:
            return ROBOT_GAINS
        _, com, mass, inertia = self.links[0]
        whole = inertia + mass * com**2 + mount[0] * PAYLOAD_AT_M**2
        weight = GRAVITY_M_S2 * (mass * com + mount[0] * PAYLOAD_AT_M)
        return [(130.0 * whole, 10.0 * whole, weight)]

    def record(self, seed):
        """Name, recording and whether it is held out, of every motion; None where it falls."""
        rng = stream(seed, 2)
        heavy = 0.0 if self.robot else round(float(rng.uniform(0.08, 0.12)), 3)
        light = 0.0 if self.robot else 0.05
        balancing = []
        for k in range(2 if self.motions == "balancing" else 0):
            recording = balance(self.rig((0.0, False)), stream(seed, 10 + k), SECONDS)
            if recording is None:
                return None
            balancing.append((f"balancing_{'ab'[k]}", recording, k == 1))
        logs = []
        for k, mount in enumerate([(0.0, False), (heavy, True), (light, False)]):
            recording = hang(self.rig(mount), self.gains(mount), stream(seed, 3 + k), SECONDS)
            logs.append((f"hanging_{'abc'[k]}" if self.robot else "abc"[k], recording, k == 2))
        return logs + balancing


def effect_toml(kind, joint, parameters):
    lines = ["", "[[effect]]", f'kind = "{kind}"']
    if joint is not None:
        lines.append(f"joint = {joint}")
    return lines + [f"{key} = {float(value)!r}" for key, value in parameters.items()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--motions", choices=["arm", "hanging", "balancing"], default="arm")
    parser.add_argument("--effects", default="nothing", help="kind[@joint],... or nothing")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    if args.folder.is_dir() and any(args.folder.iterdir()):
        sys.exit(f"{args.folder} holds files: name a new folder, nothing is overwritten")
    effects = parsed(args.effects, args.motions != "arm", args.seed)
    for _ in range(15):
        bench = Bench(args.motions, effects, args.seed)
        logs = bench.record(args.seed)
        if logs is not None:
            break
        effects = [weaker(effect) for effect in effects]
    else:
        sys.exit(f"{args.effects}, seed {args.seed}: the rig falls however weak the effects are")

    args.folder.mkdir(parents=True, exist_ok=True)
    driven = [j for j, stall in enumerate(bench.stall_nm) if stall is not None]
    for name, recording, _ in logs:
        (args.folder / f"{name}.csv").write_text(recording.csv(driven))
    inside = [e for e in effects if e["kind"] in EFFECTS]
    (args.folder / "nominal.toml").write_text(bench.toml(bench.believed, []))
    if len(inside) == len(effects):
        (args.folder / "true.toml").write_text(bench.toml(bench.friction, effects))
    truth = {
        "seed": args.seed,
        "effects": effects,
        "in_library": len(inside) == len(effects),
        "fit": [f"{name}.csv" for name, _, held_out in logs if not held_out],
        "held_out": [f"{name}.csv" for name, _, held_out in logs if held_out],
    }
    text = json.dumps(truth, indent=1)
    (args.folder / "truth.json").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
