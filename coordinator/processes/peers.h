// The peers that programs of the run meet by their sockets: other programs of the run, or somebody
// outside.
//
// For the coordinator's thread only.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>

#include "coordinator/os/socket_tables.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class Peers {
 public:
  explicit Peers(const RunState& run) : run_(run) {}

  struct Peer {
    std::string name;  // HOST:PORT, a path, or '@' and an abstract name
    bool is_outside = false;
  };
  // The peer of a socket of the process's that is connected, or is being connected, given a copy of
  // the socket. None where there is no peer, or none that has a name. A peer that is not known
  // counts as one of the run.
  std::optional<Peer> Of(const Process& process, int fd);

  // Whether a process of the run has the socket with that inode.
  bool IsOfRun(std::uint64_t inode);

 private:
  static std::optional<InternetAddress> RemoteOf(const Process& process, int fd, bool is_tcp,
                                                 sockaddr_storage* peer);
  static std::uint64_t ServerInTables(const Process& process, const InternetAddress& remote,
                                      bool is_tcp);
  std::optional<Peer> InternetPeer(const Process& process, int fd);
  std::optional<Peer> UnixPeer(const Process& process, int fd);

  const RunState& run_;
  std::unordered_map<std::uint64_t, bool> is_of_run_;  // by inode, which no later socket gets
};

}  // namespace tcs
