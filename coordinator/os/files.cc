#include "coordinator/os/files.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace tcs {

namespace {

bool WriteAll(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = write(fd, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

std::string WriteWhole(const std::string& path, const std::string& text, Withstands what) {
  const std::string unfinished = path + ".new";
  UniqueFd fd(open(unfinished.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  // Without the fsync a power cut may leave the new name with nothing in it.
  bool done =
      fd && WriteAll(fd.get(), text) && (what == Withstands::kCrash || fsync(fd.get()) == 0);
  if (done) done = close(fd.Release()) == 0;
  if (done && std::rename(unfinished.c_str(), path.c_str()) == 0) return {};
  return path + " cannot be written: " + strerror(errno) +
         "; make room, or choose another folder with --out";
}

std::string MakeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error && std::filesystem::is_directory(path)) return {};
  return "the folder '" + path +
         "' cannot be made: " + (error ? error.message() : "a file has that name") +
         "; choose another one with --out";
}

std::string AbsolutePathOf(const std::string& path) {
  const std::filesystem::path absolute = std::filesystem::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

void RemoveAll(const std::string& path) {
  std::error_code gone;
  std::filesystem::remove_all(path, gone);
}

std::string CopyFolder(const std::string& from, const std::string& to) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::recursive_directory_iterator entry(from, error);
  for (; !error && entry != fs::recursive_directory_iterator{}; entry.increment(error)) {
    const fs::path copy = to / entry->path().lexically_relative(from);
    const fs::file_type type = entry->symlink_status(error).type();
    if (error) break;
    if (type == fs::file_type::directory) {
      fs::create_directory(copy, entry->path(), error);
    } else if (type == fs::file_type::symlink) {
      fs::copy_symlink(entry->path(), copy, error);
    } else if (type == fs::file_type::regular) {
      fs::copy_file(entry->path(), copy, error);
    }
    if (error)
      return entry->path().string() + " cannot be copied into " + to + ": " + error.message();
  }
  if (error) return from + " cannot be copied: " + error.message();
  return {};
}

std::string LastLine(const std::string& path) {
  constexpr std::streamoff kLookedAt = 4096;
  constexpr std::size_t kLongest = 200;
  std::ifstream file(path, std::ios::ate);
  if (!file) return {};
  file.seekg(std::max<std::streamoff>(0, file.tellg() - kLookedAt));
  std::string last;
  for (std::string line; std::getline(file, line);) {
    // A terminal's colours, or whatever else is none of a sentence's business.
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    last = line.substr(begin, line.find_last_not_of(' ') + 1 - begin);
  }
  if (last.size() > kLongest) last.replace(kLongest, std::string::npos, "…");
  return last;
}

FolderLock::FolderLock(const std::string& path)
    : fd_(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  is_ours_ = !fd_ || flock(fd_.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

}  // namespace tcs
