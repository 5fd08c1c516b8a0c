#include "coordinator/calls/computer_files.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/computer/computer_text.h"
#include "coordinator/port/traps.h"
#include "coordinator/processes/usage_book.h"
#include "shm/computer_files.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

using Kind = ComputerFile::Kind;

bool IsFolder(Kind kind) { return kind == Kind::kProcessorFolder || kind == Kind::kNodeFolder; }

struct OpenCall {
  int folder = AT_FDCWD;
  std::uint64_t name = 0;
  int flags = 0;
};

OpenCall OpenIn(const TrappedCall& call) {
  if (call.number == SYS_open) return {AT_FDCWD, call.args[0], static_cast<int>(call.args[1])};
  return {static_cast<int>(call.args[0]), call.args[1], static_cast<int>(call.args[2])};
}

// The text at that address; none: there is none, or it is longer than a name may be.
std::optional<std::string> NameAt(pid_t tid, std::uint64_t address) {
  constexpr std::uint64_t kPage = 4096;
  std::string name;
  std::array<char, kPage> piece;
  while (name.size() < PATH_MAX) {
    const std::uint64_t from = address + name.size();
    // Most names are short, and none needs what is on the page behind it.
    const std::uint64_t size = std::min<std::uint64_t>(kPage - from % kPage, 256);
    if (!ReadMemory(tid, from, piece.data(), size)) return std::nullopt;
    const std::string_view read(piece.data(), size);
    const std::size_t end = read.find('\0');
    name += read.substr(0, end);
    if (end != std::string_view::npos) return name;
  }
  return std::nullopt;
}

std::string LinkOf(const std::string& path) {
  std::array<char, PATH_MAX> target;
  const ssize_t size = readlink(path.c_str(), target.data(), target.size());
  return size < 0 ? std::string() : std::string(target.data(), static_cast<std::size_t>(size));
}

bool MayLeadThere(std::string_view path) {
  return path.substr(0, 5) == "/proc" || path.substr(0, 4) == "/sys";
}

// The plain name of the file; none: the file is not in /proc or /sys.
std::optional<std::string> NameIn(const TrappedCall& call) {
  const OpenCall open = OpenIn(call);
  auto name = NameAt(call.tid, open.name);
  if (!name.has_value() || name->empty()) return std::nullopt;
  if (name->front() != '/') {
    const std::string own = fmt::format("/proc/{}/", call.tid);
    const std::string folder =
        LinkOf(open.folder == AT_FDCWD ? own + "cwd" : fmt::format("{}fd/{}", own, open.folder));
    if (folder != "/" && !MayLeadThere(folder)) return std::nullopt;
    name = folder + "/" + *name;
  }
  std::string plain = PlainName(*name);
  if (!MayLeadThere(plain)) return std::nullopt;
  return plain;
}

// Whether the host's names of processes, and of files, mean the same for the thread as for this
// process.
bool SeesSameProcesses(pid_t tid) {
  return LinkOf(fmt::format("/proc/{}/ns/pid", tid)) == LinkOf("/proc/self/ns/pid");
}
bool HasSameRoot(pid_t tid) { return LinkOf(fmt::format("/proc/{}/root", tid)) == "/"; }

std::optional<std::string> HostsText(const std::string& path) {
  std::ifstream file(path);
  if (!file.is_open()) return std::nullopt;
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) return std::nullopt;
  return text;
}

