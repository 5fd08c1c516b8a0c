#include "coordinator/models/file_text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "coordinator/models/model_mistake.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

[[noreturn]] void FailToRead(const std::string& path, int error, const char* what) {
  throw ModelMistake{
      fmt::format("{}: cannot be read: {}; give the path of {}", path, std::strerror(error), what)};
}

// The size of the opened file in bytes.
std::size_t CheckOpened(int fd, const std::string& path, std::size_t most_bytes, const char* what) {
  struct stat status;
  if (fstat(fd, &status) != 0) FailToRead(path, errno, what);
  if (!S_ISREG(status.st_mode)) {
    throw ModelMistake{fmt::format("{}: is not a regular file; give the path of {}", path, what)};
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > most_bytes) {
    throw ModelMistake{fmt::format("{}: has {} bytes, more than the {} MiB that tcs takes for {}",
                                   path, size, most_bytes >> 20, what)};
  }
  return size;
}

UniqueFd Open(const std::string& path, const char* what) {
  UniqueFd fd(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!fd) FailToRead(path, errno, what);
  return fd;
}

}  // namespace

std::string TextOf(const std::string& path, std::size_t most_bytes, const char* what) {
  const UniqueFd fd = Open(path, what);
  // Reads no more than the size at the opening, so that a file that grows meanwhile is not read for
  // ever.
  std::string text(CheckOpened(fd.get(), path, most_bytes, what), '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t n = read(fd.get(), text.data() + size, text.size() - size);
    if (n < 0 && errno != EINTR) FailToRead(path, errno, what);
    if (n == 0) break;
    if (n > 0) size += static_cast<std::size_t>(n);
  }
  text.resize(size);
  return text;
}

void CheckFile(const std::string& path, std::size_t most_bytes, const char* what) {
  const UniqueFd fd = Open(path, what);
  CheckOpened(fd.get(), path, most_bytes, what);
}

}  // namespace tcs
