"""An arm in space as its URDF has it: what the scripts that simulate such arms know of one.

Reads a serial arm of turning joints with the standard library's XML reader, and writes it as a body
of MuJoCo. What is fixed to a link may weigh nothing: a frame of the tool.
"""

import dataclasses
import sys
import xml.etree.ElementTree as ElementTree

# A frame that some exporters give a mass, so that it has one, kg.
WEIGHTLESS_KG = 1e-6

# Moments of the two long links of the desk arm, kg m^2.
LONG = (4e-5, 2e-4, 2e-4)
# Joint; where it stands in the link before, m, and how it is turned about that link's first axis,
# rad; its axis; its range, rad; its link's centre of mass, m, mass, kg, and moments about the axes
# through it, kg m^2.
DESK = [
    ("pan", (0, 0, 0.06), 0, (0, 0, 1), (-1.6, 1.6), (0.01, 0, 0.03), 0.12, (6e-5, 7e-5, 5e-5)),
    ("lift", (0.03, 0, 0.055), 0, (0, 1, 0), (-0.9, 1.1), (0.09, 0.01, 0.02), 0.11, LONG),
    ("elbow", (0.113, 0, 0.028), 0, (0, 1, 0), (-1.2, 1.2), (0.08, 0, 0.01), 0.1, LONG),
    ("wrist", (0.135, 0, 0.005), 0, (0, 1, 0), (-1.4, 1.4), (0.04, 0.01, 0), 0.09,
     (3e-5, 6e-5, 6e-5)),
    ("roll", (0.061, 0, 0), 0, (1, 0, 0), (-2.4, 2.4), (0.05, 0, 0.015), 0.12, (6e-5, 1e-4, 9e-5)),
]
QUARTER = 1.5707963267948966
Z = (0, 0, 1)
# Like Franka Emika's Panda: its published axes and ranges (Franka Control Interface documentation,
# Denavit-Hartenberg parameters), and masses and centres of mass near those that Gaz et al.
# identified (IEEE Robotics and Automation Letters 4 (2019) 4147), rounded; moments are those of
# rods of about the links' sizes. Ranges are halved, so that no link meets another.
PANDA = [
    ("joint1", (0, 0, 0.333), 0, Z, (-1.4, 1.4), (0, 0, -0.05), 4.97, (0.05, 0.05, 0.01)),
    ("joint2", (0, 0, 0), -QUARTER, Z, (-0.9, 0.9), (0, -0.03, 0), 0.65, (0.01, 0.01, 0.01)),
    ("joint3", (0, -0.316, 0), QUARTER, Z, (-1.4, 1.4), (0.03, 0.04, -0.07), 3.23,
     (0.04, 0.04, 0.01)),
    ("joint4", (0.0825, 0, 0), QUARTER, Z, (-2.3, -0.6), (-0.05, 0.1, 0.03), 3.59,
     (0.03, 0.02, 0.03)),
    ("joint5", (-0.0825, 0.384, 0), -QUARTER, Z, (-1.4, 1.4), (-0.01, 0.04, -0.04), 1.23,
     (0.03, 0.03, 0.01)),
    ("joint6", (0, 0, 0), QUARTER, Z, (0.5, 2.9), (0.06, -0.01, -0.01), 1.67,
     (0.005, 0.005, 0.005)),
    ("joint7", (0.088, 0, 0), QUARTER, Z, (-1.4, 1.4), (0.01, 0, 0.06), 0.74, (0.01, 0.01, 0.005)),
]
ARMS = {"desk": DESK, "panda": PANDA}


