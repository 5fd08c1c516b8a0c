"""Holds the drone at a point: reads its state on one UDP port, answers with a force on another.

An ordinary program: nothing here knows of tcs. Whoever sends {"goal": [x, y, z]} moves the point.
"""
import json
import socket

SENSORS = ("127.0.0.1", 21010)
COMMANDS = ("127.0.0.1", 21011)
STIFFNESS, DAMPING = 4.0, 4.0  # N/m, N*s/m: critically damped at 1 kg

goal = [1.0, 2.0, 3.0]
sensors = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sensors.bind(SENSORS)
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
while True:
    message = json.loads(sensors.recv(65536))
    if "goal" in message:
        goal = message["goal"]
        continue
    drone = message["bodies"]["drone"]
    force = [STIFFNESS * (g - x) - DAMPING * v
             for g, x, v in zip(goal, drone["position"], drone["linear_velocity"])]
    commands.sendto(json.dumps({"force": force}).encode(), COMMANDS)
