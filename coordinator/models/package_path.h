// Where the files are that a robot's description names: ROS packages.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/models/package_crawl.h"

namespace tcs {

class PackagePath {
 public:
  // `folders` (absolute) come first, then the folders of ROS_PACKAGE_PATH, then share/ of the
  // folders of AMENT_PREFIX_PATH, as they are in the environment now.
  explicit PackagePath(std::vector<std::string> folders);

  // The absolute path of the file that `name` means in the description `described_in`: "package://"
  // (or "model://"), "file://", or a path, seen from the description's folder. A package is a
  // folder whose package.xml has that name, in one of the folders, however deep; a folder of its
  // name in one of them, or one of them itself; or one that is found upwards from the description,
  // as in a clone of the repository that it is in. Throws ModelMistake, one sentence without a
  // place, with the folders that were searched, where there is no such package. Of several
  // packages, the first one that has the file counts.
  std::string Find(const std::string& name, const std::string& described_in) const;

 private:
  // Folders in which the package may be, the likeliest first: where its name says so, and where a
  // look into all folders finds it.
  std::vector<std::string> Named(const std::string& package, const std::string& described_in) const;
  std::vector<std::string> Crawled(const std::string& package,
                                   const std::string& described_in) const;

  std::vector<std::string> folders_;
  mutable PackageCrawl crawl_;
};

}  // namespace tcs
