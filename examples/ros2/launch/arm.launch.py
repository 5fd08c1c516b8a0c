"""ros2_control's nodes for the arm, and a trajectory for it. arm.yaml starts this; `update_rate:=1000` for another rate than 500 Hz."""
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

GOAL = ("{joint_names: [shoulder, elbow], points: ["
        "{positions: [0.6, 0.9], velocities: [0.0, 0.0], time_from_start: {sec: 2}}]}")


def generate_launch_description():
    folder = Path(get_package_share_directory("tcs")) / "scenarios"
    description = {"robot_description": (folder / "arm.urdf").read_text()}
    rate = {"update_rate": ParameterValue(LaunchConfiguration("update_rate"), value_type=int)}
    manager = Node(package="controller_manager", executable="ros2_control_node", output="screen",
                   parameters=[str(Path(__file__).parent / "arm_controllers.yaml"), rate])
    publisher = Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[description])
    spawner = Node(package="controller_manager", executable="spawner", output="screen",
                   arguments=["joint_state_broadcaster", "follow"])
    move = ExecuteProcess(output="screen", cmd=[
        "ros2", "action", "send_goal", "/follow/follow_joint_trajectory", "control_msgs/action/FollowJointTrajectory",
        "{trajectory: " + GOAL + "}"])
    return LaunchDescription([
        DeclareLaunchArgument("update_rate", default_value="500"),
        publisher, manager, spawner,
        RegisterEventHandler(OnProcessExit(target_action=spawner, on_exit=[move])),
    ])
