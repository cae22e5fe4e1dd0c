"""Drives servos 1 to 3 of Protocol 2.0 with ROBOTIS's own SDK, over the port given; prints JSON.

The SDK's own transmission does not stuff (it drops what `addStuffing` returns), and its
`removeStuffing` loses a byte behind a stuffed run in some packets: neither case occurs here. What a
servo sends stuffed is compared with `addStuffing` and `updateCRC` called directly.
"""

import json
import sys
import time

from dynamixel_sdk import (
    COMM_RX_TIMEOUT,
    COMM_SUCCESS,
    GroupBulkRead,
    GroupSyncRead,
    GroupSyncWrite,
    PacketHandler,
    PortHandler,
)

port = PortHandler(sys.argv[1])
assert port.openPort() and port.setBaudRate(int(sys.argv[2]))
packets = PacketHandler(2.0)
IDS = (1, 2, 3)
late = 0


def good(method, *words):
    """Calls until it is answered in time: on a busy machine the SDK's 34 ms may be too short for a simulated servo."""
    global late
    for _ in range(20):
        *value, comm, error = getattr(packets, method)(port, *words)
        if comm == COMM_SUCCESS:
            assert error == 0, (method, words, packets.getRxPacketError(error))
            return value[0] if value else None
        port.clearPort()
        late += 1
    raise SystemExit(f"{method} {words}: {packets.getTxRxResult(comm)}")


def group(read):
    """A group read, tried as `good` does."""
    global late
    for _ in range(20):
        if read() == COMM_SUCCESS:
            return
        port.clearPort()
        late += 1
    raise SystemExit("a group read is not answered")


def signed(value, bits):
    return value - (1 << bits) if value >> (bits - 1) else value


models = [good("ping", id) for id in IDS]
for _ in range(5):
    # On a busy machine what was asked before may be answered only now.
    port.clearPort()
    _, silent, _ = packets.ping(port, 9)
    if silent == COMM_RX_TIMEOUT:
        break
for _ in range(5):
    found, comm = packets.broadcastPing(port)
    if len(found) == 3:
        break
broadcast = sorted(found)
good("write1ByteTxRx", 2, 65, 1)
led = good("read1ByteTxRx", 2, 65)

# A goal, EEPROM while torque is on, and the code that says so.
for id in IDS:
    good("write1ByteTxRx", id, 64, 1)
locked = (COMM_RX_TIMEOUT, 0)
for _ in range(20):
    locked = packets.write1ByteTxRx(port, 1, 11, 4)
    if locked[0] == COMM_SUCCESS:
        break
goals = {1: 1800, 2: 2048, 3: 2300}
sync = GroupSyncWrite(port, packets, 116, 4)
for id, goal in goals.items():
    assert sync.addParam(id, list(goal.to_bytes(4, "little", signed=True)))
assert sync.txPacket() == COMM_SUCCESS
written = [good("read4ByteTxRx", id, 116) for id in IDS]
time.sleep(1.5)

state = GroupSyncRead(port, packets, 126, 10)
for id in IDS:
    assert state.addParam(id)
group(state.txRxPacket)
slow = [[signed(state.getData(id, 126, 2), 16), state.getData(id, 132, 4)] for id in IDS]
group(state.fastSyncRead)
fast = [[signed(state.getData(id, 126, 2), 16), state.getData(id, 132, 4)] for id in IDS]
bulk = GroupBulkRead(port, packets)
assert bulk.addParam(1, 132, 4) and bulk.addParam(2, 144, 2) and bulk.addParam(3, 146, 1)
group(bulk.txRxPacket)
bulk = [bulk.getData(1, 132, 4), bulk.getData(2, 144, 2), bulk.getData(3, 146, 1)]

# The bus watchdog trips while nothing is said, and refuses goals until it is cleared.
good("write1ByteTxRx", 1, 98, 5)
time.sleep(0.4)
tripped = good("read1ByteTxRx", 1, 98)
refused = (COMM_RX_TIMEOUT, 0)
for _ in range(20):
    refused = packets.write4ByteTxRx(port, 1, 116, 1900)
    if refused[0] == COMM_SUCCESS:
        break
good("write1ByteTxRx", 1, 98, 0)
good("write4ByteTxRx", 1, 116, 1900)

# Stuffing by the SDK's own functions, which its transmission leaves out.
stuffed = []
for data in ([0xFF, 0xFF, 0xFD, 0x00], [0xFB, 0xFF, 0xFD, 0xFF, 0xFF, 0xFF, 0xFD, 0x08]):
    packet = [0xFF, 0xFF, 0xFD, 0x00, 1, 0, 0, 3, 116, 0, *data, 0, 0]
    packet[5] = len(packet) - 7
    packet = packets.addStuffing(packet) or packet
    crc = packets.updateCRC(0, packet, len(packet) - 2)
    packet[-2:] = [crc & 0xFF, crc >> 8]
    stuffed.append(packet)
port.closePort()
print(json.dumps({
    "models": models,
    "silent": silent == COMM_RX_TIMEOUT,
    "broadcast": broadcast,
    "led": led,
    "locked": locked[1],
    "goals": list(goals.values()),
    "written": written,
    "slow": slow,
    "fast": fast,
    "bulk": bulk,
    "tripped": tripped,
    "refused": refused[1],
    "stuffed": stuffed,
    "late": late,
}))