// A descriptor for reading only, at the file's beginning. The file's name says what the file is of
// (shm/computer_files.h).
UniqueFd FileWith(const std::string& text, const std::string& name) {
  const UniqueFd whole(memfd_create((shm::kComputerFile + name).c_str(), MFD_CLOEXEC));
  if (!whole) return UniqueFd();
  std::string_view left = text;
  while (!left.empty()) {
    const ssize_t written = write(whole.get(), left.data(), left.size());
    if (written <= 0) return UniqueFd();
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  return UniqueFd(open(fmt::format("/proc/self/fd/{}", whole.get()).c_str(), O_RDONLY | O_CLOEXEC));
}

std::vector<std::int64_t> BusyOf(const Robot& robot) {
  std::vector<std::int64_t> busy_ns;
  for (const VirtualCpu* cpu : robot.cpus) busy_ns.push_back(cpu->busy.ns());
  return busy_ns;
}

// Whether the thread sleeps at its gate does not count: a thread that has yet to begin has not come
// to any wait.
bool IsRunning(const Task& task, const Task& reader) {
  return &task == &reader || task.state == TaskState::kReady || task.state == TaskState::kHolding ||
         task.state == TaskState::kStarting;
}

std::int64_t BootTimeNs() {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return shm::ToNs(now);
}

}  // namespace

ComputerFiles::ComputerFiles(RunState& run) : run_(run), host_uptime_ns_(BootTimeNs()) {}

bool ComputerFiles::IsOpen(const TrappedCall& call) {
  return call.number == SYS_open || call.number == SYS_openat;
}

bool ComputerFiles::IsOfComputer(const TrappedCall& call) {
  const auto name = NameIn(call);
  return name.has_value() && ComputerFileAt(*name, 1, 1).has_value();
}

void ComputerFiles::Open(Task& task, const TrappedCall& call) {
  task.trap_continues = true;
  const auto name = NameIn(call);
  if (!name.has_value()) return;
  const auto file = ComputerFileAt(*name, task.process->pid, task.tid);
  if (!file.has_value() || !HasSameRoot(task.tid)) return;
  const int flags = OpenIn(call).flags;
  UniqueFd opened = FileFor(task, *file, *name, flags);
  const bool is_missing = !opened && IsFolder(file->kind) && errno != ENOSYS;
  if (!opened && !is_missing) return;
  task.trap_continues = false;
  if (is_missing) {
    task.trap_result = -errno;
    return;
  }
  task.trap_file = std::move(opened);
  task.trap_file_on_exec = (flags & O_CLOEXEC) == 0;
}

UniqueFd ComputerFiles::FileFor(const Task& task, const ComputerFile& file, const std::string& name,
                                int flags) {
  if (IsFolder(file.kind)) {
    const bool of_processors = file.kind == Kind::kProcessorFolder;
    const std::size_t cores = task.process->robot->cpus.size();
    const auto which =
        of_processors ? ProcessorFolders::Which::kProcessors : ProcessorFolders::Which::kNodes;
    return folders_.try_emplace(cores, cores).first->second.Open(which, file.rest, flags);
  }
  if ((flags & O_DIRECTORY) != 0) return UniqueFd();
  const auto text = TextOf(task, file, name);
  return text.has_value() ? FileWith(*text, name) : UniqueFd();
}

std::optional<std::string> ComputerFiles::TextOf(const Task& task, const ComputerFile& file,
                                                 const std::string& name) const {
  const std::size_t cores = task.process->robot->cpus.size();
  const auto if_there = [&](const std::string& text) -> std::optional<std::string> {
    if (access(name.c_str(), R_OK) != 0) return std::nullopt;
    return text;
  };
  switch (file.kind) {
    case Kind::kProcessorTable: {
      const auto of_host = HostsText(name);
      return of_host.has_value() ? std::optional(ProcessorTable(*of_host, cores)) : std::nullopt;
    }
    case Kind::kCounters:
      return CountersFor(task);
    case Kind::kUptime:
      return UptimeText(UptimeNs(task), BusyOf(*task.process->robot));
    case Kind::kProcessCounters:
    case Kind::kProcessStatus:
    case Kind::kProcessSchedule:
      return OfProcess(task, file);
    case Kind::kQuota:
      return if_there("max 100000\n");
    case Kind::kOldQuota:
      return if_there("-1\n");
    case Kind::kProcessorSet:
      return if_there(CoreList(AllCores(cores)) + "\n");
    default:
      return std::nullopt;
  }
}

