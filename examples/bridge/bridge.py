"""Speaks a flight stack's binary protocol for the drone: an ideal client between its body and its controller.

The controller, on a robot whose computing takes time, knows frames of its own: sync byte, type, length, payload, sum.
"""
import json
import os
import select
import socket
import struct

SENSORS, MOTORS, STACK = ("127.0.0.1", 21030), ("127.0.0.1", 21031), ("127.0.0.1", 21032)
SYNC, IMU, THRUST = 0xFE, 1, 2


def frame(kind, payload):
    body = bytes([kind, len(payload)]) + payload
    return bytes([SYNC]) + body + bytes([sum(body) & 0xFF])


def frames(buffer):
    """Takes the whole frames out of the buffer; what is none is passed over."""
    while len(buffer) >= 4:
        size = buffer[2] + 4
        if buffer[0] != SYNC or (len(buffer) >= size and sum(buffer[1:size - 1]) & 0xFF != buffer[size - 1]):
            del buffer[0]
        elif len(buffer) < size:
            return
        else:
            yield buffer[1], bytes(buffer[3:size - 1])
            del buffer[:size]


body = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
body.bind(SENSORS)
server = socket.create_server(STACK)
stack, _ = server.accept()
received = bytearray()
while True:
    for ready in select.select([body, stack], [], [])[0]:
        if ready is body:
            state = json.loads(body.recv(4096))["bodies"]["drone"]
            stack.sendall(frame(IMU, struct.pack("<6f", *state["position"], *state["linear_velocity"])))
        else:
            received += stack.recv(4096) or os._exit(0)
            for kind, payload in frames(received):
                if kind == THRUST:
                    body.sendto(json.dumps({"force": struct.unpack("<3f", payload)}).encode(), MOTORS)
