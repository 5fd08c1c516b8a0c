// Work that is shared out to other processors of the host: threads of this process, one bound to
// each, which help where it is worth waking them. The caller does its part itself, and waits only
// for pieces that a helper has begun: a helper that does not get its processor costs nothing but
// the wake.
//
// Helpers have ordinary priority, take no signals, and end with the team. One thread at a time
// calls a team.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace tcs {

// The cost of one piece of some kind of work of late, on average.
class PieceCost {
 public:
  void Learn(double ns) { ns_ += (ns - ns_) / 8; }
  double ns() const { return ns_; }

 private:
  double ns_ = 0;
};

class Team {
 public:
  // Counts in `helped` the pieces that were done by helpers; `helped` outlives this.
  explicit Team(std::int64_t& helped);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  // Puts a helper on each of these processors; earlier helpers end.
  void Set(std::span<const int> cpus);
  // The number of workers: the caller is worker 0.
  std::size_t workers() const { return helpers_.size() + 1; }

  // Calls `each` with 0, 1, … below `count` and the worker's number. The pieces do not depend on
  // each other, and throw nothing.
  using Each = std::function<void(std::size_t piece, std::size_t worker)>;
  void ForEach(std::size_t count, PieceCost* cost, const Each& each);

  // For tests: helpers are asked whatever it is worth.
  void AlwaysAsk() { always_asks_ = true; }

 private:
  class Helper;
  std::size_t Work(std::size_t worker);
  void Await(Helper& helper, std::int64_t most_ns);

  std::vector<std::unique_ptr<Helper>> helpers_;
  // Of the work in hand.
  const Each* each_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};

  std::int64_t& helped_;
  bool always_asks_ = false;
  int well_ = 0;                    // waits in a row that were as short as they should be
  int left_to_others_ = 0;          // in a row
  std::int64_t not_before_ns_ = 0;  // until then others need the processors
};

}  // namespace tcs
