// What a run and the server of its live page (tcsim-view) share: a page of memory, by its
// descriptor. What people ask for stands in it as it is to be, not as what happened, so that
// nothing is lost if the run looks late, and nothing waits for anybody.
//
// Times are nanoseconds; virtual where not said otherwise. All fields are atomic by themselves. Who
// writes a field is said above it.
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
  std::atomic<std::uint32_t> stands{0};     // 1: it is to stand
  std::atomic<std::uint32_t> asked{0};      // how often something was asked for
  std::atomic<std::int64_t> stepped_ns{0};  // all that was asked for in steps

  // The run writes these.
  std::atomic<RunStage> stage{RunStage::kStarting};
  std::atomic<std::uint32_t> taken{0};  // `asked`, as of the last look at it
  std::atomic<std::int64_t> now_ns{0}, end_ns{0};
  std::atomic<std::int64_t> real_ns{0};    // since the run began, real
  std::atomic<std::int64_t> behind_ns{0};  // its pace, real, with what it has given up

  // The server: 1 once whoever watches knows that the run has ended.
  std::atomic<std::uint32_t> has_told{0};
  std::uint32_t unused = 0;
};

static_assert(std::is_standard_layout_v<ControlPage>);
static_assert(std::atomic<double>::is_always_lock_free);
static_assert(std::atomic<std::int64_t>::is_always_lock_free);
static_assert(sizeof(ControlPage) == 80);

}  // namespace tcs
