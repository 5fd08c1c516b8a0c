#include "coordinator/models/xacro.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <vector>

#include "coordinator/models/in_child.h"
#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_xml.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

constexpr unsigned kMostXacroSeconds = 60;
constexpr std::size_t kMostExpandedBytes = 8 << 20;
// The child's answer begins with one of these.
constexpr char kExpanded = 'X', kFailed = 'F';

std::string PathOfXacro() {
  const char* value = std::getenv("PATH");
  std::string_view rest = value == nullptr ? "" : value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    std::string path = std::string(rest.substr(0, end)) + "/xacro";
    struct stat status;
    if (end > 0 && stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
        access(path.c_str(), X_OK) == 0) {
      return path;
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

std::string ContentOf(int fd) {
  std::string text;
  char piece[65'536];
  if (lseek(fd, 0, SEEK_SET) != 0) return text;
  for (ssize_t n; text.size() < kMostExpandedBytes && (n = read(fd, piece, sizeof piece)) > 0;) {
    text.append(piece, static_cast<std::size_t>(n));
  }
  return text;
}

// The line that says what is wrong: xacro's own "error: …", else the last one, of a traceback.
std::string WhatItSays(std::string text) {
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.pop_back();
  constexpr std::string_view kError = "error: ";
  const std::size_t error = text.find(kError);
  if (error != std::string::npos) {
    const std::size_t begin = error + kError.size();
    return text.substr(begin, text.find('\n', begin) - begin);
  }
  const std::size_t end = text.rfind('\n');
  return end == std::string::npos ? text : text.substr(end + 1);
}

// Runs in the child.
std::string Run(std::vector<char*> words) {
  const UniqueFd out(memfd_create("xacro", MFD_CLOEXEC)), err(memfd_create("xacro", MFD_CLOEXEC));
  if (!out || !err) return std::string(1, kFailed) + "there is no memory for what it says";
  const pid_t child = fork();
  if (child == 0) {
    dup2(out.get(), STDOUT_FILENO);
    dup2(err.get(), STDERR_FILENO);
    execv(words[0], words.data());
    _exit(127);
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    return kExpanded + ContentOf(out.get());
  }
  const std::string said = WhatItSays(ContentOf(err.get()));
  return kFailed + (said.empty() ? std::string("it fails without a word") : said);
}

}  // namespace

bool HasXacro() { return !PathOfXacro().empty(); }

std::string ExpandedByXacro(const std::string& path,
                            const std::map<std::string, std::string>& arguments) {
  std::vector<std::string> texts = {PathOfXacro(), path};
  for (const auto& [name, value] : arguments) texts.push_back(name + ":=" + value);
  std::vector<char*> words;
  for (std::string& text : texts) words.push_back(text.data());
  words.push_back(nullptr);
  const ChildWork done =
      DoInChild([&] { return Run(words); }, kMostXacroSeconds, kMostExpandedBytes);
  const auto fail = [&](std::string_view why) {
    throw ModelMistake{fmt::format(
        "{}: `{}` does not expand it: {}; correct the file, or give its arguments in the model's "
        "key xacro",
        path, texts[0], Quoted(why))};
  };
  if (!done.failure.empty()) fail(done.failure);
  if (done.result.empty()) fail("it says nothing");
  if (done.result[0] != kExpanded) fail(std::string_view(done.result).substr(1));
  return done.result.substr(1);
}

}  // namespace tcs
