"""Holds the drone one metre above the ground: reads its state on one UDP port, and answers with a
force on another. An ordinary program: nothing here knows of tcs.
"""
import json
import socket

MASS, GRAVITY = 1.0, 9.81  # kg, m/s^2
STIFFNESS, DAMPING = 9.0, 6.0  # N/m, N*s/m
GOAL = (0.0, 0.0, 1.0)  # m

sensors = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sensors.bind(("127.0.0.1", 21010))
thrust = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
while True:
    drone = json.loads(sensors.recv(65536))["bodies"]["drone"]
    force = [STIFFNESS * (goal - x) - DAMPING * v
             for goal, x, v in zip(GOAL, drone["position"], drone["linear_velocity"])]
    force[2] += MASS * GRAVITY
    thrust.sendto(json.dumps({"force": force}).encode(), ("127.0.0.1", 21011))
