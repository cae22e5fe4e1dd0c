"""Writes the same log in the formats of other programs, by their own libraries.

    python write_logs.py FOLDER

Needs numpy, scipy, h5py, hdf5storage, mcap, mcap-ros2-support, rosbags, pyarrow and polars (PyPI).
`expected.json` holds what every file says, by column: numbers as their shortest decimal, which is
read back to the last bit, or null where nothing was measured.
"""

import json
import math
import sys
from decimal import Decimal
from pathlib import Path

import h5py
import hdf5storage
import numpy as np
import polars
import pyarrow
from mcap.writer import CompressionType
from mcap_ros2.writer import Writer as McapWriter
from rosbags.rosbag2 import Writer as BagWriter
from rosbags.rosbag2 import StoragePlugin
from pyarrow import parquet
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


LARGEST = 2**64 - 100


def mat73_columns():
    """Variables of MATLAB 7.3 that are read."""
    rows = range(ROWS)
    return {
        "t": np.array([STEP_NS * row / 1e9 for row in rows]),
        "q": np.array([[value(joint, row) for joint in range(2)] for row in rows]),
        "count": np.array([row * 7 - 200 for row in rows], dtype=np.int16),
        "small": np.array([row - 30 for row in rows], dtype=np.int8),
        "large": np.array([2**31 + row * 1000 for row in rows], dtype=np.uint32),
        "stamp": np.array(stamps(), dtype=np.int64),
        "largest": np.array([LARGEST + row for row in rows], dtype=np.uint64),
        "single": np.array([value(0, row) for row in rows], dtype=np.float32),
        "on": np.array([row % 5 != 0 for row in rows]),
        "supply_v": np.float64(11.7),
    }


def mat73_struct():
    return {
        "dq": np.array([speed(1, row) for row in range(ROWS)]),
        "inner": {"x": np.array([value(1, row) for row in range(ROWS)])},
    }


def write_mat73(file):
    left_out = {
        "note": "a text",
        "short": np.array([1.0, 2.0]),
        "complex": np.array([1j] * ROWS),
        "cells": np.array([1.0, "a"], dtype=object),
        "none": np.zeros((0, 0)),
        "cube": np.zeros((ROWS, 2, 2)),
    }
    columns = mat73_columns() | {"data": mat73_struct()} | left_out
    hdf5storage.savemat(str(file), columns, oned_as="column", store_python_metadata=False)


def write_mat73_h5py(file, libver):
    """What MATLAB may write and hdf5storage does not: other layouts, orders of bytes, versions."""
    with h5py.File(file, "w", libver=libver, userblock_size=512) as stream:

        def put(group, name, values, of=None, **layout):
            values = np.asarray(values)
            of = of or {"bool": "logical", "float64": "double", "float32": "single"}.get(
                values.dtype.name, values.dtype.name)
            values = values.astype(np.uint8) if of == "logical" else values
            values = np.atleast_2d(values.T).astype(values.dtype.newbyteorder(">"))
            if "chunks" in layout:
                layout |= {"compression": "gzip", "shuffle": True}
            dataset = group.create_dataset(name, data=values, **layout)
            dataset.attrs["MATLAB_class"] = np.bytes_(of)

        layouts = {
            "t": {"chunks": (1, 7)},
            "q": {"chunks": (2, 16), "maxshape": (None, None)},
            "count": {"chunks": (1, 1)},
            "stamp": {"chunks": (1, 7), "maxshape": (1, None), "fletcher32": True},
            "single": {"chunks": (1, 100), "maxshape": (1, 100)},
        }
        for name, values in mat73_columns().items():
            put(stream, name, values, **layouts.get(name, {}))

        def structure(group, name, fields):
            inner = group.create_group(name)
            inner.attrs["MATLAB_class"] = np.bytes_("struct")
            for key, values in fields.items():
                if isinstance(values, dict):
                    structure(inner, key, values)
                else:
                    put(inner, key, values)

        # Links of a group as large as this stand in a heap of their own.
        structure(stream, "data", mat73_struct() | {f"k{at:02}": 0.5 * at for at in range(40)})
        sparse = stream.create_group("sparse")
        sparse.attrs["MATLAB_class"] = np.bytes_("double")
        sparse.attrs["MATLAB_sparse"] = np.uint64(ROWS)
        put(sparse, "ir", np.arange(3, dtype=np.uint64))
        put(stream, "half", np.zeros(ROWS, dtype=np.float16), "single")
        stream["plain"] = np.zeros((1, ROWS))
    write_userblock(file)


