// A page of memory that a run and the server of its live page (tcsim-view) share by its descriptor.
// Requests stand in the page as the state that people want, not as events, so that nothing is lost
// if the run looks late, and nothing waits for anybody.
//
// Times are in nanoseconds, and virtual unless a comment says otherwise. Each field is atomic by
// itself. The comment above a field says who writes it.
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace tcs {

enum class RunStage : std::uint32_t { kStarting, kGoesOn, kStands, kEnded };

struct ControlPage {
  static constexpr std::uint32_t kMagic = 0x76736374;  // "tcsv"
  static constexpr std::uint32_t kVersion = 1;

  std::uint32_t magic = kMagic;
  std::uint32_t version = kVersion;

  // The run begins with the first two of these; from then on the server writes all of them, and
  // `asked` last.
  std::atomic<double> pace{0};              // 0: as fast as it can
  std::atomic<std::uint32_t> stands{0};     // 1: the run is to stand
  std::atomic<std::uint32_t> asked{0};      // how many requests there were
  std::atomic<std::int64_t> stepped_ns{0};  // sum of the steps asked for

  // The run writes these.
  std::atomic<RunStage> stage{RunStage::kStarting};
  std::atomic<std::uint32_t> taken{0};  // `asked`, as the run saw it last
  std::atomic<std::int64_t> now_ns{0}, end_ns{0};
  std::atomic<std::int64_t> real_ns{0};    // since the run began, real
  std::atomic<std::int64_t> behind_ns{0};  // behind the run's pace, real, with the time given up

  // The server writes this: 1 once whoever watches knows that the run has ended.
  std::atomic<std::uint32_t> has_told{0};
  std::uint32_t unused = 0;
};

static_assert(std::is_standard_layout_v<ControlPage>);
static_assert(std::atomic<double>::is_always_lock_free);
static_assert(std::atomic<std::int64_t>::is_always_lock_free);
static_assert(sizeof(ControlPage) == 80);

}  // namespace tcs
