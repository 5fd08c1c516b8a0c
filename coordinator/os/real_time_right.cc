#include "coordinator/os/real_time_right.h"

#include <string.h>

namespace tcs {

namespace {

bool CapabilityCounts(const RealTimeFacts& facts) {
  return facts.has_capability && !facts.in_user_namespace;
}

const std::string kNeeded = std::to_string(kRealTimeNeeded);  // in sentences
constexpr char kNoThrottle[] = "`sysctl -w kernel.sched_rt_runtime_us=-1`";

std::string WhyNo(RealTimeObstacle obstacle, const RealTimeFacts& facts) {
  const std::string capability = facts.has_capability
                                     ? "CAP_SYS_NICE does not count in a user namespace"
                                     : "CAP_SYS_NICE is missing";
  switch (obstacle) {
    case RealTimeObstacle::kFilter:
      return facts.is_filtered ? "a seccomp filter refuses it"
                               : "the sandbox that this is refuses the call";
    case RealTimeObstacle::kNoRight:
      return capability + " and RLIMIT_RTPRIO is 0";
    case RealTimeObstacle::kLowLimit:
      return capability + " and RLIMIT_RTPRIO is " + std::to_string(facts.limit) + ", below " +
             kNeeded;
    case RealTimeObstacle::kGroup:
      return "its real-time group has no budget: " + facts.group->folder +
             "/cpu.rt_runtime_us is 0";
    case RealTimeObstacle::kUnknown:
      break;
  }
  return std::string("the kernel says '") + strerror(facts.error) +
         "' to one who has the right: the real-time group has no budget, or a security module "
         "refuses it";
}

std::string MendOfRight(const RealTimeFacts& facts) {
  if (facts.can_raise_limit) {
    return "call `ulimit -r " + kNeeded + "` in the shell that starts tcsim";
  }
  if (facts.in_user_namespace) {
    return "set the limit outside of the user namespace, by `ulimit -r " + kNeeded +
           "` or '@GROUP - rtprio " + kNeeded + "' in /etc/security/limits.conf";
  }
  if (facts.is_root || !facts.may_get_capability) {
    return "start it with CAP_SYS_NICE or with RLIMIT_RTPRIO at " + kNeeded +
           " (docker: --cap-add SYS_NICE for root, --ulimit rtprio=" + kNeeded +
           " for everybody; systemd: LimitRTPRIO=" + kNeeded + ")";
  }
  return "run tcsim as root, or call `sudo prlimit --rtprio=" + kNeeded +
         " --pid $$` in the shell that starts it (for good: '@GROUP - rtprio " + kNeeded +
         "' in /etc/security/limits.conf)";
}

std::string MendOfGroup(const RealTimeGroup& group, bool is_root) {
  const std::string for_all = std::string(is_root ? "call " : "let root call ") + kNoThrottle +
                              ", on the host if this is a container";
  if (group.with_budget.empty()) return for_all;
  // A process that root moves is root's; a user's shell is named by its number.
  if (!is_root) {
    return for_all +
           ", or put the shell that starts tcsim into a group with a budget: `echo $$ | " +
           "sudo tee " + group.with_budget + "/tasks`";
  }
  return "call `echo $$ >" + group.with_budget + "/tasks` in the shell that starts tcsim, or " +
         kNoThrottle;
}

std::string MendOfObstacle(RealTimeObstacle obstacle, const RealTimeFacts& facts) {
  switch (obstacle) {
    case RealTimeObstacle::kFilter:
      return "start tcsim outside of it, or let it permit sched_setscheduler (systemd: "
             "RestrictRealtime=no; docker: --security-opt seccomp=FILE)";
    case RealTimeObstacle::kNoRight:
    case RealTimeObstacle::kLowLimit:
      return MendOfRight(facts);
    case RealTimeObstacle::kGroup:
      return MendOfGroup(*facts.group, facts.is_root);
    case RealTimeObstacle::kUnknown:
      break;
  }
  return std::string(facts.is_root ? "call " : "let root call ") + kNoThrottle +
         ", on the host if this is a container, or look for the security module in `dmesg`";
}

std::string JoinedObstacles(const RealTimeFacts& facts, const char* separator,
                            std::string (*say)(RealTimeObstacle, const RealTimeFacts&)) {
  std::string text;
  for (const RealTimeObstacle obstacle : ObstaclesOf(facts)) {
    text += (text.empty() ? "" : separator) + say(obstacle, facts);
  }
  return text;
}

}  // namespace

std::vector<RealTimeObstacle> ObstaclesOf(const RealTimeFacts& facts) {
  if (facts.error == 0) return {};
  std::vector<RealTimeObstacle> all;
  if (!facts.reaches_kernel) all.push_back(RealTimeObstacle::kFilter);
  if (!CapabilityCounts(facts) && facts.limit < kRealTimeNeeded) {
    all.push_back(facts.limit == 0 ? RealTimeObstacle::kNoRight : RealTimeObstacle::kLowLimit);
  }
  if (facts.group && facts.group->budget_us == 0) all.push_back(RealTimeObstacle::kGroup);
  if (all.empty()) all.push_back(RealTimeObstacle::kUnknown);
  return all;
}

bool GivesRealTime(const RealTimeFacts& facts) {
  return CapabilityCounts(facts) || facts.limit > 0;
}

std::string WhyNoRealTime(const RealTimeFacts& facts) {
  return JoinedObstacles(facts, "; ", WhyNo);
}

std::string MendOfRealTime(const RealTimeFacts& facts) {
  return JoinedObstacles(facts, "; then ", MendOfObstacle);
}

}  // namespace tcs