def write_structures(folder):
    """Two recordings as an array of structures, in either version: neither is the log."""
    runs = [(np.arange(ROWS) / 50, np.full(ROWS, 0.5 + run)) for run in range(2)]
    array = np.array(runs, dtype=[("time", "O"), ("angle", "O")])
    savemat(folder / "structures.mat", {"test": array}, do_compression=True)
    file = folder / "structures73.mat"
    with h5py.File(file, "w", userblock_size=512) as stream:
        test = stream.create_group("test")
        test.attrs["MATLAB_class"] = np.bytes_("struct")
        held = stream.create_group("#refs#")
        for at, key in enumerate(["time", "angle"]):
            fields = [held.create_dataset(f"{key}{run}", data=np.atleast_2d(values[at]))
                      for run, values in enumerate(runs)]
            for field in fields:
                field.attrs["MATLAB_class"] = np.bytes_("double")
            refer = test.create_dataset(key, (2, 1), dtype=h5py.ref_dtype)
            refer[:, 0] = [field.ref for field in fields]
    write_userblock(file)


def write_userblock(file):
    words = b"MATLAB 7.3 MAT-file, HDF5 schema 1.00 .".ljust(116) + bytes(8)
    with open(file, "r+b") as stream:
        stream.write(words + bytes([0, 2]) + b"IM")


def expected_mat73():
    """As doubles; whole numbers too long for those count from the first."""
    rows = range(ROWS)
    of = {name: [float(number) for number in values]
          for name, values in mat73_columns().items() if name not in ["q", "supply_v"]}
    of["stamp"] = [float(STEP_NS * row) for row in rows]
    of["largest"] = [float(row) for row in rows]
    for joint in range(2):
        of[f"q_{joint + 1}"] = [value(joint, row) for row in rows]
    of["data.dq"] = plain(speed(1, row) for row in rows)
    of["data.inner.x"] = [value(1, row) for row in rows]
    return of


