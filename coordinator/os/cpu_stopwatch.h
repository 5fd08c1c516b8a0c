// How much of the calling thread's processor time goes into something short that is done very
// often.
//
// The thread's CPU clock is a system call, which costs as much as what is measured here. So the TSC
// is read every time, and the CPU clock only every 32nd time: their ratio over those times says
// how much of the TSC's time the thread really had. Not thread-safe; spans do not nest.
#pragma once

#include <cstdint>

namespace tcs {

class CpuStopwatch {
 public:
  class Span {
   public:
    explicit Span(CpuStopwatch& watch) : watch_(watch) { watch_.Begin(); }
    ~Span() { watch_.End(); }
    Span(const Span&) = delete;
    Span& operator=(const Span&) = delete;

   private:
    CpuStopwatch& watch_;
  };

  // Of all spans so far.
  std::int64_t TotalNs() const;

 private:
  void Begin();
  void End();

  std::uint64_t spans_ = 0, ticks_ = 0, begin_tsc_ = 0;
  std::uint64_t sampled_ticks_ = 0;
  std::int64_t sampled_ns_ = 0, begin_ns_ = 0;
  bool sampling_ = false;
};

}  // namespace tcs
