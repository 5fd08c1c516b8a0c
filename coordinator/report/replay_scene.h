// scene.json, as a page needs it: links that are fixed to each other are one.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"

namespace tcs::report {

struct ReplayScene {
  struct Robot {
    std::string name;
    std::size_t root = 0;
    std::vector<std::size_t> tracks;                 // all tracks of the robot
    std::map<std::string, std::string> joint_units;  // "rad" or "m" of each joint, by MODEL/JOINT
  };
  std::vector<std::string> tracks;  // names in bodies.csv
  std::vector<Robot> robots;
  std::set<std::string> moving;  // the links that are not fixed to the world
  nlohmann::ordered_json json;
};

// Whether meshes that are only looks are read, each in a process of its own, or the collision
// shapes stand in their stead.
enum class MeshLooks { kRead, kLeftOut };

// The scene that the run of `folder` wrote; empty where there is no such file, as of earlier
// versions.
[[nodiscard]] LoadResult<ReplayScene> ReadReplayScene(const std::string& folder, MeshLooks looks);

// How far moments of a replay of so many seconds are apart, so that the replay takes about
// `most_bytes` when it is encoded: the interval that a screen shows, or more.
[[nodiscard]] double IntervalOf(const ReplayScene& scene, double end_s, std::size_t most_bytes);

}  // namespace tcs::report
