#include "coordinator/engine/lookout.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "coordinator/engine/wiring.h"
#include "coordinator/port/clocks.h"

namespace tcs {

namespace {

constexpr std::int64_t kLookEveryNs = 200'000'000;
constexpr std::uint64_t kLookPause = 50;  // times what the last look took, at the least

constexpr int kShowsPerFlush = 5;

}  // namespace

void Lookout::Look() {
  const std::uint64_t begun_tsc = HostTsc();
  if (run_.IsInGrace() || begun_tsc < next_look_tsc_) return;
  all_.state_link.Does(Doing::kWrites, begun_tsc);
  all_.block_detection.LookAtDetector();
  const std::size_t helpers = all_.home_processor.helpers().size();
  if (all_.home_processor.LeaveIfClaimed()) {
    all_.state_link.RunsOn(all_.home_processor.cpu());
    const std::vector<int>& left = all_.home_processor.helpers();
    if (left.size() < helpers) all_.world.UseProcessors(left);
  }
  if (run_.options.on_progress) {
    if (shows_++ % (all_.pacing.IsWatched() ? 1 : kShowsPerFlush) == 0) {
      all_.records.Flush(all_.pacing.IsWatched());
      all_.dds.records().Flush();
    }
    run_.options.on_progress(all_.reporter.Now());
  }
  if (run_.options.on_notice)
    all_.standstill.Look(all_.pacing.RunningTime(), all_.world_leaf.FurthestOfRun());
  const std::uint64_t now_tsc = HostTsc();
  all_.state_link.Does(Doing::kSchedules, now_tsc);
  next_look_tsc_ =
      now_tsc + std::max(all_.clock.TicksIn(kLookEveryNs), (now_tsc - begun_tsc) * kLookPause);
}

}  // namespace tcs
