"""Runs hover.yaml: `ros2 launch tcs hover.launch.py speed:=0.01`."""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

from tcs.launch import run


def generate_launch_description():
    scenario = PathJoinSubstitution([FindPackageShare("tcs"), "scenarios", "hover.yaml"])
    return LaunchDescription([
        DeclareLaunchArgument("speed", default_value="1", description="of the drone's computer, in shares of this one"),
        DeclareLaunchArgument("out", default_value="out", description="the folder of the results"),
        run(scenario, set={"robots.drone.cpu.speed": LaunchConfiguration("speed")}, out=LaunchConfiguration("out")),
    ])
