// Where processes register (shm/attach_protocol.h): a socket for each client and all that it
// starts. So the client is known of which a process is a descendant, even if the process's parents
// have ended. Also the processes that have connected, until they say what they want. A process that
// finds no such socket, for it has a network of its own, connects by a trapped call.
//
// For the coordinator's thread only. The reactor says where a process has connected
// (Tag::kListener, with the socket's number) and where one has said something (Tag::kConnection,
// with the descriptor).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/os/own_computer.h"
#include "coordinator/port/traps.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class RegistrationSockets {
 public:
  // A process that has connected says at once what it wants. Of the processes that do not, the
  // earliest are cut off.
  static constexpr std::size_t kMostSilent = 256;

  // A process that has not yet said what it wants.
  struct Connection {
    UniqueFd fd;
    Process* client;  // the client that the socket is for
    // The process's number, as tcsim has it, if the process came by a call (ConnectBy); 0: the
    // kernel knows.
    pid_t peer = 0;
  };

  explicit RegistrationSockets(Reactor& reactor);

  // A socket for the next client and its descendants, which programs on that computer find (null:
  // on the host). Returns the socket's name, or nothing: errno is set.
  std::string Open(const OwnComputer* computer);
  // The socket that was opened last is that client's. Call it before a process can have connected
  // there.
  void AssignTo(Process& client) { sockets_.back().client = &client; }

  // False: there is a connection, but no descriptor for it that the run could spare.
  [[nodiscard]] bool Accept(std::uint32_t number);
  // No process comes any more: a process that has connected and has not been accepted, or connects
  // later, is refused.
  void Close();
  // The trapped call is to connect to one of the sockets, from a network namespace where there is
  // none (a sandbox's). The call is carried out here, and answered; false: it is another call.
  bool ConnectBy(const TrappedCall& call);
  // The connection has not been heard yet, or will be heard again.
  void Add(Connection connection);
  // The connection says something; nothing if it was cut off.
  std::optional<Connection> Take(int fd);

 private:
  struct Socket {
    UniqueFd fd;
    Process* client;
  };

  Reactor& reactor_;
  const std::string name_;  // of all sockets, each with its number behind this
  std::vector<Socket> sockets_;
  std::deque<Connection> silent_;  // the earliest first
};

}  // namespace tcs
