#include "coordinator/models/hull_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/sha.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "coordinator/os/files.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

// A change of the hulls that are found of meshes, or of how hulls are packed, needs another
// version.
constexpr int kHullVersion = 1;
constexpr std::size_t kLeastCachedBytes = 64 << 10;
constexpr std::size_t kMostCachedBytes = 1 << 20;
constexpr std::size_t kDigits = 2 * SHA256_DIGEST_LENGTH;

std::string DigestOf(const std::string& text) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest;
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  std::string hex;
  for (const unsigned char byte : digest) hex += fmt::format("{:02x}", byte);
  return hex;
}

std::string CacheFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return std::string(cache) + "/tcs/hulls";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return std::string(home) + "/.cache/tcs/hulls";
  return {};
}

// The text of a file that no other user has written; empty: there is no such file.
std::string OwnText(const std::string& path) {
  const UniqueFd fd(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat status;
  if (!fd || fstat(fd.get(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  if (status.st_uid != geteuid() || static_cast<std::size_t>(status.st_size) > kMostCachedBytes) {
    return {};
  }
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  const ssize_t size = read(fd.get(), text.data(), text.size());
  return size == static_cast<ssize_t>(text.size()) ? text : std::string();
}

}  // namespace

HullCache::HullCache(const std::string& text, const std::string& reader,
                     std::size_t most_vertices) {
  if (text.size() < kLeastCachedBytes) return;
  folder_ = CacheFolder();
  if (folder_.empty()) return;
  path_ =
      fmt::format("{}/{}.{}.{}.{}", folder_, DigestOf(text), reader, most_vertices, kHullVersion);
}

std::string HullCache::Find() const {
  if (path_.empty()) return {};
  std::string text = OwnText(path_);
  if (text.size() <= kDigits) return {};
  std::string hull = text.substr(kDigits);
  return DigestOf(hull) == text.substr(0, kDigits) ? hull : std::string();
}

// Two runs may keep a hull at once: each run writes a file of its own, and renames it.
void HullCache::Keep(const std::string& hull) const {
  if (path_.empty() || hull.size() + kDigits > kMostCachedBytes) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const std::string own = fmt::format("{}.{}", path_, getpid());
  const bool is_written = WriteWhole(own, DigestOf(hull) + hull, Withstands::kCrash).empty();
  if (is_written && std::rename(own.c_str(), path_.c_str()) == 0) return;
  unlink(own.c_str());
  unlink((own + ".new").c_str());
}

}  // namespace tcs
