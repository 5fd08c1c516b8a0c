"""The nodes of one rover, in its namespace. A scenario starts this (two_rovers.yaml), as the rover's computer does when it boots."""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    namespace = LaunchConfiguration("namespace")
    return LaunchDescription([
        DeclareLaunchArgument("namespace", default_value=""),
        Node(package="tcs", executable="rover", namespace=namespace, output="screen"),
    ])
