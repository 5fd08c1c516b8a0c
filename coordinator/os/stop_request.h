// A request for the end, by signals.
#pragma once

#include <cstdint>

namespace tcs {

class StopRequest {
 public:
  // A signal came. A signal that follows at once belongs to the same request: ^C reaches every
  // process of a terminal, some of which pass it on, and a user who ends a group of processes sends
  // a signal to each of them. A signal that comes really later insists: no process is to be waited
  // for any more.
  void Take(int signal, std::int64_t now_real_ns) {
    if (!asked()) {
      signal_ = signal;
      first_real_ns_ = now_real_ns;
    } else if (now_real_ns - first_real_ns_ >= kSameWishNs) {
      insists_ = true;
    }
  }

  bool asked() const { return signal_ != 0; }
  int signal() const { return signal_; }  // the first one; 0: none yet
  bool insists() const { return insists_; }

 private:
  // A process that passes a signal on may have to wait for a processor.
  static constexpr std::int64_t kSameWishNs = 1'000'000'000;

  int signal_ = 0;
  std::int64_t first_real_ns_ = 0;
  bool insists_ = false;
};

}  // namespace tcs
