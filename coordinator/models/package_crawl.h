// The ROS packages in a folder, however deep: as rospack and colcon find them.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace tcs {

class PackageCrawl {
 public:
  // The folders in `folder` (itself, too) that hold a package.xml with that name, shallow ones
  // first. Nothing is looked for within packages, in hidden folders, and in folders that hold
  // CATKIN_IGNORE, COLCON_IGNORE or AMENT_IGNORE. Looks at 20,000 folders at most; each `folder` is
  // looked at once.
  const std::vector<std::string>& Named(const std::string& package, const std::string& folder);

 private:
  std::map<std::string, std::map<std::string, std::vector<std::string>>> packages_;  // by folder
};

// The <name> in FOLDER/package.xml; empty: there is none.
std::string NameOfPackage(const std::string& folder);

}  // namespace tcs
