#include "coordinator/report/write.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

extern char** environ;

namespace tcs::report {

namespace {

namespace fs = std::filesystem;

std::string WriteFile(const std::string& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file.fail()) return {};
  return fmt::format("{} cannot be written{}{}; choose another place with --out", path,
                     errno != 0 ? ": " : "", errno != 0 ? strerror(errno) : "");
}

// 144 dots an inch: sharp on a screen and in a document.
std::string ConvertToPng(const std::string& svg, const std::string& png) {
  const char* const command[] = {"rsvg-convert", "--zoom", "2",         "--output",
                                 png.c_str(),    "--",     svg.c_str(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  pid_t pid = 0;
  const int error =
      posix_spawnp(&pid, command[0], &actions, nullptr, const_cast<char* const*>(command), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) {
    return "PNGs need rsvg-convert, which is not installed; run apt-get install librsvg2-bin, or "
           "use --figures svg";
  }
  int status = 0;
  if (error != 0 || waitpid(pid, &status, 0) != pid || status != 0) {
    return fmt::format("rsvg-convert could not make {} of {}", png, svg);
  }
  return {};
}

}  // namespace

std::string WritePage(const Page& page, const std::string& path, FigureFiles figures,
                      std::vector<std::string>* written) {
  if (std::string error = WriteFile(path, page.html); !error.empty()) return error;
  written->push_back(path);
  if (figures == FigureFiles::kNone) return {};
  const std::string stem = fs::path(path).replace_extension().string();
  for (const auto& [name, svg] : page.svgs) {
    const std::string svg_path = fmt::format("{}-{}.svg", stem, name);
    if (std::string error = WriteFile(svg_path, svg); !error.empty()) return error;
    if (figures == FigureFiles::kSvg) {
      written->push_back(svg_path);
      continue;
    }
    const std::string png_path = fmt::format("{}-{}.png", stem, name);
    const std::string error = ConvertToPng(svg_path, png_path);
    std::error_code ignored;
    fs::remove(svg_path, ignored);
    if (!error.empty()) return error;
    written->push_back(png_path);
  }
  return {};
}

}  // namespace tcs::report
