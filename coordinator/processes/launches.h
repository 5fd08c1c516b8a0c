// When the clients of a scenario start: at the run's beginning, at a virtual time, or once another
// one has ended. Until then that time is one at which their robot's idle core acts
// (Robot::next_launch).
//
// For the coordinator's thread only. Times are virtual nanoseconds; errors are one sentence.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/network/robot_network.h"
#include "coordinator/processes/registration_sockets.h"
#include "coordinator/processes/thread_creation.h"
#include "coordinator/processes/trap_listeners.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "coordinator/world/world.h"

namespace tcs {

class Launches {
 public:
  struct Launch {
    const ClientSpec* spec;
    Robot* robot;
    std::size_t number;  // of the robot
    VirtualTime start;   // never: the client waits for another one to end
    Process* process;    // once started
  };

  // The processes in `guarded` are tcsim's own. The arguments outlive this.
  Launches(RunState& run, Waker& waker, ThreadCreation& thread_creation,
           RegistrationSockets& sockets, TrapListeners& traps, const World& world,
           const RobotNetwork& network, const std::vector<pid_t>& guarded)
      : run_(run),
        waker_(waker),
        thread_creation_(thread_creation),
        sockets_(sockets),
        traps_(traps),
        world_(world),
        network_(network),
        guarded_(guarded) {}

  // For all clients, once their robots are there; starts the clients whose start is 0. Empty on
  // success.
  [[nodiscard]] std::string Begin();
  // Starts the robot's clients that are due. An error ends the run.
  void StartDue(Robot& robot, VirtualTime now);
  // The clients that start after this client, however it has ended, are started now, or later if
  // their start says so.
  void ClientHasEnded(const Process& client);
  // No client starts any more.
  void Stop();

  // Whether a client is still to be started, at a time that is known.
  bool AreAhead() const;
  // In the order of the scenario.
  const std::vector<Launch>& all() const { return launches_; }

 private:
  [[nodiscard]] std::string Start(Launch& launch, VirtualTime at);
  void FindNext(Robot& robot);

  RunState& run_;
  Waker& waker_;
  ThreadCreation& thread_creation_;
  RegistrationSockets& sockets_;
  TrapListeners& traps_;
  const World& world_;
  const RobotNetwork& network_;
  const std::vector<pid_t>& guarded_;
  std::vector<Launch> launches_;
};

}  // namespace tcs
