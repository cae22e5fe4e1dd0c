"""A planar chain with drives, encoders and physical effects, simulated by MuJoCo.

Every quantity is SI. The chain moves in the x-y plane; at angle 0 every link hangs along -y;
joint angles are relative to the link before and counter-clockwise. Nothing here is taken from
the library whose diagnosis is measured: masses, gravity, damping, armature, springs, dry
friction, torque limits and back-EMF are MuJoCo's own; dead zone, delay, supply and encoder are
applied outside of it.

MuJoCo's dry friction is a soft constraint: with its defaults a joint at rest creeps. Here its
time constant is two steps and its impedance 0.9999, so that the torque reaches its limit at
some mrad/s and a loaded joint at rest creeps by less than 1e-6 rad/s: Coulomb's law to within
the encoder's steps.
"""

import math

import mujoco
import numpy as np

# At 0.25 ms the step's error moved a gyro's scale, a lag and a grip by two to eight standard
# deviations of their estimates; of the nine worst the largest is 2.7 now.
STEP_S = 0.05e-3
SAMPLE_S = 0.01
STEPS = round(SAMPLE_S / STEP_S)
GRAVITY_M_S2 = 9.81
ENCODER_RAD = math.radians(300.0) / 1024
PAYLOAD_AT_M = 0.15
# Steps of a gyro, and the standard deviation of its white noise, rad/s.
GYRO_RAD_S = 0.01
# Kinds that are hidden in a gyro: a link has one where one of them is hidden.
OF_GYRO = ("rate_bias", "rate_scale", "rate_lag")
# Length of a hidden pendulum, m, and its damping, N m s/rad.
PENDULUM = (0.05, 2e-5)
# In what time the flanks of a gear with play bring motor and joint to one speed, s.
FLANKS_S = 0.002
# Effects that have a derivative at rest and act on the motion, not on what is read of it.
LINEAR = (
    "viscous base_tilt com_angle mass armature cable_spring delay torque_scale speed_limit"
).split()


