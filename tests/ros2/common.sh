# Shared by the tests with ROS 2: they are left out where none is set up, and build their nodes, and the package of examples/ros2,
# where one is.
source "$(dirname -- "${BASH_SOURCE[0]}")/../scenario/common.sh"
[[ -n ${AMENT_PREFIX_PATH:-} ]] || { echo "no ROS 2 is set up (AMENT_PREFIX_PATH is empty): source its setup.bash first"; exit 77; }
here=$source_root/tests/ros2
# Into a folder of the build, so that the tests that follow find it there.
ros=$build/ros2
nodes=$ros/nodes
build_nodes() {
  mkdir -p "$ros"
  (
    flock 9
    PATH=$build/bin:$PATH
    { cmake -S "$here/nodes" -B "$nodes" -DCMAKE_BUILD_TYPE=Release && cmake --build "$nodes" -j2; } >"$ros/nodes.said" 2>&1 ||
      fail "the nodes cannot be built: $(tail -n 50 "$ros/nodes.said")"
    {
      cmake -S "$source_root/examples/ros2" -B "$ros/package" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$ros/install" &&
        cmake --build "$ros/package" -j2 && cmake --install "$ros/package"
    } >"$ros/package.said" 2>&1 || fail "examples/ros2 cannot be built: $(tail -n 50 "$ros/package.said")"
  ) 9>"$ros/lock"
}
# `ros2 run tcs`, launch files and `import tcs` find the package.
set_up_package() {
  set +u
  source "$ros/install/share/tcs/local_setup.bash"
  set -u
}
# Nodes write their logs there, meet nobody else's in DDS, and ask no daemon of anybody's.
use_folder() {  # FOLDER
  export ROS_HOME=$1/ros ROS_LOG_DIR=$1/ros/log ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=$((30 + $$ % 70))
}
