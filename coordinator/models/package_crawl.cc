#include "coordinator/models/package_crawl.h"

#include <tinyxml2.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <system_error>

#include "coordinator/models/file_text.h"
#include "coordinator/models/model_mistake.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFolders = 20'000;
constexpr int kMostDepth = 12;

bool IsThere(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool IsIgnored(const fs::path& folder) {
  return folder.filename().string().starts_with(".") || IsThere(folder / "CATKIN_IGNORE") ||
         IsThere(folder / "COLCON_IGNORE") || IsThere(folder / "AMENT_IGNORE");
}

std::map<std::string, std::vector<std::string>> PackagesIn(const std::string& top) {
  std::map<std::string, std::vector<std::string>> packages;
  std::deque<std::pair<fs::path, int>> to_do = {{top, 0}};
  for (std::size_t looked_at = 0; !to_do.empty() && looked_at < kMostFolders; ++looked_at) {
    const auto [folder, depth] = to_do.front();
    to_do.pop_front();
    const std::string name = NameOfPackage(folder);
    if (!name.empty()) packages[name].push_back(folder);
    // A repository may be a package that other packages are in.
    if ((!name.empty() && depth > 0) || depth == kMostDepth) continue;
    std::error_code error;
    std::vector<fs::path> inside;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      std::error_code no_matter;
      if (entry->is_directory(no_matter) && !entry->is_symlink(no_matter)) {
        inside.push_back(entry->path());
      }
    }
    std::sort(inside.begin(), inside.end());  // a folder has no order
    for (fs::path& each : inside) {
      if (!IsIgnored(each)) to_do.emplace_back(std::move(each), depth + 1);
    }
  }
  return packages;
}

}  // namespace

const std::vector<std::string>& PackageCrawl::Named(const std::string& package,
                                                    const std::string& folder) {
  auto known = packages_.find(folder);
  if (known == packages_.end()) known = packages_.emplace(folder, PackagesIn(folder)).first;
  static const std::vector<std::string> kNone;
  const auto found = known->second.find(package);
  return found == known->second.end() ? kNone : found->second;
}

std::string NameOfPackage(const std::string& folder) {
  const std::string path = (fs::path(folder) / "package.xml").string();
  if (!IsThere(path)) return {};
  constexpr std::size_t kMostBytes = 1 << 20;
  try {
    const std::string text = TextOf(path, kMostBytes, "a package.xml");
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return {};
    const auto* root = document.FirstChildElement("package");
    const auto* name = root == nullptr ? nullptr : root->FirstChildElement("name");
    std::string found = name == nullptr || name->GetText() == nullptr ? "" : name->GetText();
    const auto is_space = [](unsigned char c) { return c <= ' '; };
    found.erase(std::remove_if(found.begin(), found.end(), is_space), found.end());
    return found;
  } catch (const ModelMistake&) {
    return {};
  }
}

}  // namespace tcs
