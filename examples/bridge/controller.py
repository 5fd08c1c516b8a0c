"""A flight stack of a few lines: holds the drone at a point. It knows its binary protocol and nothing else."""
import socket
import struct
import time

GOAL = (1.0, 2.0, 3.0)
SYNC, IMU, THRUST = 0xFE, 1, 2

link = socket.socket()
while link.connect_ex(("127.0.0.1", 21032)):
    link.close()
    time.sleep(0.01)
    link = socket.socket()
stream = link.makefile("rb")
while True:
    head = stream.read(3)
    payload = stream.read(head[2] + 1)[:-1]
    if head[0] != SYNC or head[1] != IMU:
        continue
    *at, vx, vy, vz = struct.unpack("<6f", payload)
    force = [4 * (goal - x) - 4 * v for goal, x, v in zip(GOAL, at, (vx, vy, vz))]
    body = bytes([THRUST, 12]) + struct.pack("<3f", *force)
    link.sendall(bytes([SYNC]) + body + bytes([sum(body) & 0xFF]))
