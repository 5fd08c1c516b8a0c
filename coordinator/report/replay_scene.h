// scene.json, as a page needs it: what is fixed to each other is one.
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
    std::vector<std::size_t> tracks;                 // all of it
    std::map<std::string, std::string> joint_units;  // "rad" or "m" of each joint, by MODEL/JOINT
  };
  std::vector<std::string> tracks;  // names in bodies.csv
  std::vector<Robot> robots;
  std::set<std::string> moving;  // the links that are not fixed to the world
  nlohmann::ordered_json json;
};

// Whether meshes that are only looks are read, each in a process of its own, or what collides
// stands in their stead.
enum class MeshLooks { kRead, kLeftOut };

// What the run of `folder` wrote; nothing of it where there is no such file, as of earlier
// versions.
[[nodiscard]] LoadResult<ReplayScene> ReadReplayScene(const std::string& folder, MeshLooks looks);

// How far moments of a replay of so many seconds are apart, so that it takes about `most_bytes`
// when it is encoded: what a screen shows, or more.
[[nodiscard]] double IntervalOf(const ReplayScene& scene, double end_s, std::size_t most_bytes);

}  // namespace tcs::report
