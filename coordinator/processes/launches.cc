#include "coordinator/processes/launches.h"

#include <errno.h>
#include <string.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "coordinator/os/files.h"
#include "coordinator/os/spawning.h"
#include "shm/attach_protocol.h"

namespace tcs {

namespace {

// The user's libraries come first, as the shim itself has it for what programs execute
// (libtcs_preload/environment.cc).
std::string WithOurLibraries(const std::string& users, const std::string& ours) {
  return users.empty() ? ours : users + ":" + ours;
}

SpawnRequest RequestFor(const ClientSpec& client, const Robot& robot, const RunOptions& options) {
  const bool is_fixed = options.accounting == shm::Accounting::kFixed;
  SpawnRequest request;
  request.command = client.command;
  request.working_directory = client.working_directory;
  request.environment = client.environment;
  const bool are_free = client.fixed_allocation_cost == VirtualDuration();
  const bool counts_allocations = options.counts_work || (is_fixed && !robot.is_ideal && !are_free);
  std::string& preload = request.environment["LD_PRELOAD"];
  preload = WithOurLibraries(
      client.environment.contains("LD_PRELOAD") ? preload : options.user_preload,
      options.preload_library + (counts_allocations ? ":" + options.allocation_library : ""));
  request.fixed_layout = is_fixed;
  if (robot.is_ours) {
    request.log_stdout = "/dev/null";  // the text on stderr is for the user
  } else if (!options.output_directory.empty()) {
    const std::string base = options.output_directory + "/" + FileNameOf(client);
    request.log_stdout = base + ".out.log";
    request.log_stderr = base + ".err.log";
  }
  return request;
}

}  // namespace

std::string Launches::Begin() {
  auto robot = run_.robots.begin();
  std::size_t number = 0;
  for (const RobotSpec& spec : run_.scenario.robots) {
    for (const ClientSpec& client : spec.clients) {
      const VirtualTime start =
          client.after.empty() ? VirtualTime() + client.start : VirtualTime::Never();
      launches_.push_back({&client, &*robot, number, start, nullptr});
    }
    ++robot;
    ++number;
  }
  for (Robot& each : run_.robots) FindNext(each);
  for (Robot& each : run_.robots) StartDue(each, {});
  return run_.report.error;
}

void Launches::StartDue(Robot& robot, VirtualTime now) {
  if (robot.next_launch > now) return;
  for (Launch& launch : launches_) {
    if (launch.robot != &robot || launch.process != nullptr || launch.start > now) continue;
    if (std::string error = Start(launch, now); !error.empty() && run_.report.error.empty()) {
      run_.report.error = std::move(error);
      return;
    }
  }
  FindNext(robot);
}

void Launches::FindNext(Robot& robot) {
  robot.next_launch = VirtualTime::Never();
  for (const Launch& launch : launches_) {
    if (launch.robot != &robot || launch.process != nullptr) continue;
    robot.next_launch = std::min(robot.next_launch, launch.start);
  }
  waker_.Refresh(robot);
}

bool Launches::AreAhead() const {
  return std::any_of(run_.robots.begin(), run_.robots.end(),
                     [this](const Robot& robot) { return robot.next_launch < run_.end; });
}

void Launches::ClientHasEnded(const Process& client) {
  if (run_.IsInGrace()) return;
  for (Launch& launch : launches_) {
    if (launch.spec->after != client.name || launch.process != nullptr) continue;
    launch.start = std::max(VirtualTime() + launch.spec->start, *client.ended_at);
    FindNext(*launch.robot);
  }
}

void Launches::Stop() {
  for (Robot& robot : run_.robots) {
    robot.next_launch = VirtualTime::Never();
    waker_.Refresh(robot);
  }
}

std::string Launches::Start(Launch& launch, VirtualTime at) {
  const ClientSpec& client = *launch.spec;
  SpawnRequest request = RequestFor(client, *launch.robot, run_.options);
  request.guarded = guarded_;
  request.trapped_too = {.executions = run_.SendsToGates(), .draws = run_.IsFixed()};
  request.computer = network_.ComputerOf(launch.number);
  // For programs that ask their environment for the name.
  if (request.computer != nullptr && getenv("HOSTNAME") != nullptr) {
    request.environment.try_emplace("HOSTNAME", launch.robot->name);
  }
  const std::string socket_name = sockets_.Open(request.computer);
  if (socket_name.empty()) return "the socket that clients register at cannot be made";
  request.environment["TCS_SOCKET"] = socket_name;
  if (const std::string aliases = world_.AliasesOf(launch.robot->name); !aliases.empty()) {
    request.environment[shm::kAliasesVariable] = aliases;
  }
  Spawned spawned = Spawn(request);
  if (spawned.pid < 0) return client.name + " cannot be started: " + strerror(errno);
  if (spawned.trap) {
    traps_.Add(std::move(spawned.trap));
  } else {
    run_.Warn("futex calls cannot be trapped here (" + std::string(strerror(errno)) +
              "): threads wait for each other in real time");
  }
  launch.process = thread_creation_.AddClient(spawned.pid, *launch.robot, client, at).process;
  sockets_.AssignTo(*launch.process);
  return {};
}

}  // namespace tcs
