// Where trapped calls arrive (os/trap.h): a descriptor for each client, of its threads and of all
// that it starts. The reactor says when there are calls (Tag::kTrap, with the descriptor's number).
//
// For the coordinator's thread only.
#pragma once

#include <sys/epoll.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/reactor.h"

namespace tcs {

class TrapListeners {
 public:
  explicit TrapListeners(Reactor& reactor) : reactor_(reactor) {}

  void Add(UniqueFd listener) {
    const int fd = listener.get();
    reactor_.Add(fd, EPOLLIN, {Tag::kTrap, static_cast<std::uint32_t>(fd)});
    listeners_.push_back(std::move(listener));
  }
  // No process is left whose calls could arrive there.
  void Close(int listener) {
    reactor_.Remove(listener);
    std::erase_if(listeners_, [listener](const UniqueFd& fd) { return fd.get() == listener; });
  }

 private:
  Reactor& reactor_;
  std::vector<UniqueFd> listeners_;
};

}  // namespace tcs
