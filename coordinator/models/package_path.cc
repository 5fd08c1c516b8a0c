#include "coordinator/models/package_path.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_xml.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;

void AppendFromEnvironment(const char* variable, const char* inside,
                           std::vector<std::string>* folders) {
  const char* value = std::getenv(variable);
  std::string_view rest = value == nullptr ? "" : value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders->push_back(fs::path(rest.substr(0, end)) / inside);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

std::string_view WithoutPrefix(std::string_view text, std::string_view prefix) {
  return text.starts_with(prefix) ? text.substr(prefix.size()) : std::string_view();
}

std::optional<fs::path> FindPackage(const std::string& package,
                                    const std::vector<std::string>& folders,
                                    const std::string& described_in) {
  for (const fs::path folder : folders) {
    if (IsFolder(folder / package)) return folder / package;
    // As in ROS, where a folder of the path may be a package itself.
    if (folder.filename() == package && IsFolder(folder)) return folder;
  }
  for (fs::path above = fs::path(described_in).parent_path(); above.has_relative_path();
       above = above.parent_path()) {
    if (above.filename() == package) return above;
  }
  return std::nullopt;
}

}  // namespace

PackagePath::PackagePath(std::vector<std::string> folders) : folders_(std::move(folders)) {
  AppendFromEnvironment("ROS_PACKAGE_PATH", "", &folders_);
  AppendFromEnvironment("AMENT_PREFIX_PATH", "share", &folders_);
  // "/a/b/" has no file name, "/a/b" has.
  for (std::string& folder : folders_) {
    while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  }
}

std::string PackagePath::Find(const std::string& name, const std::string& described_in) const {
  const auto fail = [&name](std::string_view why) {
    throw ModelMistake{fmt::format("{} {}", Quoted(name), why)};
  };
  std::string_view in_package = WithoutPrefix(name, "package://");
  if (in_package.empty()) in_package = WithoutPrefix(name, "model://");
  if (!in_package.empty()) {
    const std::size_t slash = in_package.find('/');
    if (slash == 0 || slash == std::string_view::npos || slash + 1 == in_package.size()) {
      fail("names no file in a package; write package://PACKAGE/FILE");
    }
    const std::string package(in_package.substr(0, slash));
    const auto found = FindPackage(package, folders_, described_in);
    if (!found) {
      fail(fmt::format(
          "is in the package '{}', which is in none of {} folders of packages; add the "
          "folder that holds this package to the model's key packages, or to ROS_PACKAGE_PATH",
          package, folders_.size()));
    }
    return (*found / in_package.substr(slash + 1)).lexically_normal();
  }
  const std::string_view absolute = WithoutPrefix(name, "file://");
  if (absolute.empty() && name.find("://") != std::string::npos) {
    fail("names no file on this computer; write package://PACKAGE/FILE, file:///PATH or a path");
  }
  const fs::path path = absolute.empty() ? fs::path(name) : fs::path(absolute);
  return (fs::path(described_in).parent_path() / path).lexically_normal();
}

}  // namespace tcs
