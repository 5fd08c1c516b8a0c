#include "coordinator/dump/find_run.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "coordinator/dump/state_page.h"
#include "coordinator/os/files.h"
#include "coordinator/os/own_number.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

std::string ProcOf(pid_t pid) { return "/proc/" + std::to_string(pid); }

std::vector<pid_t> AllProcesses() {
  std::vector<pid_t> all;
  DIR* proc = opendir("/proc");
  if (proc == nullptr) return all;
  while (const dirent* entry = readdir(proc)) {
    if (const int pid = std::atoi(entry->d_name); pid > 0) all.push_back(pid);
  }
  closedir(proc);
  std::sort(all.begin(), all.end());
  return all;
}

// A run that is about to begin has not written yet whose memory this is: the memory gets its magic
// last.
bool HasBegun(const UniqueFd& memory) {
  std::uint32_t magic = 0;
  static_assert(offsetof(StatePage, magic) == 0 && sizeof StatePage::magic == sizeof magic);
  return pread(memory.get(), &magic, sizeof magic, 0) == sizeof magic && magic != 0;
}

// The memory that the process shares with an asker; none: the process has none yet, or may not be
// looked into.
UniqueFd StateMemoryOf(pid_t pid) {
  const std::string folder = ProcOf(pid) + "/fd";
  const std::string target = std::string("/memfd:") + StatePage::kName + " (deleted)";
  DIR* descriptors = opendir(folder.c_str());
  if (descriptors == nullptr) return {};
  UniqueFd memory;
  while (const dirent* entry = readdir(descriptors)) {
    const std::string path = folder + "/" + entry->d_name;
    char text[64];
    const ssize_t size = readlink(path.c_str(), text, sizeof text);
    if (size <= 0 || std::string_view(text, static_cast<std::size_t>(size)) != target) continue;
    memory.Reset(open(path.c_str(), O_RDWR | O_CLOEXEC));
    break;
  }
  closedir(descriptors);
  return memory && HasBegun(memory) ? std::move(memory) : UniqueFd();
}

std::optional<uid_t> UserOf(pid_t pid) {
  std::ifstream status(ProcOf(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("Uid:", 0) == 0) return static_cast<uid_t>(std::atol(line.c_str() + 4));
  }
  return std::nullopt;
}

// Other processes have the memory, too: the block detector, and a process that asks just now.
bool IsCoordinatorOf(pid_t pid, const UniqueFd& memory) {
  pid_t coordinator = 0;
  static_assert(sizeof StatePage::coordinator_pid == sizeof coordinator);
  return pread(memory.get(), &coordinator, sizeof coordinator,
               static_cast<off_t>(offsetof(StatePage, coordinator_pid))) == sizeof coordinator &&
         OwnNumberOf(pid).number == coordinator;
}

std::string NameOfUser(uid_t uid) {
  const passwd* user = getpwuid(uid);
  return user == nullptr ? "user " + std::to_string(uid) : user->pw_name;
}

std::string NameOf(pid_t pid) {
  std::ifstream file(ProcOf(pid) + "/comm");
  std::string name;
  std::getline(file, name);
  return name;
}

// The kernel's answer, for any caller: root, too, needs CAP_SYS_PTRACE.
bool MayLookInto(pid_t pid) {
  DIR* descriptors = opendir((ProcOf(pid) + "/fd").c_str());
  if (descriptors != nullptr) closedir(descriptors);
  return descriptors != nullptr || errno == ENOENT;
}

std::string OnlyOwnerMayAsk(pid_t pid, uid_t owner) {
  const std::string name = NameOfUser(owner);
  const char* root = geteuid() == 0 ? " or root with CAP_SYS_PTRACE" : " or root";
  return fmt::format("process {} is {}'s: only {} may ask for the state of its run", pid, name,
                     owner == 0 ? name : name + root);
}

// A sentence on another user's process that is called as tcsim is.
std::string OfOthers() {
  for (const pid_t pid : AllProcesses()) {
    const auto owner = UserOf(pid);
    if (owner && *owner != geteuid() && NameOf(pid) == "tcsim" && !MayLookInto(pid)) {
      return OnlyOwnerMayAsk(pid, *owner);
    }
  }
  return {};
}

std::string Described(const FoundRun& run) {
  return run.folder.empty() ? fmt::format("process {} (without a folder)", run.coordinator)
                            : fmt::format("process {} ({})", run.coordinator, run.folder);
}