def parquet_columns():
    """Every kind of column, each with its type; a gap in some."""
    rows = range(ROWS)
    stamp = pyarrow.timestamp
    state = [[value(joint, row) for joint in range(2)] for row in rows]
    return {
        "time": (stamps(), stamp("ns")),
        "time_us": ([ns // 1000 for ns in stamps()], stamp("us", tz="UTC")),
        "time_ms": ([None if row == 3 else ns // 10**6 for row, ns in enumerate(stamps())],
                    stamp("ms")),
        "clock": ([row * 1001 for row in rows], pyarrow.time64("us")),
        "stamp": (stamps(), pyarrow.int64()),
        "q": ([value(0, row) for row in rows], pyarrow.float64()),
        "dq": ([None if row == 7 else speed(1, row) for row in rows], pyarrow.float64()),
        "single": ([value(0, row) for row in rows], pyarrow.float32()),
        "small": ([row * 7 - 200 for row in rows], pyarrow.int16()),
        "large": ([2**31 + row * 1000 for row in rows], pyarrow.uint32()),
        "largest": ([2**64 - 100 + row for row in rows], pyarrow.uint64()),
        "count": ([None if row == 0 else row for row in rows], pyarrow.int64()),
        "torque_on": ([row % 5 != 0 for row in rows], pyarrow.bool_()),
        "level": ([row // 20 for row in rows], pyarrow.int32()),
        "goal": ([Decimal(row * 125) / 1000 for row in rows], pyarrow.decimal128(9, 3)),
        "state": (state, pyarrow.list_(pyarrow.float64())),
        "action": (state, pyarrow.list_(pyarrow.float32(), 2)),
        "imu": ([{"x": value(0, row), "y": row} for row in rows],
                pyarrow.struct({"x": pyarrow.float64(), "y": pyarrow.int32()})),
        "note": (["a text"] * ROWS, pyarrow.string()),
        "ragged": ([[1.0] * (row % 3) for row in rows], pyarrow.list_(pyarrow.float64())),
        "grid": ([[[1.0], [2.0]]] * ROWS, pyarrow.list_(pyarrow.list_(pyarrow.float64()))),
        "by_name": ([[("a", 1.0)]] * ROWS, pyarrow.map_(pyarrow.string(), pyarrow.float64())),
    }


def write_parquet(folder):
    columns = {name: pyarrow.array(values, of) for name, (values, of) in parquet_columns().items()}
    table = pyarrow.table(columns)

    def write(name, table=table, **options):
        parquet.write_table(table, folder / f"{name}.parquet", **options)

    integers = ["time", "time_us", "time_ms", "stamp", "small", "large", "largest", "count",
                "level"]
    encodings = {name: "DELTA_BINARY_PACKED" for name in integers}
    encodings |= {name: "BYTE_STREAM_SPLIT" for name in ["q", "dq", "single"]}
    encodings |= {"torque_on": "RLE"}
    write("arrow", compression="snappy", row_group_size=25, store_decimal_as_integer=True)
    write("arrow_v2", compression="gzip", data_page_version="2.0", use_dictionary=False,
          column_encoding=encodings, store_decimal_as_integer=True)
    write("arrow_old", compression="none", version="1.0", use_deprecated_int96_timestamps=True,
          store_decimal_as_integer=True)
    write("arrow_lz4", compression="lz4", store_decimal_as_integer=True, data_page_size=64,
          write_batch_size=8)
    write("brotli", table.select(["q"]), compression="brotli")
    polars.from_arrow(table.drop_columns(["by_name", "goal"])).write_parquet(
        folder / "polars.parquet")


def expected_parquet():
    rows = range(ROWS)
    exact = {name: values for name, (values, _) in parquet_columns().items()}

    def since(name, per_s):
        first = next(value for value in exact[name] if value is not None)
        return [None if value is None else (value - first) / per_s for value in exact[name]]

    of = {name: [None if value is None else float(value) for value in exact[name]]
          for name in ["q", "small", "large", "count", "torque_on", "level", "goal"]}
    of["dq"] = plain(math.nan if value is None else value for value in exact["dq"])
    of["time"], of["time_us"] = since("time", 1e9), since("time_us", 1e6)
    of["time_ms"] = since("time_ms", 1e3)
    of["clock"] = [row * 1001 / 1e6 for row in rows]
    of["stamp"], of["largest"] = since("stamp", 1), since("largest", 1)
    of["single"] = [float(np.float32(value(0, row))) for row in rows]
    for joint in range(2):
        of[f"state_{joint + 1}"] = [value(joint, row) for row in rows]
        of[f"action_{joint + 1}"] = [float(np.float32(value(joint, row))) for row in rows]
    of["imu.x"], of["imu.y"] = of["q"], [float(row) for row in rows]
    return of


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
    return {"states": of, "mat": mat, "mat73": expected_mat73(),
            "parquet": expected_parquet()}


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
    write_mat73(folder / "v73.mat")
    write_mat73_h5py(folder / "v73_packed.mat", "earliest")
    write_mat73_h5py(folder / "v73_latest.mat", "latest")
    write_structures(folder)
    write_parquet(folder)
    with open(folder / "expected.json", "w", encoding="utf-8") as file:
        json.dump(expected(), file)


if __name__ == "__main__":
    main()
