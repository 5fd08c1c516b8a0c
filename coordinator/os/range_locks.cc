#include "coordinator/os/range_locks.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

namespace tcs {

namespace {

constexpr useconds_t kTurnUs = 100;
constexpr int kMostTurns = 10'000;
// A process may lock ranges for other reasons, as many as it likes: no more than these are listed.
constexpr std::size_t kMostRanges = 4096;

struct flock RangeOf(short type, std::int64_t first, std::int64_t last) {
  struct flock range {};
  range.l_type = type;
  range.l_whence = SEEK_SET;
  range.l_start = first;
  range.l_len = last - first + 1;
  return range;
}

}  // namespace

RangeLocks::RangeLocks(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}

void RangeLocks::Lock(std::int64_t first, std::int64_t last) {
  struct flock range = RangeOf(F_RDLCK, first, last);
  fcntl(fd_.get(), F_SETLK, &range);
}

void RangeLocks::Unlock(std::int64_t first, std::int64_t last) {
  struct flock range = RangeOf(F_UNLCK, first, last);
  fcntl(fd_.get(), F_SETLK, &range);
}

// The kernel names one of the locks that touch a range; on both sides of that lock there may be
// more.
std::vector<LockedRange> RangeLocks::OfOthers(std::int64_t first, std::int64_t last) const {
  std::vector<LockedRange> found;
  std::vector<std::pair<std::int64_t, std::int64_t>> todo{{first, last}};
  while (!todo.empty() && found.size() < kMostRanges) {
    const auto [from, to] = todo.back();
    todo.pop_back();
    if (from > to) continue;
    struct flock range = RangeOf(F_WRLCK, from, to);
    if (fcntl(fd_.get(), F_GETLK, &range) != 0 || range.l_type == F_UNLCK) continue;
    // A length of 0: to the end of all files.
    const std::int64_t end = range.l_len == 0 ? std::numeric_limits<std::int64_t>::max()
                                              : range.l_start + range.l_len - 1;
    found.push_back({range.l_start, end, std::max(range.l_pid, 0)});
    todo.emplace_back(from, range.l_start - 1);
    if (end < to) todo.emplace_back(end + 1, to);
  }
  std::sort(found.begin(), found.end(),
            [](const LockedRange& a, const LockedRange& b) { return a.first < b.first; });
  return found;
}

RangeLocks::Alone::Alone(const RangeLocks& locks) : locks_(locks) {
  for (int turn = 0; locks_.present() && turn < kMostTurns; ++turn, usleep(kTurnUs)) {
    if (flock(locks_.fd_.get(), LOCK_EX | LOCK_NB) == 0) return;
  }
}

RangeLocks::Alone::~Alone() {
  if (locks_.present()) flock(locks_.fd_.get(), LOCK_UN);
}

}  // namespace tcs