std::optional<std::string> ComputerFiles::OfProcess(const Task& task,
                                                    const ComputerFile& file) const {
  if (!SeesSameProcesses(task.tid)) return std::nullopt;
  const bool of_thread = file.thread != 0;
  std::string path = fmt::format("/proc/{}/", file.process);
  if (of_thread) path += fmt::format("task/{}/", file.thread);
  const bool of_counters = file.kind == Kind::kProcessCounters;
  const bool of_status = file.kind == Kind::kProcessStatus;
  const auto of_host = HostsText(path + (of_counters ? "stat"
                                         : of_status ? "status"
                                                     : "schedstat"));
  if (!of_host.has_value()) return std::nullopt;
  // A thread has such a file under its own number, too; the file is then that of its process.
  const Task* of = run_.table.Living(of_thread ? file.thread : file.process);
  const Process* process = of != nullptr ? of->process : run_.table.LivingProcess(file.process);
  if (process == nullptr) {
    if (!of_counters) return of_host;
    const std::int64_t later_ns = run_.header->monotonic_offset_ns - host_uptime_ns_;
    return OutsideProcessCounters(*of_host, later_ns / kNsPerTick);
  }
  const VirtualDuration charged =
      of_thread && of != nullptr ? of->charged : UsageBook::ChargedTo(*process);
  const char state = of != nullptr && IsRunning(*of, task) ? 'R' : 'S';
  if (of_status) {
    const Robot& robot = *process->robot;
    const std::size_t cores = robot.cpus.size();
    return ProcessStatus(*of_host, state,
                         of == nullptr ? AllCores(cores) : robot.scheduler.CoresOf(of->order),
                         cores);
  }
  if (!of_counters) {
    const std::uint64_t turns = of == nullptr ? 0 : static_cast<std::uint64_t>(of->dispatches);
    return fmt::format("{} 0 {}\n", charged.ns(), turns);
  }
  ProcessFacts facts{
      .user_ns = charged.ns(),
      .children_ns = process->children_cpu.ns(),
      .started_ns = run_.header->monotonic_offset_ns +
                    (of_thread && of != nullptr ? of->started_at : process->started_at).ns(),
      .state = state};
  // Set costs are the program's own. Of other costs the host says which part the kernel took.
  const ProcessTicks ticks = TicksIn(*of_host);
  if (!run_.IsFixed() && ticks.user + ticks.system > 0) {
    facts.system_ns = static_cast<std::int64_t>(static_cast<double>(charged.ns()) *
                                                static_cast<double>(ticks.system) /
                                                static_cast<double>(ticks.user + ticks.system));
    facts.user_ns -= facts.system_ns;
  }
  if (of != nullptr) {
    const SchedulingParameters& parameters = ParametersOf(*of);
    facts.core = of->cpu == nullptr ? 0 : of->cpu->core;
    facts.policy = parameters.policy;
    facts.real_time_priority = parameters.priority;
  }
  return ProcessCounters(*of_host, facts);
}

std::string ComputerFiles::CountersFor(const Task& task) const {
  const Robot& robot = *task.process->robot;
  Counters counters{
      .uptime_ns = UptimeNs(task),
      .boot_date_ns = run_.header->realtime_offset_ns - run_.header->monotonic_offset_ns,
      .busy_ns = BusyOf(robot),
      .switches = static_cast<std::uint64_t>(run_.report.switches)};
  for (const Process& process : run_.table.processes()) {
    if (process.robot == &robot) ++counters.processes;
  }
  for (const Task* of : robot.tasks) {
    if (IsRunning(*of, task)) ++counters.running;
  }
  return CountersText(counters);
}

std::int64_t ComputerFiles::UptimeNs(const Task& task) const {
  return OwnNow(task).ns() + run_.header->monotonic_offset_ns;
}

}  // namespace tcs
