#include "simbody_bridge/team.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <thread>

namespace tcs {
namespace {

// A wake across processors takes 50 to 90 us on virtual machines: less than half of this.
constexpr double kWorthAWakeNs = 200'000;
// A helper looks for more work for this long before it sleeps: steps come in rounds.
constexpr std::int64_t kLookNs = 30'000;
// A caller that waits longer than this for a helper that has begun, beside twice what a piece
// costs, does without help for a time: longer each time, until so many waits in a row have gone
// well.
constexpr std::int64_t kStarvedNs = 300'000, kLeftToOthersNs = 500'000'000;
constexpr int kMostDoublings = 6, kWellInARow = 100;
constexpr int kNiceness = -10;  // where that is permitted

std::int64_t HostNs() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

void Pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

class Team::Helper {
 public:
  Helper(Team& team, std::size_t worker, int cpu) : team_(team), worker_(worker) {
    // Signals of the process are for its other threads.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { Live(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    // Set from here: the helper would not get to do so itself beside the thread that has made it,
    // at real-time priority.
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu, &one);
    pthread_setaffinity_np(thread_.native_handle(), sizeof one, &one);
    const sched_param ordinary{};
    pthread_setschedparam(thread_.native_handle(), SCHED_OTHER, &ordinary);
  }
  ~Helper() {
    state_.store(kEnds);
    state_.notify_one();
    thread_.join();
  }

  void Ask() {
    state_.store(kAsked);
    state_.notify_one();
  }
  // True: the helper has not begun, and does not begin any more.
  bool TakeBack() {
    int asked = kAsked;
    return state_.compare_exchange_strong(asked, kIdle);
  }
  bool IsDone() const { return state_.load() == kIdle; }
  // The number of pieces that the helper did the last time.
  std::size_t done() const { return done_; }

 private:
  enum State : int { kIdle, kAsked, kWorks, kEnds };

  void Live() {
    setpriority(PRIO_PROCESS, 0, kNiceness);
    for (;;) {
      int asked = kAsked;
      if (state_.compare_exchange_strong(asked, kWorks)) {
        done_ = team_.Work(worker_);
        int works = kWorks;
        state_.compare_exchange_strong(works, kIdle);
        LookForMore();
        continue;
      }
      if (asked == kEnds) return;
      state_.wait(asked);
    }
  }

  void LookForMore() const {
    const std::int64_t until_ns = HostNs() + kLookNs;
    while (state_.load() == kIdle && HostNs() < until_ns) Pause();
  }

  Team& team_;
  const std::size_t worker_;
  std::atomic<int> state_{kIdle};
  std::size_t done_ = 0;
  std::thread thread_;
};

Team::Team(std::int64_t& helped) : helped_(helped) {}
Team::~Team() = default;

void Team::Set(std::span<const int> cpus) {
  helpers_.clear();
  for (const int cpu : cpus) {
    helpers_.push_back(std::make_unique<Helper>(*this, helpers_.size() + 1, cpu));
  }
}

// How many pieces the worker has done.
std::size_t Team::Work(std::size_t worker) {
  std::size_t done = 0;
  for (std::size_t piece = next_++; piece < count_; piece = next_++) {
    (*each_)(piece, worker);
    ++done;
  }
  return done;
}

void Team::ForEach(std::size_t count, PieceCost* cost, const Each& each) {
  if (count == 0) return;
  const std::int64_t start_ns = helpers_.empty() ? 0 : HostNs();
  const bool asks = !helpers_.empty() && count > 1 &&
                    (always_asks_ || (cost->ns() * static_cast<double>(count) > kWorthAWakeNs &&
                                      start_ns >= not_before_ns_));
  each_ = &each;
  count_ = count;
  next_ = 0;
  if (asks) {
    for (const auto& helper : helpers_) helper->Ask();
  }
  const std::size_t own = Work(0);
  if (helpers_.empty()) return;
  if (own > 0) cost->Learn(static_cast<double>(HostNs() - start_ns) / static_cast<double>(own));
  if (!asks) return;
  for (const auto& helper : helpers_) {
    if (helper->TakeBack()) continue;
    Await(*helper, static_cast<std::int64_t>(2 * cost->ns()) + kStarvedNs);
    helped_ += static_cast<std::int64_t>(helper->done());
  }
}

// The caller does not sleep: a thread that sleeps here lets others take this processor for idle.
void Team::Await(Helper& helper, std::int64_t most_ns) {
  const std::int64_t since_ns = HostNs();
  while (!helper.IsDone()) Pause();
  const std::int64_t waited_ns = HostNs() - since_ns;
  if (waited_ns <= most_ns) {
    if (++well_ >= kWellInARow) left_to_others_ = 0;
    return;
  }
  well_ = 0;
  not_before_ns_ =
      since_ns + waited_ns + (kLeftToOthersNs << std::min(left_to_others_++, kMostDoublings));
}

}  // namespace tcs
