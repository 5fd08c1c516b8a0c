// When the clients start: at the run's beginning, at a virtual time, or once another one has ended.
#include <errno.h>
#include <fmt/format.h>
#include <string.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "coordinator/core/engine.h"
#include "coordinator/os/files.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

std::string PrepareFolder(const ClientSpec& client) {
  const std::string& folder = client.working_directory;
  std::error_code not_removed;
  if (client.folder == ClientFolder::kThere) return {};
  if (client.folder == ClientFolder::kFresh) std::filesystem::remove_all(folder, not_removed);
  if (not_removed) {
    return fmt::format(
        "the folder '{}' of an earlier run cannot be removed: {}; choose another "
        "one with --out",
        folder, not_removed.message());
  }
  std::string error = MakeFolder(folder);
  if (error.empty() && !client.copied_folder.empty()) {
    error = CopyFolder(client.copied_folder, folder);
  }
  return error;
}

// What the user has preloaded comes first, as the shim itself has it for what programs execute
// (libtcs_preload/environment.cc).
std::string WithOurLibraries(const std::string& users, const std::string& ours) {
  return users.empty() ? ours : users + ":" + ours;
}

}  // namespace

// What of the clients is in the run's results before they start. Of an earlier run nothing is left:
// one that is never started has no log.
std::string Engine::PrepareFolders() {
  for (const RobotSpec& robot : scenario_.robots) {
    for (const ClientSpec& client : robot.clients) {
      for (const char* log : {".out.log", ".err.log"}) {
        std::error_code ignored;
        const std::string base = options_.output_directory + "/" + FileNameOf(client);
        if (!options_.output_directory.empty()) std::filesystem::remove(base + log, ignored);
      }
      if (std::string error = PrepareFolder(client); !error.empty()) return error;
    }
  }
  return {};
}

std::string Engine::StartClients() {
  for (const RobotSpec& robot : scenario_.robots) {
    const auto cores = static_cast<std::uint32_t>(robot.cores);
    Robot& computer = robots_.emplace_back(robot.name, robot.speed,
                                           RobotScheduler(cores, !IsCallback(), [this](int order) {
                                             return waker_.WaitOf(TaskAt(order));
                                           }));
    for (std::uint32_t core = 0; core < cores; ++core) {
      VirtualCpu& cpu = cpus_.emplace_back();
      cpu.robot = &computer;
      cpu.core = core;
      cpu.leaf = root_.AddLeaf(static_cast<int>(robots_.size()));
      computer.cpus.push_back(&cpu);
    }
    for (const ClientSpec& client : robot.clients) {
      const std::int64_t start_ns = client.after.empty() ? client.start.ns() : shm::kNeverNs;
      launches_.push_back({&client, &computer, start_ns, nullptr});
    }
  }
  for (Robot& robot : robots_) FindNextLaunch(robot);
  for (Robot& robot : robots_) StartDue(robot, 0);
  return report_.error;
}

// The launches of the robot that are due.
void Engine::StartDue(Robot& robot, std::int64_t now_ns) {
  if (robot.next_launch_ns > now_ns) return;
  for (Launch& launch : launches_) {
    if (launch.robot != &robot || launch.process != nullptr || launch.start_ns > now_ns) continue;
    if (std::string error = Start(launch, now_ns); !error.empty() && report_.error.empty()) {
      report_.error = std::move(error);
      return;
    }
  }
  FindNextLaunch(robot);
}

void Engine::FindNextLaunch(Robot& robot) {
  robot.next_launch_ns = shm::kNeverNs;
  for (const Launch& launch : launches_) {
    if (launch.robot != &robot || launch.process != nullptr) continue;
    robot.next_launch_ns = std::min(robot.next_launch_ns, launch.start_ns);
  }
  Refresh(robot);
}

// Whether a client is still to be started, at a time that is known.
bool Engine::HasLaunchAhead() const {
  return std::any_of(robots_.begin(), robots_.end(),
                     [this](const Robot& robot) { return robot.next_launch_ns < end_ns_; });
}

// Those that wait for the client to end are started now, or later if they are to; however it has
// ended.
void Engine::StartThoseAfter(const Process& ended) {
  if (!ended.is_client || IsInGrace()) return;
  for (Launch& launch : launches_) {
    if (launch.spec->after != ended.name || launch.process != nullptr) continue;
    launch.start_ns = std::max(launch.spec->start.ns(), ended.ended_at_ns);
    FindNextLaunch(*launch.robot);
  }
}

// Of those that were never started, the ones that waited for another client.
void Engine::WarnOfNeverStarted() {
  if (!report_.error.empty() || stop_.asked()) return;
  for (const Launch& launch : launches_) {
    if (launch.process != nullptr || launch.start_ns != shm::kNeverNs) continue;
    Warn(fmt::format("{} was never started: it is to start after {}, which has not ended",
                     launch.spec->name, launch.spec->after));
  }
}

std::string Engine::Start(Launch& launch, std::int64_t at_ns) {
  const ClientSpec& client = *launch.spec;
  SpawnRequest request;
  request.command = client.command;
  request.working_directory = client.working_directory;
  request.environment = client.environment;
  const bool counts_allocations =
      options_.counts_work || (IsFixed() && client.fixed_allocation_cost.ns() > 0);
  std::string& preload = request.environment["LD_PRELOAD"];
  preload = WithOurLibraries(
      client.environment.contains("LD_PRELOAD") ? preload : options_.user_preload,
      options_.preload_library + (counts_allocations ? ":" + options_.allocation_library : ""));
  const std::string socket_name = sockets_.Open();
  if (socket_name.empty()) return "the socket that clients register at cannot be made";
  request.environment["TCS_SOCKET"] = socket_name;
  request.fixed_layout = IsFixed();
  request.guarded = guarded_;
  if (!options_.output_directory.empty()) {
    const std::string base = options_.output_directory + "/" + FileNameOf(client);
    request.log_stdout = base + ".out.log";
    request.log_stderr = base + ".err.log";
  }
  Spawned spawned = Spawn(request);
  const pid_t pid = spawned.pid;
  if (pid < 0) return client.name + " cannot be started: " + strerror(errno);
  if (spawned.trap) {
    traps_.Add(std::move(spawned.trap));
  } else {
    Warn("futex calls cannot be trapped here (" + std::string(strerror(errno)) +
         "): threads wait for each other in real time");
  }
  launch.process = births_.AddClient(pid, *launch.robot, client, at_ns).process;
  sockets_.AssignTo(*launch.process);
  return {};
}

}  // namespace tcs