std::string SeveralGoOn(const std::vector<FoundRun>& runs) {
  constexpr std::size_t kMostNamed = 10;
  std::string text = fmt::format("{} runs go on: ", runs.size());
  for (std::size_t i = 0; i < std::min(runs.size(), kMostNamed); ++i) {
    text += (i == 0 ? "" : ", ") + Described(runs[i]);
  }
  if (runs.size() > kMostNamed) text += fmt::format(" and {} more", runs.size() - kMostNamed);
  return text + fmt::format("; name one, as in `tcsim dump {}`", runs.front().coordinator);
}

using Chosen = std::variant<FoundRun, std::string>;

Chosen Only(std::vector<FoundRun> of, const std::string& if_none) {
  if (of.empty()) return if_none;
  if (of.size() > 1) return SeveralGoOn(of);
  return std::move(of.front());
}

bool IsNumber(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

// Runs may be within each other: a client may start one. A process that has started runs means the
// outermost of these, and any other process the innermost one that it belongs to.
void KeepThoseOf(pid_t pid, std::vector<FoundRun>* runs) {
  const auto has_started = [pid](const FoundRun& run) {
    return DescendsFrom(run.coordinator, pid);
  };
  const bool starts = std::ranges::any_of(*runs, has_started);
  std::erase_if(*runs, [&](const FoundRun& run) {
    return starts ? !has_started(run) : !DescendsFrom(pid, run.coordinator);
  });
  std::vector<pid_t> coordinators;
  for (const FoundRun& run : *runs) coordinators.push_back(run.coordinator);
  std::erase_if(*runs, [&](const FoundRun& run) {
    return std::ranges::any_of(coordinators, [&](pid_t other) {
      return other != run.coordinator &&
             (starts ? DescendsFrom(run.coordinator, other) : DescendsFrom(other, run.coordinator));
    });
  });
}

Chosen ChooseByProcess(std::vector<FoundRun> runs, const std::string& named) {
  const long number = std::strtol(named.c_str(), nullptr, 10);
  const auto pid = static_cast<pid_t>(std::min(number, static_cast<long>(INT32_MAX)));
  const auto owner = UserOf(pid);
  if (!owner) return fmt::format("there is no process {}", named);
  KeepThoseOf(pid, &runs);
  const bool is_others = runs.empty() && *owner != geteuid() && !MayLookInto(pid);
  if (is_others) return OnlyOwnerMayAsk(pid, *owner);
  return Only(std::move(runs),
              fmt::format("process {} belongs to no run of tcsim that has begun", named));
}

bool IsSameFolder(const std::string& one, const std::string& other) {
  struct stat first, second;
  return one == other || (stat(one.c_str(), &first) == 0 && stat(other.c_str(), &second) == 0 &&
                          first.st_dev == second.st_dev && first.st_ino == second.st_ino);
}

Chosen ChooseByFolder(std::vector<FoundRun> runs, const std::string& named) {
  const std::string folder = AbsolutePathOf(named);
  std::erase_if(runs, [&folder](const FoundRun& run) {
    return run.folder.empty() || !IsSameFolder(run.folder, folder);
  });
  const bool is_there = access(folder.c_str(), F_OK) == 0;
  std::string if_none = is_there ? fmt::format("no run writes to the folder '{}' just now", named)
                                 : fmt::format("there is no folder '{}'", named);
  if (runs.empty() && is_there && !FolderLock(folder).IsOurs()) {
    const std::string others = OfOthers();
    if (!others.empty()) if_none = others;
  }
  return Only(std::move(runs), if_none);
}

}  // namespace

std::vector<FoundRun> FindRuns() {
  std::vector<FoundRun> runs;
  for (const pid_t pid : AllProcesses()) {
    UniqueFd memory = StateMemoryOf(pid);
    if (!memory || !IsCoordinatorOf(pid, memory)) continue;
    char folder[StatePage::kMostPath] = {};
    const ssize_t size = pread(memory.get(), folder, sizeof folder - 1,
                               static_cast<off_t>(offsetof(StatePage, folder)));
    if (size < 0) continue;
    runs.push_back({pid, folder, std::move(memory)});
  }
  return runs;
}

Chosen ChooseRun(std::vector<FoundRun> runs, const std::string& named) {
  const bool is_process = IsNumber(named) && access(named.c_str(), F_OK) != 0;
  if (is_process) return ChooseByProcess(std::move(runs), named);
  if (!named.empty()) return ChooseByFolder(std::move(runs), named);
  const std::string others = runs.empty() ? OfOthers() : "";
  return Only(std::move(runs), others.empty() ? "no run of tcsim goes on here" : others);
}

}  // namespace tcs
