// A descriptor of a client, for as long as it is looked at.
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <cstdint>
#include <utility>

#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/task.h"

namespace tcs {

// A copy of the process's descriptor; none: errno is set. Where brokers hand descriptors over
// (os/descriptor_broker.h) this waits for the process's broker.
UniqueFd CopyOfDescriptor(const Process& process, int number);

class RemoteDescriptor {
 public:
  RemoteDescriptor(const Task& task, int fd);

  int fd() const { return fd_.get(); }  // -1: there is none of that number

  // From then on the descriptor is the caller's.
  UniqueFd Take() { return std::move(fd_); }

  // False for files and folders, and for what is no descriptor.
  bool CanWait() const;
  bool IsNonBlocking() const;
  bool IsReady(short events) const;
  // Whether a socket takes so many bytes though poll says that it is not ready: poll says so once
  // much of the buffer is used, a write waits once all of it is. False where it cannot be known.
  bool HasRoomFor(std::int64_t bytes) const;
  bool IsEventFd() const;
  bool IsTimer() const;
  bool IsTerminal() const;
  // As the shim does it for its own reads: the acknowledgement that TCP's sender waits for must not
  // wait for a timer of the host's. Nothing happens to other descriptors.
  void AcknowledgeAtOnce() const;
  // False if the descriptor was opened for the other direction only.
  bool CanBeRead() const;
  bool CanBeWritten() const;
  // An integer option of SOL_SOCKET; `otherwise` where the descriptor has none.
  int SocketOption(int option, int otherwise) const;
  // SO_RCVTIMEO or SO_SNDTIMEO in ns; shm::kNeverNs for none.
  std::int64_t SocketTimeout(int option) const;

 private:
  UniqueFd fd_;
};

}  // namespace tcs
