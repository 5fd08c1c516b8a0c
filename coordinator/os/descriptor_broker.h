// The coordinator's side of a client's broker (shm/attach_protocol.h): copies of the client's
// descriptors where pidfd_getfd is refused, as by the seccomp profile that Docker has for all
// containers.
//
// The broker shares the client's table of descriptors, and so keeps all of them open: the broker
// has to be gone before the client executes another program or its end is told to anybody. The
// broker is an orphan, which the kernel gives to this process, so that the client has no child that
// it does not know.
//
// For the coordinator's thread only. A client's answers here are not trusted: at the worst the
// client hands over other descriptors of its own, or none.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>

#include "coordinator/port/unique_fd.h"

namespace tcs {

class DescriptorBroker {
 public:
  // A connection for a broker that is still to come; null: errno is set. `is_lost` is told each
  // time that a descriptor cannot be had because the broker does not answer any more.
  static std::unique_ptr<DescriptorBroker> Make(std::function<void()> is_lost);
  // Ends the broker.
  ~DescriptorBroker() { End(); }
  DescriptorBroker(const DescriptorBroker&) = delete;
  DescriptorBroker& operator=(const DescriptorBroker&) = delete;

  // The client's end, given away once.
  UniqueFd TakeClientsEnd() { return std::move(clients_end_); }

  // A copy of the client's descriptor; none: errno is set, EBADF if the client has none of that
  // number. Waits for the broker, which has the processor meanwhile, at most two seconds; a minute
  // where other processes of the host keep the broker from running.
  UniqueFd CopyOf(int number);

  // Whether that process is the broker.
  bool Is(pid_t pid);

  // Kills the broker, and waits until it has let go of all descriptors, at most two seconds. A new
  // broker may come: the client makes one with its next call.
  void End();

 private:
  DescriptorBroker(UniqueFd ours, UniqueFd theirs, std::function<void()> is_lost);

  void Hear();
  void Adopt(pid_t sender);
  void Kill();
  UniqueFd Await(std::uint32_t serial);

  UniqueFd socket_, clients_end_, pidfd_;  // without the last there is no broker now
  std::function<void()> is_lost_;
  pid_t pid_ = 0;
  std::uint32_t serial_ = 0;
};

}  // namespace tcs
