#include "coordinator/scenario/executable.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "coordinator/port/unique_fd.h"
#include "coordinator/scenario/elf_file.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;

// The kernel follows no more '#!' lines than this, one leading to the next.
constexpr int kMostInterpreters = 4;
// The kernel reads no more than this of a '#!' line.
constexpr std::size_t kLongestHashBang = 255;

LoadError Mistake(const std::string& path, std::string_view what) {
  return LoadError{"'" + path + "' " + std::string(what)};
}

std::string Absolute(const std::string& name, const std::string& folder) {
  return (fs::path(folder) / name).lexically_normal().string();
}

// Why `path` is not a file that may be executed; 0 if it is one.
int WhyNotExecutable(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return errno;
  if (S_ISDIR(status.st_mode)) return EISDIR;
  if (!S_ISREG(status.st_mode)) return EACCES;
  return access(path.c_str(), X_OK) == 0 ? 0 : errno;
}

LoadError NotExecutable(const std::string& path, int error) {
  switch (error) {
    case EISDIR:
      return Mistake(path, "is a folder, not a program; name the file in it");
    case EACCES:
      return Mistake(path, "is not executable; make it so with chmod +x");
    default:
      return Mistake(path, std::string("cannot be run: ") + std::strerror(error));
  }
}

// The interpreter that a script's '#!' line names; none without such a line.
std::optional<std::string> ReadHashBang(int fd) {
  char head[kLongestHashBang];
  const ssize_t size = pread(fd, head, sizeof head, 0);
  std::string_view line(head, size > 0 ? static_cast<std::size_t>(size) : 0);
  if (!line.starts_with("#!")) return std::nullopt;
  line = line.substr(2, line.find('\n') - 2);
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return "";
  line.remove_prefix(begin);
  return std::string(line.substr(0, line.find_first_of(" \t")));
}

std::optional<LoadError> CheckPrivilege(const std::string& path, int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0)
    return Mistake(path, "cannot be read; check whether it is being replaced, and try again");
  constexpr std::string_view kRemedy =
      ", and the loader preloads nothing into such a program; run a copy of it without";
  if ((status.st_mode & S_ISUID) != 0) {
    return Mistake(path, "is set-uid" + std::string(kRemedy) + " that bit");
  }
  // Without group execution the bit once meant mandatory locking, and gives nobody anything.
  if ((status.st_mode & S_ISGID) != 0 && (status.st_mode & S_IXGRP) != 0) {
    return Mistake(path, "is set-gid" + std::string(kRemedy) + " that bit");
  }
  if (geteuid() != 0 && fgetxattr(fd, "security.capability", nullptr, 0) > 0) {
    return Mistake(path, "carries file capabilities" + std::string(kRemedy) + " them");
  }
  return std::nullopt;
}

std::optional<LoadError> CheckElf(const std::string& path, const ElfFile& elf) {
  if (!elf.is_64_bit)
    return Mistake(path, "is a 32-bit program; tcs runs 64-bit x86 ones: rebuild it");
  if (!elf.is_x86_64) {
    return Mistake(path, "is for another kind of processor; tcs runs x86-64 programs: rebuild it");
  }
  if (!elf.is_program) return Mistake(path, "is an ELF file but not a program; link it first");
  if (!elf.loader) {
    return Mistake(path,
                   "is statically linked, so nothing can be preloaded into it; link it dynamically "
                   "(without -static or -static-pie)");
  }
  if (elf.loader->find("ld-musl") != std::string::npos) {
    return Mistake(path,
                   "is linked against musl; tcs runs programs of the GNU C library: "
                   "rebuild it against that");
  }
  if (access(elf.loader->c_str(), X_OK) != 0) {
    return Mistake(path, "needs the loader '" + *elf.loader + "', which is missing; install it");
  }
  return std::nullopt;
}

std::optional<LoadError> Check(const std::string& path, int depth) {
  if (const int error = WhyNotExecutable(path); error != 0) return NotExecutable(path, error);
  const UniqueFd file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) {
    return Mistake(
        path, "may not be read, so tcs cannot tell how it is linked; make it readable (chmod +r)");
  }
  if (auto error = CheckPrivilege(path, file.get())) return error;
  if (const auto elf = ReadElfFile(file.get())) return CheckElf(path, *elf);

  const auto interpreter = ReadHashBang(file.get());
  if (!interpreter) {
    return Mistake(path, "is neither an ELF program nor a script; begin a script with a '#!' line");
  }
  if (interpreter->empty()) {
    return Mistake(path, "has a '#!' line without an interpreter; name one, like '#!/bin/sh'");
  }
  if (interpreter->ends_with('\r')) {
    return Mistake(path, "has Windows line ends, so its '#!' line names no program; convert it");
  }
  if (depth == kMostInterpreters) {
    return Mistake(path,
                   "is interpreted by a script that is interpreted by a script, and so on; "
                   "name the program itself");
  }
  if (auto error = Check(*interpreter, depth + 1)) {
    return LoadError{"the interpreter of the script '" + path + "': " + error->message};
  }
  return std::nullopt;
}

}  // namespace

LoadResult<std::string> FindExecutable(const std::string& name, const std::string& cwd) {
  if (name.empty()) return LoadError{"the command is empty; name a program"};
  if (name.find('/') != std::string::npos) {
    const std::string path = Absolute(name, cwd);
    const int error = WhyNotExecutable(path);
    if (error == 0) return path;
    if (error == ENOENT || error == ENOTDIR) {
      return LoadError{"there is no program '" + path + "'; build it, or correct the path" +
                       (name.front() == '/' ? "" : " (it is relative to '" + cwd + "')")};
    }
    return NotExecutable(path, error);
  }

  const char* search_path = std::getenv("PATH");
  std::string_view rest = search_path != nullptr ? search_path : "/usr/local/bin:/usr/bin:/bin";
  std::optional<LoadError> found_but;
  while (true) {
    const std::size_t colon = rest.find(':');
    // An empty folder in PATH is the current one.
    const std::string path = Absolute(name, Absolute(std::string(rest.substr(0, colon)), cwd));
    const int error = WhyNotExecutable(path);
    if (error == 0) return path;
    // In a folder that may not be searched there is nothing to be seen.
    if (!found_but && error == EACCES && access(path.c_str(), F_OK) == 0) {
      found_but = NotExecutable(path, error);
    }
    if (colon == std::string_view::npos) break;
    rest.remove_prefix(colon + 1);
  }
  if (found_but) return *found_but;
  return LoadError{"the command '" + name +
                   "' was not found in PATH; install it, or write its path with a slash, like ./" +
                   name};
}

std::optional<LoadError> CheckExecutable(const std::string& path) { return Check(path, 0); }

}  // namespace tcs
