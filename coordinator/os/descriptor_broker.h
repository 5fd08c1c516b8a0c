// The coordinator's side of a client's broker (shm/attach_protocol.h): copies of the client's
// descriptors where pidfd_getfd is refused, as by the seccomp profile that Docker has for all
// containers.
//
// The broker shares the client's table of descriptors, and so keeps all of them open: it has to be
// gone before the client executes another program or its end is told to anybody. It is an orphan,
// which the kernel gives to this process, so that the client has no child that it does not know.
//
// For the coordinator's thread only. What a client says here is not trusted: at the worst it hands
// over other descriptors of its own, or none.
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
  // Ends it.
  ~DescriptorBroker() { End(); }
  DescriptorBroker(const DescriptorBroker&) = delete;
  DescriptorBroker& operator=(const DescriptorBroker&) = delete;

  // The client's end, given away once.
  UniqueFd TakeClientsEnd() { return std::move(clients_end_); }

  // A copy of the client's descriptor; none: errno is set, EBADF if there is none of that number.
  // Waits for the broker, which has the processor meanwhile, at most two seconds; a minute where
  // others of the host keep it from running.
  UniqueFd CopyOf(int number);

  // Whether that process is the broker.
  bool Is(pid_t pid);

  // Kills it, and waits until it has let go of all descriptors, at most two seconds. Another one
  // may come: the client makes a new one with its next call.
  void End();

 private:
  DescriptorBroker(UniqueFd ours, UniqueFd theirs, std::function<void()> is_lost);

  void Hear();
  void Adopt(pid_t sender);
  void Kill();
  UniqueFd Await(std::uint32_t serial);

  UniqueFd socket_, clients_end_, pidfd_;  // without the last there is none at this time
  std::function<void()> is_lost_;
  pid_t pid_ = 0;
  std::uint32_t serial_ = 0;
};

}  // namespace tcs
