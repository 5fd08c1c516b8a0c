// How much of what a thread has run its shim may have worked: asking what a descriptor is, whether
// the thread may go on. The shim says so in memory that its program may write to, so the
// coordinator believes it as long as that can be.
//
// In a turn, a share of the time that the turn has taken: where a program does nothing but short
// calls, two thirds. In all, as much as the kernel's books bear out: the shim's work is system
// calls for the most part, so that a thread whose process has hardly been in the kernel has had
// little of it. Pure; the host's time.
#pragma once

#include <algorithm>

#include "shm/time_kinds.h"

namespace tcs {

class OwnWork {
 public:
  // Without evidence no more than this is believed, and so much is run between two looks at the
  // books, which count in ticks of the kernel's.
  static constexpr HostDuration kUnproven = HostDuration::Milliseconds(10);
  static constexpr HostDuration kLookAfter = HostDuration::Milliseconds(5);

  void TurnBegins() {
    ran_ += ran_in_turn_;
    ran_in_turn_ = believed_in_turn_ = most_ = {};
  }
  // The turn has taken so long by now. `in_kernel()`: how long the thread's process has been in the
  // kernel, which is asked where what is known does not bear out what could be said.
  template <class InKernel>
  void Allow(HostDuration ran, InKernel in_kernel) {
    ran_in_turn_ = std::max(ran, HostDuration());
    const HostDuration share = ran_in_turn_ / kShareOf * kShare - believed_in_turn_;
    const HostDuration ran_in_all = ran_ + ran_in_turn_;
    if (share > borne_out_ - believed_ && ran_in_all >= looked_at_ + kLookAfter) {
      looked_at_ = ran_in_all;
      borne_out_ = kUnproven + in_kernel();
    }
    most_ = std::max(HostDuration(), std::min(share, borne_out_ - believed_));
  }
  // That may still be said in the turn.
  HostDuration most() const { return most_; }
  // That was said. At most `most`.
  void Believe(HostDuration said) {
    most_ -= said;
    believed_in_turn_ += said;
    believed_ += said;
  }

 private:
  static constexpr std::int64_t kShare = 3, kShareOf = 4;

  HostDuration ran_, ran_in_turn_, looked_at_;
  HostDuration believed_, believed_in_turn_, most_;
  HostDuration borne_out_ = kUnproven;
};

}  // namespace tcs
