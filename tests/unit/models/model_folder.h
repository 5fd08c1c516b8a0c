// A folder for one test, with robots and meshes in it; gone afterwards.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/models/load_urdf.h"

namespace tcs {

class ModelFolder {
 public:
  ModelFolder();
  ~ModelFolder();
  ModelFolder(const ModelFolder&) = delete;
  ModelFolder& operator=(const ModelFolder&) = delete;

  std::string Path(std::string_view name) const { return (path_ / name).string(); }
  // Returns the path. Makes the folders that `name` is in.
  std::string Write(std::string_view name, std::string_view text) const;

 private:
  std::filesystem::path path_;
};

// What came of a file.
struct Loaded {
  RobotModel model;
  std::string mistake;  // the first; empty: none
  std::vector<std::string> mistakes;
  std::vector<std::string> warnings, details;
};
Loaded LoadFile(const std::string& path, const UrdfUse& use = {},
                const std::vector<std::string>& packages = {});

// `text` as FOLDER/robot.urdf; FOLDER/ is left out of the sentences.
Loaded LoadText(const ModelFolder& folder, std::string_view text, const UrdfUse& use = {});

const Link& LinkNamed(const RobotModel& model, std::string_view name);
const Joint& JointNamed(const RobotModel& model, std::string_view name);

// A file of tests/models.
std::string ZooPath(std::string_view name);
std::string TextOfZoo(std::string_view name);

}  // namespace tcs
