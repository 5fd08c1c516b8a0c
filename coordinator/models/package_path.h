// Where the files are that a robot's description names: ROS packages.
#pragma once

#include <string>
#include <vector>

namespace tcs {

class PackagePath {
 public:
  // `folders` (absolute) come first, then those of ROS_PACKAGE_PATH, then share/ of those of
  // AMENT_PREFIX_PATH, as they are in the environment now.
  explicit PackagePath(std::vector<std::string> folders);

  // The absolute path of the file that `name` means in the description `described_in`: "package://"
  // (or "model://"), "file://", or a path, seen from the description's folder. A package is a
  // folder of its name in one of the folders, one of the folders itself, or a folder that the
  // description is in. Throws ModelMistake, one sentence without a place, where there is no such
  // package.
  std::string Find(const std::string& name, const std::string& described_in) const;

 private:
  std::vector<std::string> folders_;
};

}  // namespace tcs
