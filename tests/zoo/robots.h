// The zoo: robots in the style of those that people bring, with what their files have beside the
// letter of URDF. Those of tests/models belong to it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tcs::zoo {

struct Robot {
  std::string name;
  std::string urdf;  // text
  bool has_fixed_base = false;
  double height_m = 0;  // of its root above the floor, at the start
  bool touches_itself = false;
};

std::vector<Robot> Arms();
std::vector<Robot> Bases();
std::vector<Robot> Legged();
std::vector<Robot> Humanoids();
std::vector<Robot> Hands();
std::vector<Robot> Craft();     // that fly or dive
std::vector<Robot> Machines();  // what is left
std::vector<Robot> OfFiles();   // those of tests/models
std::vector<Robot> All();

// As in a clone of a repository of descriptions: a package for each robot, and the packages that
// they name. Returns the scenario in which it stands on a floor: NAME.yaml in `folder`.
std::filesystem::path WriteScenario(const std::filesystem::path& folder, const Robot& robot);

// The scenario in which the robot of a URDF file hangs by its base, above no floor.
std::filesystem::path WriteScenarioOf(const std::filesystem::path& folder,
                                      const std::filesystem::path& urdf);

// The file that WriteScenario writes for it.
std::filesystem::path UrdfOf(const std::filesystem::path& folder, const Robot& robot);

}  // namespace tcs::zoo
