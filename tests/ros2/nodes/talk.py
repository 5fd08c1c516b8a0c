#!/usr/bin/env python3
"""A talker and a listener of rclpy:
    talk.py talker COUNT PERIOD_US    writes so many numbers, one each period, once somebody listens
    talk.py listener COUNT            takes them, and says how many came, in order, and at which rate"""
import sys
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int64MultiArray

ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)


class Talker(Node):
    def __init__(self, count, period):
        super().__init__("talker")
        self.count, self.next = count, 0
        self.publisher = self.create_publisher(Int64MultiArray, "numbers", ALL)
        self.create_timer(period, self.tick)

    def tick(self):
        heard = self.publisher.get_subscription_count() > 0
        if self.next == self.count and not heard:
            raise ExternalShutdownException
        if self.next < self.count and heard:
            self.publisher.publish(Int64MultiArray(data=[self.next, time.time_ns()]))
            self.next += 1


class Listener(Node):
    def __init__(self, count):
        super().__init__("listener")
        self.count, self.numbers, self.sent, self.late = count, [], [], []
        self.create_subscription(Int64MultiArray, "numbers", self.take, ALL)

    def take(self, message):
        self.late.append(time.time_ns() - message.data[1])
        self.numbers.append(message.data[0])
        self.sent.append(message.data[1])
        if len(self.numbers) < self.count:
            return
        order = "in order" if self.numbers == list(range(self.count)) else "out of order"
        late, rate = sorted(self.late), (self.count - 1) / (self.sent[-1] - self.sent[0]) * 1e9
        print(f"{self.count} {order}, late by {late[0] / 1e3:.1f} to {late[-1] / 1e3:.1f} us, "
              f"half by {late[len(late) // 2] / 1e3:.1f}, at {rate:.1f} Hz")
        raise ExternalShutdownException


def main():
    rclpy.init()
    role, count = sys.argv[1], int(sys.argv[2])
    node = Talker(count, int(sys.argv[3]) * 1e-6) if role == "talker" else Listener(count)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