class Rig:
    """One rig with its effects under one mount.

    links: rows of length, centre of mass, mass, inertia about it. stall_nm: per joint, torque at
    full duty, None for a passive joint. friction: per joint (viscous, Coulomb). effects: dicts
    with kind, joint (from 1, None for the whole rig) and parameters.
    """

    def __init__(self, links, stall_nm, nominal_supply_v, friction, effects, mount):
        self.n = len(links)
        self.made_of = (links, stall_nm, nominal_supply_v, friction, effects, mount)
        self.stall_nm = stall_nm
        self.nominal_supply_v = nominal_supply_v
        self.payload_kg, self.turned = mount
        self.by_joint = [[] for _ in links]
        self.tilt = 0.0
        self.base = None
        self.first = 0
        for effect in effects:
            values = effect["parameters"]
            if effect["kind"] == "base_tilt":
                self.tilt += values["angle_rad"]
            elif effect["kind"] == "base_compliance":
                self.base = values
                # Its two slides come before the joints in MuJoCo's arrays.
                self.first = 2
            else:
                self.by_joint[effect["joint"] - 1].append((effect["kind"], values))
        self.friction = friction
        self.model = mujoco.MjModel.from_xml_string(self._xml(links))
        self.data = mujoco.MjData(self.model)
        self.driven = [j for j, stall in enumerate(stall_nm) if stall is not None]
        self.back_emf = self.model.actuator_biasprm[:, 2].copy()
        self.hooks = [hook for j in range(self.n) for hook in self._hooks(j)]
        self.torques = [torque for j in range(self.n) for torque in self._torques(j)]
        self.delay_steps = {
            j: round(self.value(j, "delay", "delay_s", 0.0) / STEP_S) for j in self.driven
        }
        self.sent = []
        self.encoders = [Encoder(self, j) for j in range(self.n)]
        self.gyros = [
            Gyro(self, j) for j in range(self.n) if any(self.has(j, kind) for kind in OF_GYRO)
        ]
        self.drivers = [Driver(self, drive, j) for drive, j in enumerate(self.driven)]
        self.bristles = [Bristles(self, j) for j in range(self.n) if self.has(j, "pre_sliding")]
        self.hooks += [d.step for d in self.drivers if d.remembers]
        self.hooks += [bristles.step for bristles in self.bristles]
        self.dense = bool(self.hooks) or any(
            sensor.remembers for sensor in (*self.encoders, *self.gyros)
        )
        # For how long a row's reading may have to be waited for, s.
        self.wait_s = max(0.0, *(-e.late_s for e in self.encoders))

    def smooth(self):
        """The same rig with only those effects that a linear model holds, without dry friction."""
        links, stall_nm, supply_v, friction, effects, mount = self.made_of
        kept = [effect for effect in effects if effect["kind"] in LINEAR]
        viscous = [(b, 0.0) for b, _ in friction]
        return Rig(links, stall_nm, supply_v, viscous, kept, mount)

    def value(self, joint, kind, key, otherwise):
        """A value of an effect of this joint (from 0), or what holds without it."""
        for name, values in self.by_joint[joint]:
            if name == kind:
                return values[key]
        return otherwise

    def has(self, joint, kind):
        return any(name == kind for name, _ in self.by_joint[joint])

    def _xml(self, links):
        lean = -self.tilt if self.turned else self.tilt
        gravity = (GRAVITY_M_S2 * math.sin(lean), -GRAVITY_M_S2 * math.cos(lean))
        head, tail, drives, gears, y = [], [], [], [], 0.0
        for j, (length, com, mass, inertia) in enumerate(links):
            value = lambda kind, key, otherwise, j=j: self.value(j, kind, key, otherwise)
            share = 1.0 + value("mass", "added_kg", 0.0) / mass
            side = value("com_angle", "angle_rad", 0.0)
            viscous, coulomb = self.friction[j]
            viscous += value("viscous", "coefficient_nm_s_rad", 0.0)
            coulomb += value("coulomb", "torque_nm", 0.0)
            drag = value("air_drag", "coefficient_nm_s2_rad2", 0.0)
            spring = value("cable_spring", "stiffness_nm_rad", 0.0)
            bent = value("quadratic_stiffness", "stiffness_nm_rad2", 0.0)
            rest = value("cable_spring", "rest_angle_rad", 0.0)
            slides = coulomb > 0.0 or self._varies(j)
            # The limit of a constraint that is absent at first cannot be raised later.
            loss = max(coulomb, 1e-12) if slides else 0.0
            head.append(
                f'<body pos="0 {-y!r} 0"><joint name="j{j}" axis="0 0 1"'
                f' damping="{viscous!r} {drag!r}" stiffness="{spring!r} {bent!r}"'
                f' springref="{math.degrees(rest)!r}"'
                f' armature="{value("armature", "inertia_kg_m2", 0.0)!r}"'
                f' frictionloss="{loss!r}" solreffriction="{2 * STEP_S!r} 1"'
                f' solimpfriction="0.9999 0.9999 0.001 0.5 2"/>'
                + inertial(
                    (com * math.sin(side), -com * math.cos(side)), share * mass, share * inertia
                )
            )
            end = ""
            if j == self.n - 1 and self.payload_kg > 0.0:
                # A point: the least inertia that MuJoCo takes.
                place = f'<body pos="0 {-PAYLOAD_AT_M!r} 0">'
                end += place + inertial((0.0, 0.0), self.payload_kg, 1e-9) + "</body>"
            if self.has(j, "hidden_pendulum"):
                swings = value("hidden_pendulum", "mass_kg", 0.0)
                end += (
                    f'<body pos="0 {-length!r} 0"><joint axis="0 0 1" damping="{PENDULUM[1]!r}"/>'
                    + inertial((0.0, -PENDULUM[0]), swings, 1e-7)
                    + "</body>"
                )
            motor = self._motor(j)
            if motor is None:
                tail.append(end + "</body>")
            else:
                # Beside its link, behind all links, whose places come first.
                tail.append(f'{end}</body><body pos="0 {-y!r} 0">{motor[0]}</body>')
                gears.append(motor[1])
            y = length
            if self.stall_nm[j] is not None:
                drives.append(self._drive(j))
        base = self._base()
        return (
            f'<mujoco><compiler angle="degree"/><option gravity="{gravity[0]!r} {gravity[1]!r} 0"'
            f' timestep="{STEP_S!r}" integrator="RK4" tolerance="1e-12">'
            f'<flag contact="disable"/></option><worldbody>{base[0]}{"".join(head)}'
            f'{"".join(tail[::-1])}{base[1]}</worldbody><tendon>{"".join(gears)}</tendon>'
            f'<actuator>{"".join(drives)}</actuator></mujoco>'
        )

    def _base(self):
        """What the chain hangs on, opened and closed: the world, or a body on springs.

        The springs are at rest under the base's own weight, which counts from there.
        """
        if self.base is None:
            return "", ""
        k, mass = self.base["stiffness_n_m"], self.base["mass_kg"]
        c = 2.0 * self.base["damping_ratio"] * math.sqrt(k * mass)
        slides = "".join(
            f'<joint name="base_{axis}" type="slide" axis="{place}" stiffness="{k!r}"'
            f' damping="{c!r}"/>'
            for axis, place in (("x", "1 0 0"), ("y", "0 1 0"))
        )
        return f'<body gravcomp="1">{slides}{inertial((0.0, 0.0), mass, mass)}', "</body>"

    def _motor(self, j):
        """A motor that turns apart from its joint, and the gear between them; or None.

        Both are MuJoCo's own: the gear is a tendon over both joints that is a spring with a damper,
        or stiff beyond its limits.
        """
        for kind, values in self.by_joint[j]:
            if kind == "gear_compliance":
                k, rotor = values["stiffness_nm_rad"], values["inertia_kg_m2"]
                c = 2.0 * values["damping_ratio"] * math.sqrt(k * rotor)
                gear = f'stiffness="{k!r}" damping="{c!r}" springlength="0"'
            elif kind == "gear_backlash":
                rotor, half = values["inertia_kg_m2"], 0.5 * values["gap_rad"]
                gear = (
                    f'limited="true" range="{-half!r} {half!r}" solreflimit="{FLANKS_S!r} 1"'
                    ' solimplimit="0.999 0.999 0.001 0.5 2"'
                )
            else:
                continue
            joint = f'<joint name="m{j}" axis="0 0 1" armature="{rotor!r}"/>'
            ends = f'<joint joint="m{j}" coef="1"/><joint joint="j{j}" coef="-1"/>'
            return joint + inertial((0.0, 0.0), 1e-9, 1e-9), f"<fixed {gear}>{ends}</fixed>"
        return None

    def _drive(self, j):
        stall = self.stall_nm[j]
        gain = stall * self.value(j, "torque_scale", "factor", 1.0)
        no_load = self.value(j, "speed_limit", "no_load_speed_rad_s", math.inf)
        limit = self.value(j, "torque_saturation", "limit_nm", math.inf)
        clipped = f' forcelimited="true" forcerange="{-limit!r} {limit!r}"'
        joint = f"j{j}" if self._motor(j) is None else f"m{j}"
        return (
            f'<general joint="{joint}" gaintype="fixed" gainprm="{gain!r}" biastype="affine"'
            f' biasprm="0 0 {-stall / no_load!r}"{clipped if limit < math.inf else ""}/>'
        )

    def _varies(self, j):
        kinds = ("stribeck", "position_friction", "rub", "warm_up")
        return any(self.has(j, kind) for kind in kinds)

    def _hooks(self, j):
        """What happens before each step."""
        if self._varies(j):
            base = self.friction[j][1] + self.value(j, "coulomb", "torque_nm", 0.0)
            yield lambda: self._set_loss(j, base)
        if self.has(j, "viscoelastic"):
            stiffness = self.value(j, "viscoelastic", "stiffness_nm_rad", 0.0)
            forgets = self.value(j, "viscoelastic", "time_constant_s", 1.0)
            stretch = [0.0]
            kept = math.exp(-STEP_S / forgets)

            def pull():
                # Spring and damper in series: what is stretched is forgotten.
                speed = self.data.qvel[self.first + j]
                stretch[0] = kept * stretch[0] + (1.0 - kept) * forgets * speed
                self.data.qfrc_applied[self.first + j] = -stiffness * stretch[0]

            yield pull

    def _set_loss(self, j, base):
        at = self.first + j
        speed, angle = abs(self.data.qvel[at]), self.data.qpos[at]
        loss = base
        for kind, values in self.by_joint[j]:
            if kind == "stribeck":
                loss += values["excess_nm"] * math.exp(-speed / values["speed_rad_s"])
            elif kind == "position_friction":
                side = values["below_nm" if angle < 0.0 else "above_nm"]
                loss += side * min(abs(angle) / values["span_rad"], 1.0)
            elif kind == "rub" and abs(angle - values["at_rad"]) < values["half_width_rad"]:
                loss += values["torque_nm"]
            elif kind == "warm_up":
                loss += values["torque_nm"] * math.exp(-self.data.time / values["time_constant_s"])
        self.model.dof_frictionloss[at] = max(loss, 1e-12)

    def _torques(self, j):
        """Torques on the joint that MuJoCo has no element for, as functions of the angle."""
        for kind, values in self.by_joint[j]:
            if kind == "cogging":
                a, n, p = (values[k] for k in ("amplitude_nm", "periods_per_turn", "phase_rad"))
                yield j, lambda q, a=a, n=n, p=p: a * math.sin(n * q + p)
            elif kind == "direction_asymmetry":
                # With Coulomb friction of at least the half: the limits of both directions.
                yield j, lambda q, half=values["half_difference_nm"]: -half
            elif kind == "torque_offset":
                yield j, lambda q, offset=values["offset_nm"]: offset
            elif kind == "position_trap":
                a, at, w = (values[k] for k in ("peak_nm", "at_rad", "width_rad"))

                def trap(q, a=a, at=at, w=w):
                    x = (q - at) / w
                    return -a * x * math.exp(0.5 - 0.5 * x * x)

                yield j, trap

    def _passive(self, _model, data):
        for j, torque in self.torques:
            at = self.first + j
            data.qfrc_passive[at] += torque(data.qpos[at])

    def start(self, angles, speeds=None):
        """Puts the rig at these joint angles, its encoders in the middle of their play."""
        mujoco.mj_resetData(self.model, self.data)
        joints = self.joints()
        self.data.qpos[joints] = angles
        self.data.qvel[joints] = 0.0 if speeds is None else speeds
        if self.base is not None:
            # Sagged under the weight of all but itself.
            weight = (self.model.body_mass.sum() - self.base["mass_kg"]) * self.model.opt.gravity
            self.data.qpos[:2] = weight[:2] / self.base["stiffness_n_m"]
        for j in self.driven:
            if self._motor(j) is not None:
                at, of = self.model.joint(f"m{j}"), self.model.joint(f"j{j}")
                self.data.qpos[at.qposadr] = self.data.qpos[of.qposadr]
                self.data.qvel[at.dofadr] = self.data.qvel[of.dofadr]
        self.sent = []
        for part in (*self.encoders, *self.gyros, *self.drivers, *self.bristles):
            part.start()

    def advance(self, duty, supply_v, torque_on):
        """One sample: the duties (of driven joints) are sent at its beginning."""
        self.sent.append((duty, supply_v, torque_on))
        late = sorted({0, STEPS} | {d % STEPS for d in self.delay_steps.values()})
        mujoco.set_mjcb_passive(self._passive if self.torques else None)
        try:
            for begin, end in zip(late, late[1:]):
                self._drive_from(begin)
                if not self.dense:
                    mujoco.mj_step(self.model, self.data, nstep=end - begin)
                    continue
                for _ in range(end - begin):
                    for hook in self.hooks:
                        hook()
                    mujoco.mj_step(self.model, self.data)
                    for sensor in (*self.encoders, *self.gyros):
                        sensor.follow()
        finally:
            mujoco.set_mjcb_passive(None)

    def _drive_from(self, begin):
        """Sets the drives as they are from this step of the sample on."""
        _, supply_v, torque_on = self.sent[-1]
        for drive, j in enumerate(self.driven):
            ago = -(-(self.delay_steps[j] - begin) // STEPS)
            sent = self.sent[-1 - ago] if ago < len(self.sent) else None
            duty = sent[0][drive] if sent is not None else 0.0
            on = torque_on
            self.drivers[drive].command(duty, supply_v, on)
            self.model.actuator_biasprm[drive, 2] = self.back_emf[drive] if on else 0.0

    def applied(self, j, duty, supply_v):
        """Duty that reaches the motor of a joint, the supply's part in it included."""
        sensitivity = self.value(j, "supply_sensitivity", "sensitivity", 0.0)
        sag = self.value(j, "supply_sag", "drop_share", 0.0)
        share = 1.0 + sensitivity * (supply_v / self.nominal_supply_v - 1.0)
        return duty * share * (1.0 - sag * abs(duty))

    def joints(self):
        """Where the joints' values are in MuJoCo's arrays."""
        return slice(self.first, self.first + self.n)

    def angles(self):
        return self.data.qpos[self.joints()].copy()

    def speeds(self):
        return self.data.qvel[self.joints()].copy()

    def sensed(self):
        """What the encoders would read without steps."""
        return np.array([encoder.sensed() for encoder in self.encoders])

    def logged(self, time_s):
        """What a log's row of this time since the start holds, without steps; columns whose times
        are right have nothing here."""
        return [encoder.logged(time_s) for encoder in self.encoders]


class Driver:
    """Dead zone, ramp, winding and overload protection of one joint's drive."""

    def __init__(self, rig, drive, joint):
        value = lambda kind, key, otherwise: rig.value(joint, kind, key, otherwise)
        self.rig, self.drive, self.joint = rig, drive, joint
        self.dead = value("dead_zone", "width", 0.0)
        self.reach = value("slew_limit", "rate_per_s", math.inf) * STEP_S
        self.rise = value("thermal_drift", "rise", 0.0)
        self.kept = math.exp(-STEP_S / value("thermal_drift", "time_constant_s", math.inf))
        self.share = value("fold_back", "remaining_share", 1.0)
        self.level = value("fold_back", "level", math.inf)
        self.after_s = value("fold_back", "after_s", math.inf)
        kinds = ("slew_limit", "thermal_drift", "fold_back")
        self.remembers = any(rig.has(joint, kind) for kind in kinds)
        self.start()

    def start(self):
        self.reached, self.warmth, self.overloaded_s = None, 0.0, 0.0

    def command(self, duty, supply_v, on):
        self.wanted = (duty, supply_v, on)
        if not self.remembers:
            self.push(duty, supply_v, on)

    def push(self, duty, supply_v, on, share=1.0):
        duty = duty if abs(duty) > self.dead and on else 0.0
        applied = self.rig.applied(self.joint, duty, supply_v)
        self.rig.data.ctrl[self.drive] = share * applied
        return duty

    def step(self):
        """Before each step: what the drive gives during it, and what that leaves behind."""
        duty, supply_v, on = self.wanted
        before = duty if self.reached is None or not on else self.reached
        self.reached = min(max(duty, before - self.reach), before + self.reach)
        share = 1.0 / (1.0 + self.rise * self.warmth)
        if self.overloaded_s >= self.after_s:
            share *= self.share
        duty = self.push(self.reached, supply_v, on, share)
        self.warmth = self.kept * self.warmth + (1.0 - self.kept) * duty * duty
        counts = STEP_S if abs(duty) > self.level else -STEP_S
        self.overloaded_s = min(max(self.overloaded_s + counts, 0.0), 2.0 * self.after_s)


class Bristles:
    """Dry friction that is a spring until it slides: Dahl's law."""

    def __init__(self, rig, joint):
        self.rig, self.joint = rig, joint
        self.torque_nm = rig.value(joint, "pre_sliding", "torque_nm", 0.0)
        self.stiffness = rig.value(joint, "pre_sliding", "stiffness_nm_rad", 1.0)
        self.start()

    def start(self):
        self.bent_nm = 0.0

    def step(self):
        at = self.rig.first + self.joint
        way = STEP_S * self.rig.data.qvel[at]
        self.bent_nm += self.stiffness * (way - abs(way) * self.bent_nm / self.torque_nm)
        self.rig.data.qfrc_applied[at] = -self.bent_nm


class Encoder:
    """Grip, scale, zero, play and lag of one joint's encoder, and the times of its column."""

    def __init__(self, rig, joint):
        self.rig, self.joint = rig, joint
        self.factor = rig.value(joint, "encoder_scale", "factor", 1.0)
        self.offset = rig.value(joint, "encoder_zero", "offset_rad", 0.0)
        self.half = 0.5 * rig.value(joint, "backlash", "gap_rad", 0.0)
        self.lag_s = rig.value(joint, "sensor_lag", "time_constant_s", 0.0)
        self.grip = rig.value(joint, "grip_slip", "acceleration_rad_s2", math.inf)
        self.late_s = rig.value(joint, "time_offset", "offset_s", 0.0)
        self.remembers = self.half > 0.0 or self.lag_s > 0.0 or self.grip < math.inf
        self.remembers |= self.late_s != 0.0
        self.start()

    def encoded(self):
        return self.factor * self.rig.data.qpos[self.rig.first + self.joint] + self.offset

    def start(self):
        self.follower = self.lagged = self.turned = self.shaft = self.encoded()
        self.shaft_speed = 0.0
        self.trace = [self.lagged]

    def gripped(self, encoded):
        """Angle of the shaft, which friction speeds up by no more than a limit."""
        speed = (encoded - self.turned) / STEP_S
        reach = self.grip * STEP_S
        slips = abs(speed - self.shaft_speed) > reach
        if slips:
            speed = self.shaft_speed + math.copysign(reach, speed - self.shaft_speed)
        self.shaft += speed * STEP_S if slips else encoded - self.turned
        self.turned, self.shaft_speed = encoded, speed
        return self.shaft

    def follow(self):
        before, now = self.follower, self.gripped(self.encoded())
        self.follower = min(max(before, now - self.half), now + self.half)
        if self.lag_s > 0.0:
            middle = 0.5 * (before + self.follower)
            self.lagged += (middle - self.lagged) * STEP_S / (self.lag_s + 0.5 * STEP_S)
        else:
            self.lagged = self.follower
        if self.late_s != 0.0:
            self.trace.append(self.lagged)

    def logged(self, time_s):
        """The reading of a row, on a line between steps; at rest before the start."""
        if self.late_s == 0.0:
            return None
        at = min(max((time_s - self.late_s) / STEP_S, 0.0), len(self.trace) - 1.0)
        before = int(at)
        after = min(before + 1, len(self.trace) - 1)
        return self.trace[before] + (at - before) * (self.trace[after] - self.trace[before])

    def sensed(self):
        return self.lagged if self.remembers else self.encoded()


class Gyro:
    """Scale, bias and lag of the gyro on one link, which reads its rate against the world."""

    def __init__(self, rig, joint):
        self.rig, self.joint = rig, joint
        self.bias = rig.value(joint, "rate_bias", "bias_rad_s", 0.0)
        self.factor = rig.value(joint, "rate_scale", "factor", 1.0)
        self.lag_s = rig.value(joint, "rate_lag", "time_constant_s", 0.0)
        self.remembers = self.lag_s > 0.0
        self.start()

    def rate(self):
        return float(self.rig.speeds()[: self.joint + 1].sum())

    def start(self):
        self.before = self.lagged = self.rate()

    def follow(self):
        now = self.rate()
        middle = 0.5 * (self.before + now)
        self.lagged += (middle - self.lagged) * STEP_S / (self.lag_s + 0.5 * STEP_S)
        self.before = now

    def read(self, rng):
        """A noisy reading in steps; never a negative zero."""
        rate = self.factor * (self.lagged if self.remembers else self.rate()) + self.bias
        return round(rate / GYRO_RAD_S + rng.standard_normal()) * GYRO_RAD_S + 0.0


def inertial(place, mass, inertia):
    """An inertial element; only the inertia about z acts in the plane."""
    x, y = place
    return (
        f'<inertial pos="{x!r} {y!r} 0" mass="{mass!r}"'
        f' diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
    )


def quantised(angle):
    """To steps of 300/1024 degrees; never a negative zero."""
    return round(angle / ENCODER_RAD) * ENCODER_RAD + 0.0
