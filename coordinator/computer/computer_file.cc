#include "coordinator/computer/computer_file.h"

#include <algorithm>
#include <charconv>
#include <vector>

namespace tcs {

namespace {

using Kind = ComputerFile::Kind;

constexpr std::string_view kProcessors = "/sys/devices/system/cpu";
constexpr std::string_view kNodes = "/sys/devices/system/node";
constexpr std::string_view kGroups = "/sys/fs/cgroup/";
constexpr std::string_view kProc = "/proc/";

std::vector<std::string_view> PartsOf(std::string_view path) {
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find('/'), path.size());
    if (end > 0) parts.push_back(path.substr(0, end));
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return parts;
}

// The part of the path behind the folder's name; none: the path is not in the folder.
std::optional<std::string> Within(std::string_view path, std::string_view folder) {
  if (path == folder) return std::string();
  if (!path.starts_with(folder) || path[folder.size()] != '/') return std::nullopt;
  return std::string(path.substr(folder.size() + 1));
}

std::optional<pid_t> NumberOf(std::string_view part) {
  pid_t number = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
  if (error != std::errc() || end != part.data() + part.size() || number <= 0) return std::nullopt;
  return number;
}

std::optional<Kind> KindOfProcessFile(std::string_view name) {
  if (name == "stat") return Kind::kProcessCounters;
  if (name == "status") return Kind::kProcessStatus;
  if (name == "schedstat") return Kind::kProcessSchedule;
  return std::nullopt;
}

// PID/stat, self/stat, thread-self/stat, PID/task/TID/stat.
std::optional<ComputerFile> ProcessFileAt(const std::vector<std::string_view>& parts,
                                          pid_t own_process, pid_t own_thread) {
  if (parts.size() != 2 && !(parts.size() == 4 && parts[1] == "task")) return std::nullopt;
  const std::optional<Kind> kind = KindOfProcessFile(parts.back());
  if (!kind.has_value()) return std::nullopt;
  ComputerFile file{.kind = *kind};
  if (parts[0] == "thread-self" && parts.size() == 2) {
    file.process = own_process;
    file.thread = own_thread;
    return file;
  }
  const std::optional<pid_t> process = parts[0] == "self" ? own_process : NumberOf(parts[0]);
  if (!process.has_value()) return std::nullopt;
  file.process = *process;
  if (parts.size() == 4) {
    const std::optional<pid_t> thread = NumberOf(parts[2]);
    if (!thread.has_value()) return std::nullopt;
    file.thread = *thread;
  }
  return file;
}

std::optional<ComputerFile> GroupFileAt(std::string_view name) {
  if (name == "cpu.max") return ComputerFile{.kind = Kind::kQuota};
  if (name == "cpu.cfs_quota_us") return ComputerFile{.kind = Kind::kOldQuota};
  for (const std::string_view set :
       {"cpuset.cpus", "cpuset.cpus.effective", "cpuset.effective_cpus"}) {
    if (name == set) return ComputerFile{.kind = Kind::kProcessorSet};
  }
  return std::nullopt;
}

}  // namespace

std::string PlainName(std::string_view path) {
  std::vector<std::string_view> kept;
  for (const std::string_view part : PartsOf(path)) {
    if (part == ".") continue;
    if (part != "..") {
      kept.push_back(part);
    } else if (!kept.empty()) {
      kept.pop_back();
    }
  }
  std::string plain;
  for (const std::string_view part : kept) plain.append("/").append(part);
  return plain.empty() ? "/" : plain;
}

std::optional<ComputerFile> ComputerFileAt(std::string_view path, pid_t own_process,
                                           pid_t own_thread) {
  if (path.starts_with(kProc)) {
    if (path == "/proc/cpuinfo") return ComputerFile{.kind = Kind::kProcessorTable};
    if (path == "/proc/stat") return ComputerFile{.kind = Kind::kCounters};
    if (path == "/proc/uptime") return ComputerFile{.kind = Kind::kUptime};
    return ProcessFileAt(PartsOf(path.substr(kProc.size())), own_process, own_thread);
  }
  if (auto rest = Within(path, kProcessors)) {
    return ComputerFile{.kind = Kind::kProcessorFolder, .rest = *std::move(rest)};
  }
  if (auto rest = Within(path, kNodes)) {
    return ComputerFile{.kind = Kind::kNodeFolder, .rest = *std::move(rest)};
  }
  if (path.starts_with(kGroups)) return GroupFileAt(path.substr(path.rfind('/') + 1));
  return std::nullopt;
}

}  // namespace tcs
