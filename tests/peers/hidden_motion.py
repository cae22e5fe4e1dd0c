"""Motions of a simulated rig as a bench would log them: references, controllers, recordings.

A motion is recorded at 100 Hz: every sample holds the readings, in steps of 300/1024 degrees, and
the duty that is sent at that time and holds until the next.
"""

import math

import mujoco
import numpy as np

from hidden_rig import SAMPLE_S, STEPS, quantised

DROP_S = 1.4
# Of the arm, and of the robot.
MOST_DUTY = (0.6, 0.8)
# Share of duties at the largest beyond which the controller counts as rattling.
MOST_CLIPPED = (0.04, 0.15)
# Samples without a command at the beginning of a hanging motion.
STILL = 10


def ramp(x):
    """0 below 0, 1 above 1, smooth between."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


class Reference:
    """Every kind of movement once, in the same random order for all driven joints."""

    KINDS = ("triangle", "steps", "sines", "chirp", "drop", "dither")

    def __init__(self, rng, joints, seconds):
        self.kinds = [str(kind) for kind in rng.permutation(self.KINDS)]
        weights = rng.uniform(2.9, 3.7, len(self.kinds))
        self.ends = np.cumsum(weights) * seconds / weights.sum()
        self.shapes = [[self._shape(kind, rng) for kind in self.kinds] for _ in range(joints)]

    @staticmethod
    def _shape(kind, rng):
        sign = rng.choice([-1.0, 1.0])
        if kind == "triangle":
            return rng.uniform(0.2, 0.5)
        if kind == "steps":
            return [sign * (-1) ** k * rng.uniform(0.25, 1.0) for k in range(6)]
        if kind == "sines":
            bands = [(0.3, 0.7, 0.4), (0.7, 1.3, 0.3), (1.3, 2.0, 0.2)]
            return [
                (a * rng.uniform(0.8, 1.2), rng.uniform(low, high), rng.uniform(0, 2 * math.pi))
                for low, high, a in bands
            ]
        if kind == "chirp":
            return rng.uniform(0.45, 0.58), rng.uniform(2.6, 3.0)
        if kind == "drop":
            return sign * rng.uniform(1.1, 1.3)
        return rng.uniform(0.08, 0.2), rng.uniform(0.7, 1.5)

    def angle(self, joint, time_s):
        place = min(int(np.searchsorted(self.ends, time_s, "right")), len(self.ends) - 1)
        begin = self.ends[place - 1] if place else 0.0
        length = self.ends[place] - begin
        since = min(max(time_s - begin, 0.0), length)
        left, shape = length - since, self.shapes[joint][place]
        window = ramp(since / 0.3) * ramp(left / 0.3)
        kind = self.kinds[place]
        if kind == "triangle":
            phase = since / length
            return shape * min(4 * phase, max(2 - 4 * phase, 4 * phase - 4))
        if kind == "steps":
            return 0.0 if left < 0.3 else shape[int(since / 0.6) % len(shape)]
        if kind == "sines":
            return window * sum(a * math.sin(2 * math.pi * f * since + p) for a, f, p in shape)
        if kind == "chirp":
            amplitude, end_hz = shape
            rise = (end_hz - 1.0) / length
            return window * amplitude * math.sin(2 * math.pi * (since + 0.5 * rise * since**2))
        if kind == "drop":
            return 0.0 if left < DROP_S else shape * ramp(since / 0.7)
        amplitude, hz = shape
        return window * amplitude * math.sin(2 * math.pi * hz * since)

    def torque_on(self, time_s):
        place = min(int(np.searchsorted(self.ends, time_s, "right")), len(self.ends) - 1)
        return self.kinds[place] != "drop" or self.ends[place] - time_s > DROP_S


class Supply:
    """A bench supply that drifts by at least 1 V from end to end."""

    def __init__(self, rng):
        while True:
            self.ends = rng.uniform(8.5, 11.1, 2)
            if abs(self.ends[0] - self.ends[1]) >= 1.0:
                break
        self.wobble = rng.uniform(0.05, 0.2), rng.uniform(0, 2 * math.pi)

    def at(self, share):
        line = self.ends[0] + share * (self.ends[1] - self.ends[0])
        return round(line + self.wobble[0] * math.sin(4 * math.pi * share + self.wobble[1]), 1)


class Recording:
    """Rows of a log."""

    def __init__(self, rig, rng):
        self.rng = rng
        self.mount = (rig.payload_kg, rig.turned)
        self.time_s, self.readings, self.duty = [], [], []
        self.torque_on, self.supply_v = [], []
        # Of links with a gyro, from the base outwards.
        self.gyros, self.rates = rig.gyros, []

    def add(self, time_s, readings, duty, torque_on, supply_v):
        self.time_s.append(time_s)
        self.readings.append(readings)
        self.rates.append([gyro.read(self.rng) for gyro in self.gyros])
        self.duty.append(duty)
        self.torque_on.append(torque_on)
        self.supply_v.append(supply_v)

    def read_off_time(self, rig):
        """Takes the readings of columns that are off in time, the rig having been driven to the
        last sample; under its inputs it goes on until the last is read."""
        for _ in range(math.ceil(rig.wait_s / SAMPLE_S)):
            rig.advance(self.duty[-1], self.supply_v[-1], self.torque_on[-1])
        for time_s, readings in zip(self.time_s, self.readings):
            for joint, reading in enumerate(rig.logged(time_s)):
                if reading is not None:
                    readings[joint] = quantised(reading)

    def csv(self, driven):
        joints = len(self.readings[0])
        names = [f"q{j + 1}_rad" for j in range(joints)] + [f"duty{j + 1}" for j in driven]
        names += ["supply_v", "torque_on", "payload_kg", "turned"]
        names += [f"gyro{gyro.joint + 1}_rad_s" for gyro in self.gyros]
        lines = [",".join(["time_s", *names])]
        for k, time_s in enumerate(self.time_s):
            cells = [f"{time_s:.6f}"] + [f"{q:.7f}" for q in self.readings[k]]
            cells += [f"{u:.6f}" for u in self.duty[k]]
            cells += [f"{self.supply_v[k]:.1f}", str(int(self.torque_on[k]))]
            cells += [f"{self.mount[0]:.3f}", str(int(self.mount[1]))]
            cells += [f"{rate:.2f}" for rate in self.rates[k]]
            lines.append(",".join(cells))
        return "\n".join(lines) + "\n"


def held(duty, most):
    """As it is written in the log: six digits, within the range."""
    return [round(min(max(float(u), -most), most), 6) + 0.0 for u in duty]


def hang(rig, gains, rng, seconds):
    """A hanging rig that follows a reference by proportional and derivative action on readings.

    gains: per driven joint, N m/rad and N m s/rad. Repeated with smaller angles and weaker gains
    until the rig stays clear of standing upright.
    """
    reference = Reference(rng, len(rig.driven), seconds)
    supply = Supply(rng)
    start = settled(rig)
    gentle = 1.0
    while gentle > 0.05:
        recording = _hang_once(rig, start, gains, reference, supply, seconds, gentle, rng)
        if recording is not None:
            return recording
        gentle *= 0.8
    raise RuntimeError("no motion is gentle enough for this rig")


def settled(rig):
    """Where the rig comes to rest when it is let go at 0, its damping raised for that."""
    damping = rig.model.dof_damping.copy()
    rig.model.dof_damping[:] += 0.02
    rig.start(np.zeros(rig.n))
    for _ in range(500):
        rig.advance([0.0] * len(rig.driven), rig.nominal_supply_v, False)
    rig.model.dof_damping[:] = damping
    return rig.angles()


def _hang_once(rig, start, gains, reference, supply, seconds, gentle, rng):
    widest = 2.5 if rig.n == 1 else 2.0
    most = MOST_DUTY[rig.n > 1]
    rig.start(start)
    recording = Recording(rig, rng)
    before, speed = None, np.zeros(len(rig.driven))
    samples = round(seconds / SAMPLE_S) + 1
    clipped = 0
    history = []
    for k in range(samples):
        time_s = round(k * SAMPLE_S, 6)
        readings = np.array([quantised(q) for q in rig.sensed()])
        history.append(readings)
        on = reference.torque_on(time_s)
        duty = []
        for drive, j in enumerate(rig.driven):
            at = [gentle * reference.angle(drive, time_s + d) for d in (-0.005, 0.0, 0.005)]
            moved = readings[j] - before[j] if before is not None else 0.0
            speed[drive] += 0.5 * (moved / SAMPLE_S - speed[drive])
            stiff, damp, weight = gains[drive]
            wanted = (at[2] - at[0]) / 0.01 if abs(at[2] - at[0]) < 0.1 else 0.0
            torque = gentle * (stiff * (at[1] - readings[j]) + damp * (wanted - speed[drive]))
            duty.append((torque + weight * math.sin(at[1])) / rig.stall_nm[j])
        before = readings
        # At rest at first: what a late drive was sent before the log began is known to be nothing.
        duty = held(duty if on and k >= STILL else [0.0] * len(duty), most)
        clipped += sum(abs(u) >= most for u in duty)
        supply_v = supply.at(time_s / seconds)
        recording.add(time_s, readings, duty, on, supply_v)
        late = history[max(0, k - 4)]
        if np.abs(readings).max() > widest or np.abs(readings - late).max() > 0.04 * 15.0:
            return None
        if k + 1 < samples:
            rig.advance(duty, supply_v, on)
    recording.read_off_time(rig)
    return recording if clipped <= MOST_CLIPPED[rig.n > 1] * samples * len(rig.driven) else None


def upright(rig):
    """The upright pose with straight driven joints, and the duties that hold it.

    The passive first joint leans until nothing pulls it.
    """
    pose = np.zeros(rig.n)

    def pull(lean):
        pose[0] = lean
        rig.start(pose)
        mujoco.mj_forward(rig.model, rig.data)
        joints = rig.joints()
        return rig.data.qfrc_bias[joints] - rig.data.qfrc_passive[joints]

    lean = math.pi
    for _ in range(50):
        here = pull(lean)[0]
        if abs(here) < 1e-12:
            break
        lean -= here * 2e-5 / (pull(lean + 1e-5)[0] - pull(lean - 1e-5)[0])
    hold = pull(lean)
    factor = [rig.value(j, "torque_scale", "factor", 1.0) * rig.stall_nm[j] for j in rig.driven]
    return pose, hold[rig.driven] / np.array(factor)


def regulator(rig, pose, holding):
    """Sampled LQR about the pose, by differences over one sample of a rig without dry friction.

    Its state is the deviation of angles and speeds, then that of the duties still on their way,
    oldest first. Also the number of these.
    """
    n, m = rig.n, len(rig.driven)
    past = -(-max(rig.delay_steps.values()) // STEPS)

    def after(state, duties):
        rig.start(pose + state[:n], pose * 0.0 + state[n:])
        rig.sent = [(holding + duty, rig.nominal_supply_v, True) for duty in duties[:-1]]
        rig.advance(holding + duties[-1], rig.nominal_supply_v, True)
        return np.concatenate([rig.angles() - pose, rig.speeds()])

    size = 2 * n + m * past
    a, b = np.zeros((size, size)), np.zeros((size, m))
    still, rest = np.zeros((past + 1, m)), np.zeros(2 * n)
    for k in range(2 * n):
        x = rest.copy()
        x[k] = 1e-5
        a[: 2 * n, k] = (after(x, still) - after(-x, still)) / 2e-5
    for age in range(past + 1):
        for k in range(m):
            u = still.copy()
            u[age, k] = 1e-4
            gain = (after(rest, u) - after(rest, -u)) / 2e-4
            if age == past:
                b[: 2 * n, k] = gain
            else:
                a[: 2 * n, 2 * n + m * age + k] = gain
    for age in range(past):
        rows = slice(2 * n + m * age, 2 * n + m * (age + 1))
        if age + 1 < past:
            a[rows, 2 * n + m * (age + 1) : 2 * n + m * (age + 2)] = np.eye(m)
        else:
            b[rows] = np.eye(m)
    q = np.diag([100.0] * n + [1.0] * n + [0.0] * (m * past))
    r = np.diag([rig.stall_nm[j] ** 2 for j in rig.driven])
    p = q.copy()
    for _ in range(20000):
        gain = np.linalg.solve(r + b.T @ p @ b, b.T @ p @ a)
        after_p = q + a.T @ p @ (a - b @ gain)
        settled_p = np.abs(after_p - p).max() < 1e-12 * np.abs(after_p).max()
        p = 0.5 * (after_p + after_p.T)
        if settled_p:
            break
    return gain, past


def balance(rig, rng, seconds):
    """A rig that balances upright under full-state feedback of its true state, probed by sines.

    None when it falls.
    """
    smooth = rig.smooth()
    pose, holding = upright(smooth)
    gain, past = regulator(smooth, pose, holding)
    supply = Supply(rng)
    sines = [
        [(a * rng.uniform(0.7, 1.3), rng.uniform(*band), rng.uniform(0, 2 * math.pi))
         for a, band in ((0.02, (0.2, 0.6)), (0.02, (0.8, 1.6)), (0.015, (2.0, 4.0)))]
        for _ in rig.driven
    ]
    rig.start(pose + rng.uniform(-0.003, 0.003, rig.n))
    recording = Recording(rig, rng)
    samples = round(seconds / SAMPLE_S) + 1
    sent = [np.zeros(len(rig.driven)) for _ in range(past)]
    for k in range(samples):
        time_s = round(k * SAMPLE_S, 6)
        readings = np.array([quantised(q) for q in rig.sensed()])
        supply_v = supply.at(time_s / seconds)
        state = np.concatenate([rig.angles() - pose, rig.speeds(), *sent])
        duty = -gain @ state
        for drive, waves in enumerate(sines):
            duty[drive] += sum(a * math.sin(2 * math.pi * f * time_s + p) for a, f, p in waves)
        duty = np.array(held(holding + duty, 1.0))
        recording.add(time_s, readings, list(duty), True, supply_v)
        if past:
            sent = [*sent[1:], duty - holding]
        if k + 1 < samples:
            rig.advance(duty, supply_v, True)
        if np.abs(rig.angles() - pose).max() > 0.5:
            return None
    recording.read_off_time(rig)
    return recording
