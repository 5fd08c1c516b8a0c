#include "coordinator/network/lost_segments.h"

#include <utility>

namespace tcs {

namespace {

// Sequence numbers go round.
bool IsUpTo(std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(b - a) >= 0; }

bool MakesUpFor(const TcpSegment& lost, const TcpSegment& passed) {
  if (passed.flow != lost.flow) return false;
  if (passed.is_reset) return true;
  if (lost.length == 0) return IsUpTo(lost.acknowledges, passed.acknowledges);
  return passed.length > 0 && IsUpTo(passed.sequence, lost.sequence) &&
         IsUpTo(lost.end(), passed.end());
}

}  // namespace

void LostSegments::Lose(Segment segment, VirtualTime due) {
  lost_.emplace(due, std::move(segment));
}

void LostSegments::Passed(const TcpSegment& head) {
  std::erase_if(lost_, [&](const auto& lost) { return MakesUpFor(lost.second.head, head); });
}

std::optional<LostSegments::Segment> LostSegments::Take(VirtualTime now) {
  if (NextDue() > now) return std::nullopt;
  Segment segment = std::move(lost_.begin()->second);
  lost_.erase(lost_.begin());
  return segment;
}

}  // namespace tcs
