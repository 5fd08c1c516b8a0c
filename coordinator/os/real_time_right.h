// The obstacles that keep a process from SCHED_FIFO, and how to mend them. Pure: facts in, words
// out. The facts come from the kernel, which is asked (real_time_facts.h): the user's identity does
// not tell. Root may be refused, and an ordinary user permitted.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tcs {

// The group of the kernel's cpu controller that a process is in, where groups have budgets of
// real-time: cgroups of version 1 on kernels with real-time groups.
struct RealTimeGroup {
  std::string folder;       // of the group's files
  long budget_us = 0;       // the group's cpu.rt_runtime_us
  std::string with_budget;  // the folder of the nearest group above that has a budget; empty: none
};

struct RealTimeFacts {
  int error = 0;  // errno of asking for SCHED_FIFO at the highest level of a run; 0: permitted
  bool reaches_kernel = true;   // a call that only the kernel itself calls invalid was called so
  bool is_filtered = false;     // by seccomp, be it this call or another one
  bool has_capability = false;  // CAP_SYS_NICE is in effect
  bool may_get_capability = false;  // CAP_SYS_NICE is in the bounding set
  bool in_user_namespace = false;   // where that capability does not count
  bool is_root = false;             // only for the wording: "run tcsim as root" is nothing for root
  unsigned long limit = 0;          // RLIMIT_RTPRIO
  bool can_raise_limit = false;     // to what is needed; a child has tried it
  std::optional<RealTimeGroup> group;  // none: there are no such groups, or the group is not seen
};

// The priority that a run needs, that of Level::kKernelOnly.
constexpr int kRealTimeNeeded = 14;

enum class RealTimeObstacle {
  kFilter,    // a seccomp filter, or a sandbox, refuses the call
  kNoRight,   // neither the capability nor any limit
  kLowLimit,  // a limit that is too low
  kGroup,     // a real-time group without a budget
  kUnknown,   // none of these
};

// All obstacles in the way; empty if SCHED_FIFO is permitted.
std::vector<RealTimeObstacle> ObstaclesOf(const RealTimeFacts& facts);

// Whether this host has given its user the right to some real-time priority, by a capability or a
// limit, whether the kernel lets the user have it here or not.
bool GivesRealTime(const RealTimeFacts& facts);

// Clauses: the obstacles in the way, and their remedies, which begin with a verb. Empty if
// SCHED_FIFO is permitted.
std::string WhyNoRealTime(const RealTimeFacts& facts);
std::string MendOfRealTime(const RealTimeFacts& facts);

}  // namespace tcs
