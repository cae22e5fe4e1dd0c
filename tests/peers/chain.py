"""The planar n-link chain as MuJoCo and Pinocchio models.

Every quantity is SI: lengths in m, masses in kg, inertias in kg m^2, angles in
rad. The chain moves in the x-y plane, gravity is 9.81 m/s^2 along -y. At q = 0
every link hangs along -y; joint angles are relative to the link before and
counter-clockwise (about +z).
"""

import mujoco
import numpy as np
import pinocchio as pin

GRAVITY = 9.81  # m/s^2

# Table 1 of the paper: length m, centre of mass from the joint m, mass kg,
# inertia about the centre of mass kg m^2.
PAPER_LINKS = [
    (0.1436, 0.0687, 0.3676, 7890.7e-7),
    (0.1158, 0.0575, 0.9815, 32898.6e-7),
    (0.1840, 0.1163, 0.5764, 11328.0e-7),
]
UNIFORM_LINK = (0.15, 0.075, 0.2, 3.75e-4)


def links(n):
    """Rows (length m, com m, mass kg, inertia kg m^2) of the n-link chain."""
    return PAPER_LINKS if n == 3 else [UNIFORM_LINK] * n


def test_state(n, seed=0):
    """Seeded q (rad), dq (rad/s) and tau (N m) for an n-link chain."""
    rng = np.random.default_rng([seed, n])
    return (
        rng.uniform(-1.0, 1.0, n),
        rng.uniform(-2.0, 2.0, n),
        rng.uniform(-0.5, 0.5, n),
    )


def mujoco_model(n):
    """The chain as an MjModel: hinges about +z, no geometry, no contacts.

    Only the z inertia acts in the plane; the two others repeat it, so that the
    triangle inequality MuJoCo checks is met.
    """
    head, tail, y = [], [], 0.0
    for length, com, mass, inertia in links(n):
        head.append(
            f'<body pos="0 {-y!r} 0"><joint type="hinge" axis="0 0 1"/>'
            f'<inertial pos="0 {-com!r} 0" mass="{mass!r}" '
            f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
        )
        tail.append("</body>")
        y = length
    xml = (
        f'<mujoco><option gravity="0 {-GRAVITY} 0"><flag contact="disable"/></option>'
        f'<worldbody>{"".join(head)}{"".join(tail)}</worldbody></mujoco>'
    )
    return mujoco.MjModel.from_xml_string(xml)


def pinocchio_model(n):
    """The chain as a pinocchio Model: revolute joints about +z."""
    model = pin.Model()
    model.gravity.linear = np.array([0.0, -GRAVITY, 0.0])
    parent, y = 0, 0.0
    for index, (length, com, mass, inertia) in enumerate(links(n)):
        placement = pin.SE3(np.eye(3), np.array([0.0, -y, 0.0]))
        parent = model.addJoint(parent, pin.JointModelRZ(), placement, f"joint{index}")
        body = pin.Inertia(mass, np.array([0.0, -com, 0.0]), inertia * np.eye(3))
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
        y = length
    return model
