// From what the kernel says to a finding. Pure: text and numbers in, finding out.
#pragma once

#include <optional>
#include <string>

#include "coordinator/doctor/finding.h"
#include "coordinator/doctor/wakeups.h"
#include "coordinator/os/own_computer.h"
#include "coordinator/os/real_time_right.h"

namespace tcs {

// `facts`: what the kernel said when it was asked (AskForRealTime).
Finding JudgeRealTime(const RealTimeFacts& facts);
// Texts: /proc/sys/kernel/sched_rt_runtime_us, .../sched_rt_period_us and .../osrelease. From
// Linux 6.12 on the scheduler's fair server does what throttling did, and does not heed its
// setting.
Finding JudgeThrottling(const std::string& runtime_us, const std::string& period_us,
                        const std::string& release);
// `error`: the errno of installing the trap; 0 if it was installed.
Finding JudgeTrap(int error);
// `cpuinfo`: /proc/cpuinfo; `clocksource`: the kernel's current one.
Finding JudgeTsc(const std::string& cpuinfo, const std::string& clocksource);
// `cpu`: the one that tcs takes; `isolated`: /sys/devices/system/cpu/isolated, such as "2-3,6".
Finding JudgeCpu(int cpu, int allowed, const std::string& isolated);
// Errnos, 0 if it worked: of taking a descriptor out of an own child (pidfd_getfd), and of reading
// its memory (process_vm_readv).
Finding JudgeDescriptors(int descriptor_error, int memory_error);
// `error`: the errno of asking for a process without address-space randomisation; 0 if it worked.
Finding JudgeLayout(int error);
// `why_not`: of making a robot a computer of its own (WhyNoComputer); `in_user_namespace`: it takes
// one (MayMakeNamespaces).
Finding JudgeNetworks(const std::optional<NoComputer>& why_not, bool in_user_namespace);
// `version`: of the C library, such as "2.36"; `tells_end_words`: the kernel says which word it
// clears at a thread's end (TellsEndWords).
Finding JudgeLibc(const std::string& version, bool tells_end_words);
// `wait_status` of a program run with the shim at `path` preloaded, and what it said on stderr.
Finding JudgeShim(const std::string& path, int wait_status, const std::string& said);
// `stat`: /proc/stat, since the machine's start.
Finding JudgeSteal(const std::string& stat);
// Of ordinary threads and of real-time ones, as far as there can be any.
Finding JudgeWakeups(const std::optional<Wakeups>& ordinary,
                     const std::optional<Wakeups>& real_time);

}  // namespace tcs
