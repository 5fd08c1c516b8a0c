#!/usr/bin/env python3
"""Holds the drone of hover.yaml at a point, as hover.cc does: reads odom, writes wrench."""
import rclpy
from geometry_msgs.msg import Wrench
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Hover(Node):
    def __init__(self):
        super().__init__("hover")
        self.goal = self.declare_parameter("goal", [1.0, 2.0, 3.0]).value  # m
        self.stiffness = self.declare_parameter("stiffness", 4.0).value  # N/m
        self.damping = self.declare_parameter("damping", 4.0).value  # N*s/m
        self.wrench = self.create_publisher(Wrench, "wrench", 10)
        self.create_subscription(Odometry, "odom", self.hold, 10)

    def hold(self, odometry: Odometry):
        """The drone does not turn, so its own frame, in which the twist is, is the world's."""
        at, velocity = odometry.pose.pose.position, odometry.twist.twist.linear
        wrench = Wrench()
        for axis, goal in zip("xyz", self.goal):
            force = self.stiffness * (goal - getattr(at, axis)) - self.damping * getattr(velocity, axis)
            setattr(wrench.force, axis, force)
        self.wrench.publish(wrench)


def main():
    rclpy.init()
    try:
        rclpy.spin(Hover())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # it was asked to end


if __name__ == "__main__":
    main()
