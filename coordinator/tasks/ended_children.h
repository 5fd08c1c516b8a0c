// The time that each of a process's children had been charged when it ended, as long as its parent
// may ask: wait4 tells of it. Pure.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <cstdint>
#include <deque>

namespace tcs {

class EndedChildren {
 public:
  // The charge includes the children that the child has had itself. The kernel gives the child's
  // number away again.
  void Ended(pid_t pid, std::int64_t charged_ns) {
    if (children_.size() == kMost) children_.pop_front();
    children_.push_back({pid, charged_ns});
  }
  // -1 where the charge is not known any more.
  std::int64_t ChargedNs(pid_t pid) const {
    const auto last = std::find_if(children_.rbegin(), children_.rend(),
                                   [pid](const Child& child) { return child.pid == pid; });
    return last == children_.rend() ? -1 : last->charged_ns;
  }

 private:
  // Most parents never ask, and some have a million children.
  static constexpr std::size_t kMost = 1024;

  struct Child {
    pid_t pid = 0;
    std::int64_t charged_ns = 0;
  };
  std::deque<Child> children_;
};

}  // namespace tcs
