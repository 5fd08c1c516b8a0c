#include "coordinator/models/package_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
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

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string_view WithoutPrefix(std::string_view text, std::string_view prefix) {
  return text.starts_with(prefix) ? text.substr(prefix.size()) : std::string_view();
}

// "%20" as the character that it stands for.
std::string Decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    if (text[i] == '%' && i + 2 < text.size()) {
      const char* const begin = text.data() + i + 1;
      if (std::from_chars(begin, begin + 2, value, 16).ptr == begin + 2 && value != 0) {
        decoded += static_cast<char>(value);
        i += 2;
        continue;
      }
    }
    decoded += text[i];
  }
  return decoded;
}

// The name as it is written, and as it may be meant: a file is rarely called "a%20b", and one from
// Windows has backslashes.
std::vector<std::string> Spellings(std::string_view name) {
  std::vector<std::string> spellings = {std::string(name)};
  const auto add = [&](std::string spelling) {
    if (std::ranges::find(spellings, spelling) == spellings.end()) {
      spellings.push_back(std::move(spelling));
    }
  };
  add(Decoded(name));
  std::string slashes = Decoded(name);
  std::ranges::replace(slashes, '\\', '/');
  add(std::move(slashes));
  return spellings;
}

std::optional<std::string> FirstThatExists(const fs::path& folder,
                                           const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const fs::path path = (folder / name).lexically_normal();
    if (Exists(path)) return path.string();
  }
  return std::nullopt;
}

// The surroundings of a description: the folders that it is in, up to the clone of the repository,
// or a few.
struct Around {
  std::vector<fs::path> folders;       // the nearest first
  std::optional<fs::path> repository;  // packages are looked for in all of it
};

Around AroundOf(const std::string& described_in) {
  constexpr std::size_t kFew = 4;
  Around around;
  std::size_t enough = kFew;
  for (fs::path folder = fs::path(described_in).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    around.folders.push_back(folder);
    if (Exists(folder / ".git")) {
      around.repository = folder;
      break;
    }
    // Without a clone, packages are looked for beside the package that the description is in.
    if (Exists(folder / "package.xml") && folder.parent_path().has_relative_path()) {
      around.repository = folder.parent_path();
      enough = std::max(enough, around.folders.size() + 1);
    }
  }
  if (!around.folders.empty() && around.repository != around.folders.back()) {
    around.folders.resize(std::min(enough, around.folders.size()));
  }
  return around;
}

// "'a', 'b' and 3 more".
std::string ListOf(const std::vector<std::string>& folders) {
  constexpr std::size_t kMost = 6;
  std::string list;
  for (std::size_t i = 0; i < std::min(kMost, folders.size()); ++i) {
    list += (list.empty() ? "" : ", ") + folders[i];
  }
  if (folders.size() > kMost) list += fmt::format(" and {} more", folders.size() - kMost);
  return list;
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

namespace {

// Folders that exist, each once.
class Candidates {
 public:
  void Add(const fs::path& path) {
    if (!IsFolder(path)) return;
    std::string text = path.lexically_normal().string();
    if (std::ranges::find(all_, text) == all_.end()) all_.push_back(std::move(text));
  }
  std::vector<std::string> Take() { return std::move(all_); }

 private:
  std::vector<std::string> all_;
};

}  // namespace

std::vector<std::string> PackagePath::Named(const std::string& package,
                                            const std::string& described_in) const {
  Candidates candidates;
  for (const fs::path folder : folders_) {
    candidates.Add(folder / package);
    // As in ROS, where a folder of the path may be a package itself.
    if (folder.filename() == package || NameOfPackage(folder) == package) candidates.Add(folder);
  }
  for (fs::path folder = fs::path(described_in).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    if (folder.filename() == package || NameOfPackage(folder) == package) candidates.Add(folder);
  }
  for (const fs::path& folder : AroundOf(described_in).folders) candidates.Add(folder / package);
  return candidates.Take();
}

std::vector<std::string> PackagePath::Crawled(const std::string& package,
                                              const std::string& described_in) const {
  Candidates candidates;
  for (const std::string& folder : folders_) {
    for (const std::string& found : crawl_.Named(package, folder)) candidates.Add(found);
  }
  if (const auto repository = AroundOf(described_in).repository) {
    for (const std::string& found : crawl_.Named(package, *repository)) candidates.Add(found);
  }
  return candidates.Take();
}

std::string PackagePath::Find(const std::string& name, const std::string& described_in) const {
  const auto fail = [&name](std::string_view why) {
    throw ModelMistake{fmt::format("{} {}", Quoted(name), why)};
  };
  const std::vector<fs::path> above = AroundOf(described_in).folders;
  std::string_view in_package = WithoutPrefix(name, "package://");
  if (in_package.empty()) in_package = WithoutPrefix(name, "model://");
  if (!in_package.empty()) {
    while (in_package.starts_with('/')) in_package.remove_prefix(1);
    const std::size_t slash = in_package.find('/');
    if (slash == std::string_view::npos || slash + 1 == in_package.size() ||
        in_package.substr(0, slash) == ".." || in_package.substr(0, slash) == ".") {
      fail("names no file in a package; write package://PACKAGE/FILE");
    }
    const std::string package = Decoded(in_package.substr(0, slash));
    std::string_view rest = in_package.substr(slash);
    while (rest.starts_with('/')) rest.remove_prefix(1);
    const std::vector<std::string> files = Spellings(rest);
    std::vector<std::string> candidates = Named(package, described_in);
    for (const std::string& candidate : candidates) {
      if (auto found = FirstThatExists(candidate, files)) return *found;
    }
    for (std::string& candidate : Crawled(package, described_in)) {
      if (auto found = FirstThatExists(candidate, files)) return *found;
      candidates.push_back(std::move(candidate));
    }
    if (!candidates.empty()) return (fs::path(candidates[0]) / files[0]).lexically_normal();
    // A clone under another name, whose package.xml is missing, too.
    for (const fs::path& folder : above) {
      if (auto found = FirstThatExists(folder, files)) return *found;
    }
    std::vector<std::string> searched = folders_;
    for (const fs::path& folder : above) searched.push_back(folder);
    fail(fmt::format(
        "is in the package '{}', which is in none of these folders: {}; add the folder that holds "
        "this package to the model's key packages, or to ROS_PACKAGE_PATH",
        package, ListOf(searched)));
  }
  std::string_view path = WithoutPrefix(name, "file://");
  if (path.empty()) path = WithoutPrefix(name, "file:");
  if (path.empty()) path = name;
  if (path.find("://") != std::string_view::npos) {
    fail("names no file on this computer; write package://PACKAGE/FILE, file:///PATH or a path");
  }
  const std::vector<std::string> files = Spellings(path);
  const fs::path own = fs::path(described_in).parent_path();
  if (auto found = FirstThatExists(own, files)) return *found;
  // A path as seen from the folder of its package: some exporters write that.
  if (fs::path(path).is_relative()) {
    for (const fs::path& folder : above) {
      if (auto found = FirstThatExists(folder, files)) return *found;
    }
  }
  return (own / path).lexically_normal();
}

}  // namespace tcs
