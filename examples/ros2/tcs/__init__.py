"""tcs for ROS 2: tcs.launch has the action by which a launch file runs a scenario."""
