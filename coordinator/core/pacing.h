// When the run may act: at the pace that it is given, and as the people ask who watch it on its
// live page. It only ever holds the run back, in real time. Without a pace and a page it is not
// there.
//
// For the coordinator's thread only. The clock is the host's.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "coordinator/policy/pacer.h"
#include "coordinator/tasks/coordinator.h"

namespace tcs {

class Pacing {
 public:
  // `notice` gets what people have to know at once.
  Pacing(const RunOptions& options, std::int64_t end_ns,
         std::function<void(const std::string&)> notice);

  bool IsOn() const { return is_on_; }
  bool IsWatched() const { return view_ != nullptr; }

  // Real nanoseconds that the run, which acts at virtual `next_ns` next, is to wait before it asks
  // again; 0: it may act now. At most kLookNs: people may ask for something meanwhile.
  static constexpr std::int64_t kLookNs = 20'000'000;
  std::int64_t ToWait(std::int64_t next_ns);

  const Pacer& pacer() const { return pacer_; }
  // Of the real time since the run began, for how long it was held back.
  std::int64_t held_ns() const { return held_ns_; }
  PaceReport Report() const;

 private:
  void TakeWishes(std::int64_t real_ns);
  void LookAtServer(std::int64_t real_ns);

  Pacer pacer_;
  ViewLink* const view_;
  const std::int64_t end_ns_;
  const std::function<void(const std::string&)> notice_;
  const bool is_on_;
  bool is_orphaned_ = false;  // the server has ended
  std::int64_t next_tell_ns_ = 0;
  std::int64_t begun_real_ns_ = -1, held_since_ns_ = -1, held_ns_ = 0;
};

}  // namespace tcs
