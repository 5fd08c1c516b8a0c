#include "coordinator/scenario/read_text.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "coordinator/scenario/mistakes.h"

namespace tcs {

namespace {

constexpr std::size_t kLargestFile = 1 << 20;

}  // namespace

std::string ReadText(const std::string& path, const char* of_what) {
  const auto fail = [&](const std::string& why) {
    throw ScenarioMistake{path + ": " + why + "; give the path of " + of_what};
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "re"));
  if (!file) fail(std::string("cannot be read: ") + std::strerror(errno));
  std::string text(kLargestFile + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (std::ferror(file.get())) fail(std::string("cannot be read: ") + std::strerror(errno));
  if (text.size() > kLargestFile) fail("is larger than 1 MiB");
  return text;
}

}  // namespace tcs
