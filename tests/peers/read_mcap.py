"""Reads a recording with MCAP's own Python library; prints what it found as JSON.

A whole file is read through its summary, as Foxglove and others do; a torn one from its beginning until it ends.
"""

import json
import math
import struct
import sys

from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader


def joint_state(data):
    """Names and positions of sensor_msgs/msg/JointState in CDR, little endian."""
    at = 4  # behind the encapsulation header, from which alignment counts

    def take(form, size):
        nonlocal at
        at = (at - 4 + size - 1) // size * size + 4
        (value,) = struct.unpack_from("<" + form, data, at)
        at += size
        return value

    def text():
        nonlocal at
        length = take("I", 4)
        at += length
        return data[at - length : at - 1].decode()

    assert data[:4] == b"\x00\x01\x00\x00", "XCDR1, little endian"
    take("i", 4), take("I", 4), text()
    names = [text() for _ in range(take("I", 4))]
    positions = [take("d", 8) for _ in range(take("I", 4))]
    return names, [None if math.isnan(value) else round(value, 9) for value in positions]


def seen(messages):
    found = {"topics": {}, "schemas": {}, "first": None, "last_time_s": None}
    begin = None
    for schema, channel, message in messages:
        found["topics"][channel.topic] = found["topics"].get(channel.topic, 0) + 1
        found["schemas"][channel.topic] = [schema.name, schema.encoding, channel.message_encoding]
        begin = begin or message.log_time
        found["last_time_s"] = round((message.log_time - begin) * 1e-9, 6)
        if channel.topic == "/joint_states":
            found["last"] = joint_state(message.data)
            found["first"] = found["first"] or found["last"]
    return found


def streamed(file):
    schemas, channels = {}, {}
    # Records of no interest to the reader are passed over; the torn end raises.
    for record in StreamReader(file).records:
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, Message):
            channel = channels[record.channel_id]
            yield schemas[channel.schema_id], channel, record


def until_torn(messages):
    try:
        yield from messages
    except (McapError, struct.error, ValueError) as error:
        print(f"torn: {error!r}", file=sys.stderr)


with open(sys.argv[1], "rb") as file:
    if sys.argv[2:] == ["--torn"]:
        found = seen(until_torn(streamed(file)))
    else:
        reader = make_reader(file)
        found = seen(reader.iter_messages())
        summary = reader.get_summary()
        found["counted"] = sum(summary.statistics.channel_message_counts.values())
        found["profile"] = reader.get_header().profile
print(json.dumps(found))
