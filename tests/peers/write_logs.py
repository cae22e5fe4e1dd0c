"""Writes the same log in the formats of other programs, by their own libraries.

    python write_logs.py FOLDER

Needs numpy, scipy, mcap, mcap-ros2-support and rosbags (PyPI). `expected.json` holds what every
file says, by column: numbers as their shortest decimal, which is read back to the last bit, or null
where nothing was measured.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
from mcap.writer import CompressionType
from mcap_ros2.writer import Writer as McapWriter
from rosbags.rosbag2 import Writer as BagWriter
from rosbags.rosbag2 import StoragePlugin
from rosbags.typesys import Stores, get_typestore
from scipy.io import savemat

ROWS = 60
START_NS = 1_772_366_400_123_456_789
STEP_NS = 10_000_001
JOINTS = ["shoulder", "elbow"]
MESSAGE = """std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


def value(joint, row):
    return math.sin(0.1 * row + joint) / 3.0


def speed(joint, row):
    return math.nan if (joint, row) == (1, 7) else math.cos(0.1 * row + joint) * math.pi


def goal(row):
    return 0.1 * row


def stamps():
    return [START_NS + STEP_NS * row for row in range(ROWS)]


def write_mcap(file, compression):
    with open(file, "wb") as stream:
        writer = McapWriter(stream, compression=compression, chunk_size=2000)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", MESSAGE)
        for row, ns in enumerate(stamps()):
            header = {"stamp": {"sec": ns // 10**9, "nanosec": ns % 10**9}, "frame_id": "base"}
            if row % 2 == 0:
                goals = {"header": header, "name": JOINTS[:1], "position": [goal(row)],
                         "velocity": [], "effort": []}
                writer.write_message("/arm/goals", schema, goals, log_time=ns, publish_time=ns)
            state = {"header": header, "name": JOINTS,
                     "position": [value(joint, row) for joint in range(2)],
                     "velocity": [speed(joint, row) for joint in range(2)], "effort": []}
            writer.write_message("/joint_states", schema, state, log_time=ns, publish_time=ns)
        writer.finish()


def write_bag(folder, joints, rows):
    """A bag of one file; many joints make rows longer than a page."""
    types = get_typestore(Stores.ROS2_HUMBLE)
    state = types.types["sensor_msgs/msg/JointState"]
    header = types.types["std_msgs/msg/Header"]
    stamp = types.types["builtin_interfaces/msg/Time"]
    names = JOINTS + [f"joint{index}" for index in range(2, joints)]
    with BagWriter(folder, version=8, storage_plugin=StoragePlugin.SQLITE3) as bag:
        topic = bag.add_connection("/joint_states", state.__msgtype__, typestore=types)
        for row, ns in enumerate(stamps()[:rows]):
            message = state(
                header=header(stamp=stamp(sec=ns // 10**9, nanosec=ns % 10**9), frame_id=""),
                name=names,
                position=np.array([value(joint, row) for joint in range(joints)]),
                velocity=np.array([speed(joint, row) for joint in range(joints)]),
                effort=np.zeros(0),
            )
            bag.write(topic, ns, types.serialize_cdr(message, state.__msgtype__))


def write_mat(file, compressed):
    rows = range(ROWS)
    columns = {
        "t": np.array([STEP_NS * row / 1e9 for row in rows]),
        "q": np.array([[value(joint, row) for joint in range(2)] for row in rows]),
        "data": {"dq": np.array([speed(1, row) for row in rows])},
        "count": np.array([row * 7 for row in rows], dtype=np.int16),
        "single": np.array([value(0, row) for row in rows], dtype=np.float32),
        "supply_v": 11.7,
        "note": "a text",
        "short": np.array([1.0, 2.0]),
        "complex": np.array([1j] * ROWS),
    }
    savemat(file, columns, do_compression=compressed, oned_as="column")


def plain(numbers):
    return [None if math.isnan(number) else number for number in numbers]


def expected():
    rows = range(ROWS)
    of = {f"{name}.position": [value(joint, row) for row in rows] for joint, name in enumerate(JOINTS)}
    of |= {f"{name}.velocity": plain(speed(joint, row) for row in rows) for joint, name in enumerate(JOINTS)}
    of["time_s"] = [STEP_NS * row / 1e9 for row in rows]
    of["arm/goals/shoulder.position"] = [goal(row - row % 2) for row in rows]
    mat = {"t": of["time_s"], "q_1": of["shoulder.position"], "q_2": of["elbow.position"],
           "data.dq": of["elbow.velocity"], "count": [float(row * 7) for row in rows],
           "single": [float(np.float32(value(0, row))) for row in rows]}
    return {"states": of, "mat": mat}


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in ["none", "lz4", "zstd"]:
        write_mcap(folder / f"states_{name}.mcap", CompressionType[name.upper()])
    for name, joints, rows in [("states", 2, ROWS), ("many", 150, 8)]:
        write_bag(folder / name, joints, rows)
        next((folder / name).glob("*.db3")).rename(folder / f"{name}.db3")
        for left in (folder / name).iterdir():
            left.unlink()
        (folder / name).rmdir()
    write_mat(folder / "v7.mat", True)
    write_mat(folder / "v6.mat", False)
    with open(folder / "expected.json", "w", encoding="utf-8") as file:
        json.dump(expected(), file)


if __name__ == "__main__":
    main()
