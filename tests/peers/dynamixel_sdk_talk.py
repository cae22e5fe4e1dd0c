"""Pings, reads, writes and sync-writes servos 1 to 3 with ROBOTIS's own SDK, over the port given; prints JSON."""

import json
import sys
import time

from dynamixel_sdk import COMM_RX_TIMEOUT, COMM_SUCCESS, GroupSyncWrite, PacketHandler, PortHandler

port = PortHandler(sys.argv[1])
assert port.openPort() and port.setBaudRate(int(sys.argv[2]))
packets = PacketHandler(1.0)


late = 0


def good(method, *words):
    """Calls until it is answered in time: on a busy machine the SDK's 34 ms may be too short for a simulated servo."""
    global late
    for _ in range(10):
        *value, comm, error = getattr(packets, method)(port, *words)
        if comm == COMM_SUCCESS:
            assert error == 0, packets.getRxPacketError(error)
            return value[0] if value else None
        port.clearPort()
        late += 1
    raise SystemExit(f"{method} {words}: {packets.getTxRxResult(comm)}")


models = [good("ping", id) for id in (1, 2, 3)]
for _ in range(5):
    # On a busy machine what was asked before may be answered only now.
    port.clearPort()
    _, silent, _ = packets.ping(port, 9)
    if silent == COMM_RX_TIMEOUT:
        break
good("write1ByteTxRx", 2, 25, 1)
led = good("read1ByteTxRx", 2, 25)

goals = {1: 400, 2: 512, 3: 700}
group = GroupSyncWrite(port, packets, 30, 2)
for id, goal in goals.items():
    assert group.addParam(id, [goal & 0xFF, goal >> 8])
assert group.txPacket() == COMM_SUCCESS
for id in goals:
    good("write1ByteTxRx", id, 24, 1)
written = [good("read2ByteTxRx", id, 30) for id in goals]
time.sleep(1.5)
reached = [good("read2ByteTxRx", id, 36) for id in goals]

begin = time.monotonic()
count = 100
for _ in range(count):
    good("read2ByteTxRx", 1, 36)
each_ms = (time.monotonic() - begin) / count * 1e3
port.closePort()
print(json.dumps({
    "models": models,
    "silent": silent == COMM_RX_TIMEOUT,
    "led": led,
    "goals": list(goals.values()),
    "written": written,
    "reached": reached,
    "read_ms": each_ms,
    "late": late,
}))
