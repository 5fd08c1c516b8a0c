// The command line of ROS 2 asks a daemon of its computer which nodes and topics there are. A
// daemon that was started outside of the run, by whatever was typed at this computer before,
// answers with what is outside, and knows nothing of the run. Commands that ask such a daemon are
// named when they begin.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/processes/peers.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

// The port of the loopback interface at which a command asks its daemon, if the command is one that
// does. `arguments`: the command's, with the interpreter's first. `domain`: the command's
// ROS_DOMAIN_ID, empty where there is none.
std::optional<std::uint16_t> PortOfRosDaemon(const std::vector<std::string>& arguments,
                                             const std::string& domain);

// The inode of the socket that listens at the port, in the text of a /proc/PID/net/tcp; 0: there is
// none.
std::uint64_t ListenerAt(const std::string& table, std::uint16_t port);

class RosDaemon {
 public:
  RosDaemon(RunState& run, Peers& peers) : run_(run), peers_(peers) {}

  // The process has executed a program, which is about to set itself up.
  void Begins(pid_t pid);

 private:
  RunState& run_;
  Peers& peers_;
  bool has_warned_ = false;
};

}  // namespace tcs
