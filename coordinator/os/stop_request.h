// Somebody asks for the end, by signals.
#pragma once

#include <cstdint>

namespace tcs {

class StopRequest {
 public:
  // A signal came. One that follows at once belongs to the same wish: ^C reaches every process of a
  // terminal, some of which pass it on, and who ends a group of processes sends to each of them.
  // One that comes really later insists: nobody is to be waited for any more.
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
  // Whoever passes one on may have to wait for a processor.
  static constexpr std::int64_t kSameWishNs = 1'000'000'000;

  int signal_ = 0;
  std::int64_t first_real_ns_ = 0;
  bool insists_ = false;
};

}  // namespace tcs
