"""Sends the drone to where the target is: of very many random points, the one nearest to it.

The search takes about half a second of a processor, and the target does not wait for it.
"""
import json
import random
import socket
import sys

SENSORS = ("127.0.0.1", 21020)
CONTROLLER = ("127.0.0.1", 21010)
POINTS = 250_000
REACH = 4.0  # m

random.seed(int(sys.argv[1]))
sensors = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sensors.bind(SENSORS)
while True:
    newest = sensors.recv(65536)
    try:
        while True:
            newest = sensors.recv(65536, socket.MSG_DONTWAIT)
    except BlockingIOError:
        pass
    state = json.loads(newest)
    x, y, z = state["bodies"]["target"]["position"]
    nearest, goal = float("inf"), None
    for _ in range(POINTS):
        at = [REACH * (2 * random.random() - 1) for _ in range(3)]
        distance = (at[0] - x) ** 2 + (at[1] - y) ** 2 + (at[2] - z) ** 2
        if distance < nearest:
            nearest, goal = distance, at
    sensors.sendto(json.dumps({"goal": goal}).encode(), CONTROLLER)
    print(f"from what was seen at {state['time']:.2f} s: {goal}", flush=True)
