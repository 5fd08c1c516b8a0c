// Which clients had the cores of their robots while threads were ready to run. Pure. Times are
// virtual nanoseconds. Threads, clients and robots are numbers from 0 on, and no number is much
// greater than their count.
//
// With several cores, clients that run beside the thread count, too: a share of the time for which
// it waited in all (Shares).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "coordinator/answers/by_client.h"

namespace tcs {

class CoreWaits {
 public:
  struct Of {
    int thread = 0;
    int client = 0;
    int robot = 0;
  };

  // The thread is ready from then on. The call may come after others have run since.
  void Ready(const Of& who, std::int64_t at_ns);
  // The thread had a core.
  void Ran(const Of& who, std::int64_t start_ns, std::int64_t end_ns);
  // For how long each client has had a core since a thread was ready, if there is only one core;
  // and the thread itself.
  struct Times {
    ByClient others_ns;
    std::int64_t own_ns = 0;
  };
  // The thread is not ready any more.
  Times Stop(int thread);
  // When the thread became ready; -1: it is not ready.
  std::int64_t ReadySince(int thread) const;

  // The times together made as long as `most_ns` where they are longer.
  static ByClient Shares(ByClient times_ns, std::int64_t most_ns);

 private:
  // So far back a thread may be said to have been ready.
  static constexpr std::size_t kMostSlices = 64;

  struct Slice {
    int thread = 0, client = 0;
    std::int64_t start_ns = 0, end_ns = 0;
  };
  struct Waiting {
    bool is_ready = false;
    int robot = 0;
    std::int64_t since_ns = 0;
    Times times;
  };
  struct OfRobot {
    std::vector<int> ready;          // threads, in any order
    std::deque<Slice> slices;        // the last
    std::int64_t latest_end_ns = 0;  // of any slice
  };

  static void Add(int thread, const Slice& slice, Waiting& waiting);

  std::vector<Waiting> waiting_;  // by thread
  std::vector<OfRobot> robots_;
};

}  // namespace tcs