def urdf_of(name):
    """An arm of this name: "desk", five joints about axes in three directions, or "panda"."""
    arm = ARMS[name]
    lines = [f'<robot name="{name}_arm">', '<link name="base"/>']
    for joint, _, _, _, _, com, mass, (x, y, z) in arm:
        lines += [
            f'<link name="{joint}_link"><inertial><origin xyz="{com[0]} {com[1]} {com[2]}"/>',
            f'<mass value="{mass}"/><inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0"',
            'iyz="0"/></inertial></link>',
        ]
    before = "base"
    for joint, at, roll, axis, (low, high), *_ in arm:
        turned = f' rpy="{roll} 0 0"' if roll else ""
        lines += [
            f'<joint name="{joint}" type="revolute"><parent link="{before}"/>',
            f'<child link="{joint}_link"/><origin xyz="{at[0]} {at[1]} {at[2]}"{turned}/>',
            f'<axis xyz="{axis[0]} {axis[1]} {axis[2]}"/>',
            f'<limit lower="{low}" upper="{high}" effort="10" velocity="10"/></joint>',
        ]
        before = f"{joint}_link"
    return "\n".join(lines + ["</robot>"]) + "\n"


@dataclasses.dataclass(frozen=True)
class Joint:
    """A turning joint and its link, numbers as the file writes them."""

    name: str
    xyz: str
    rpy: str
    axis: str
    low_rad: float
    high_rad: float
    com: str
    com_rpy: str
    mass_kg: float
    # xx, yy, zz, xy, xz, yz, kg m^2.
    inertia_kg_m2: tuple


def joints(urdf):
    """The joints of a serial arm from its base outwards."""
    robot = ElementTree.fromstring(urdf)
    links = {link.get("name"): link for link in robot.findall("link")}
    by_parent = {}
    children = set()
    for joint in robot.findall("joint"):
        parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
        children.add(child)
        if joint.get("type") == "fixed":
            mass = links[child].find("inertial/mass")
            if mass is not None and float(mass.get("value")) > WEIGHTLESS_KG:
                sys.exit(f"{child} is fixed to {parent} and weighs something: not read here")
            continue
        if joint.get("type") not in ("revolute", "continuous"):
            sys.exit(f"{joint.get('name')} is {joint.get('type')}: only turning joints are read")
        if parent in by_parent:
            sys.exit(f"two joints turn about {parent}: only serial arms are read")
        by_parent[parent] = (joint, child)
    here = next(name for name in links if name not in children)
    chain = []
    while here in by_parent:
        joint, here = by_parent[here]
        chain.append(read_joint(joint, links[here]))
    return chain


def read_joint(joint, link):
    def vector(of, key, otherwise="0 0 0"):
        return of.get(key, otherwise) if of is not None else otherwise

    inertial = link.find("inertial")
    place, origin = joint.find("origin"), inertial.find("origin")
    moments = inertial.find("inertia")
    limit = joint.find("limit")
    keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    return Joint(
        joint.get("name"),
        vector(place, "xyz"),
        vector(place, "rpy"),
        vector(joint.find("axis"), "xyz", "1 0 0"),
        float(limit.get("lower")),
        float(limit.get("upper")),
        vector(origin, "xyz"),
        vector(origin, "rpy"),
        float(inertial.find("mass").get("value")),
        tuple(float(moments.get(key)) for key in keys),
    )


# What URDF means by roll, pitch and yaw: turns about the fixed axes.
COMPILER = '<compiler angle="radian" eulerseq="XYZ"/>'


def body(joint, added_kg, of_joint):
    """Opens the body of this joint's link, its mass and inertia grown by what is added to it, its
    joint with these attributes more.
    """
    mass = joint.mass_kg
    share = (mass + added_kg) / mass
    x, y, z, *products = (value * share for value in joint.inertia_kg_m2)
    turned = "" if zero(joint.com_rpy) else f'euler="{joint.com_rpy}" '
    moments = f'diaginertia="{x} {y} {z}"'
    if any(products):
        moments = f'fullinertia="{x} {y} {z} {products[0]} {products[1]} {products[2]}"'
    at = "" if zero(joint.rpy) else f' euler="{joint.rpy}"'
    return (
        f'<body name="{joint.name}_link" pos="{joint.xyz}"{at}>'
        f'<inertial pos="{joint.com}" {turned}mass="{mass * share}" {moments}/>'
        f'<joint name="{joint.name}" axis="{joint.axis}" {of_joint}/>'
    )


def zero(vector):
    return all(float(part) == 0.0 for part in vector.split())
