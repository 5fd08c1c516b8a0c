// TCP's retransmissions after a timeout, in virtual time.
//
// The robots' kernels retransmit by themselves what duplicate acknowledgements show to be missing,
// which takes no timer. The kernels' timers run in the host's time and are set so long that they
// never run out. So the network sends again what a timer would: it keeps each segment that a link
// has lost, and sends it again after the retransmission timeout, which doubles each time, unless
// the kernel has sent it again by then. The sender's window stays what it was.
//
// Pure: no system calls, no clock. Not thread-safe.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "coordinator/network/packet.h"
#include "shm/virtual_time.h"

namespace tcs {

class LostSegments {
 public:
  struct Segment {
    TcpSegment head;
    std::shared_ptr<const std::vector<std::byte>> packet;
    std::size_t from = 0, to = 0;  // robots
    int timeouts = 0;              // that the segment has waited for
  };

  // The segment was lost, and is sent again at `due`, unless another one passes by then that makes
  // up for it.
  void Lose(Segment segment, VirtualTime due);
  // The segment with that head is on its way.
  void Passed(const TcpSegment& head);

  VirtualTime NextDue() const {
    return lost_.empty() ? VirtualTime::Never() : lost_.begin()->first;
  }
  // The next segment that is due at that time.
  std::optional<Segment> Take(VirtualTime now);

 private:
  std::multimap<VirtualTime, Segment> lost_;
};

}  // namespace tcs
