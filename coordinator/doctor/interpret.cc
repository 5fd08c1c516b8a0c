#include "coordinator/doctor/interpret.h"

#include <errno.h>
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <sstream>

#include "coordinator/os/tsc_facts.h"

namespace tcs {

namespace {

long ToLong(const std::string& text, long otherwise) {
  long value = otherwise;
  return std::sscanf(text.c_str(), "%ld", &value) == 1 ? value : otherwise;
}

// True if `number` is in a kernel list such as "0,4-7".
bool Contains(const std::string& list, int number) {
  std::stringstream ranges(list);
  for (std::string range; std::getline(ranges, range, ',');) {
    int first = 0, last = 0;
    const int n = std::sscanf(range.c_str(), "%d-%d", &first, &last);
    if (n == 1) last = first;
    if (n >= 1 && first <= number && number <= last) return true;
  }
  return false;
}

}  // namespace

Finding JudgeRealTime(const RealTimeFacts& facts) {
  constexpr char kName[] = "real-time priority";
  if (facts.error == 0) {
    return {kName, Verdict::kOk,
            fmt::format("SCHED_FIFO {} is permitted: priorities keep the threads of a run apart; "
                        "without them gates would, with the same results, but more slowly",
                        kRealTimeNeeded),
            ""};
  }
  const std::string refused =
      fmt::format("SCHED_FIFO {} is refused ({})", kRealTimeNeeded, WhyNoRealTime(facts));
  return {
      kName, Verdict::kWarning,
      refused + ": gates and a signal keep the threads of a run apart, with the same results",
      "with it, runs take less time, most of all beside other programs: " + MendOfRealTime(facts)};
}

Finding JudgeThrottling(const std::string& runtime_us, const std::string& period_us,
                        const std::string& release) {
  constexpr char kName[] = "real-time throttling";
  int major = 0, minor = 0;
  std::sscanf(release.c_str(), "%d.%d", &major, &minor);
  const long runtime = ToLong(runtime_us, -1), period = ToLong(period_us, 1'000'000);
  const bool is_off = runtime < 0 || runtime >= period;
  // Since 6.12 only kernels with real-time groups heed the setting; others have a fair server.
  if (major > 6 || (major == 6 && minor >= 12)) {
    const std::string also =
        is_off ? ""
               : "`sysctl -w kernel.sched_rt_runtime_us=-1` on kernels with real-time groups, ";
    return {
        kName, Verdict::kWarning,
        "a processor that a run keeps busy has up to 50 ms of each second for others",
        "results do not change, but runs take that much longer; as root, " + also +
            "`echo 0 > /sys/kernel/debug/sched/fair_server/cpuN/runtime` for processor N, where "
            "the kernel permits it, turns it off"};
  }
  if (is_off) return {kName, Verdict::kOk, "off", ""};
  return {kName, Verdict::kWarning,
          fmt::format("real-time programs get {:.0f} % of each {:.1f} s",
                      100.0 * static_cast<double>(runtime) / static_cast<double>(period),
                      static_cast<double>(period) * 1e-6),
          "results do not change, but runs take that much longer; `sysctl -w "
          "kernel.sched_rt_runtime_us=-1` turns it off"};
}

Finding JudgeTrap(int error) {
  constexpr char kName[] = "system-call trap";
  if (error == 0) return {kName, Verdict::kOk, "yes", ""};
  return {kName, Verdict::kWarning,
          fmt::format("no: {}", error == EBUSY ? "another one is installed" : strerror(error)),
          "threads would wait for each other in real time; run tcsim on Linux 5.5 or newer, and "
          "outside a sandbox that uses seccomp notifications itself"};
}

Finding JudgeTsc(const std::string& cpuinfo, const std::string& clocksource) {
  const std::string source = clocksource.substr(0, clocksource.find('\n'));
  const TscKind kind = KindOfTsc(cpuinfo);
  if (kind == TscKind::kOfGuest) {
    return {
        "invariant TSC", Verdict::kWarning,
        "its rate is constant, but this hypervisor does not say that it never stops",
        "have the guest's processor show nonstop_tsc (QEMU: `-cpu host,+invtsc`), or see that the "
        "host's is so"};
  }
  if (kind == TscKind::kNoClock) {
    return {"invariant TSC", Verdict::kMissing, "this processor's TSC changes its rate or stops",
            "use a machine whose /proc/cpuinfo shows constant_tsc and nonstop_tsc; `--accounting "
            "fixed` needs no TSC"};
  }
  if (source != "tsc" && source != "kvm-clock") {
    return {"invariant TSC", Verdict::kWarning,
            fmt::format("yes, but the kernel's own clock is '{}'", source),
            "the kernel did not trust the TSC; look for 'tsc' in `dmesg`"};
  }
  return {"invariant TSC", Verdict::kOk, fmt::format("yes; the kernel's clock is '{}'", source),
          ""};
}

Finding JudgeCpu(int cpu, int allowed, const std::string& isolated) {
  const std::string which = fmt::format("CPU {} of {} allowed", cpu, allowed);
  if (Contains(isolated, cpu)) return {"processor", Verdict::kOk, which + ", isolated", ""};
  if (allowed > 1) {
    return {"processor", Verdict::kOk, which + ", shared with ordinary programs", ""};
  }
  return {"processor", Verdict::kWarning, which + ": ordinary programs stand still during a run",
          "give it a second processor, so that your terminal goes on"};
}

Finding JudgeDescriptors(int descriptor_error, int memory_error) {
  constexpr char kName[] = "descriptors of clients";
  if (memory_error != 0) {
    return {kName, Verdict::kMissing,
            fmt::format("tcsim may not read the memory of its own children: {}",
                        strerror(memory_error)),
            "set kernel.yama.ptrace_scope below 3; where a seccomp profile is in the way, allow "
            "process_vm_readv (docker: --cap-add SYS_PTRACE)"};
  }
  if (descriptor_error == 0) {
    return {kName, Verdict::kOk,
            "pidfd_getfd works; without it a process beside each program would hand descriptors "
            "over, with the same results, but more slowly",
            ""};
  }
  const std::string refused =
      fmt::format("pidfd_getfd is refused ({})", strerror(descriptor_error));
  const std::string how = "docker: --cap-add SYS_PTRACE, or a seccomp profile that allows it";
  return {kName, Verdict::kWarning,
          refused +
              ": a process beside each program hands them over, and SCHED_FIFO is not used, "
              "with the same results",
          "with it, runs take less time: " + how};
}

Finding JudgeLayout(int error) {
  constexpr char kName[] = "address layout";
  if (error == 0) {
    return {kName, Verdict::kOk, "the same in each run under `--accounting fixed`", ""};
  }
  return {kName, Verdict::kWarning,
          fmt::format("different in each run: personality is refused ({})", strerror(error)),
          "programs that depend on addresses (for example on the order of pointers) do not repeat "
          "to the byte under `--accounting fixed`; allow personality(ADDR_NO_RANDOMIZE), as "
          "docker's --security-opt seccomp=FILE can"};
}

Finding JudgeNetworks(const std::optional<NoComputer>& why_not, bool in_user_namespace) {
  constexpr char kName[] = "networks of robots";
  if (!why_not) {
    return {kName, Verdict::kOk,
            fmt::format("`network` in a scenario works: {} and /dev/net/tun are permitted",
                        in_user_namespace ? "user namespaces" : "namespaces"),
            ""};
  }
  return {kName, Verdict::kWarning,
          fmt::format("no robot can have one of its own ({}: {})", why_not->step,
                      strerror(why_not->error)),
          "only scenarios with `network` take it: " + why_not->Mend()};
}

Finding JudgeLibc(const std::string& version, bool tells_end_words) {
  constexpr char kName[] = "C library";
  int major = 0, minor = 0;
  std::sscanf(version.c_str(), "%d.%d", &major, &minor);
  const auto is_since = [&](int of_two) { return major > 2 || (major == 2 && minor >= of_two); };
  if (is_since(43) && !tells_end_words) {
    return {kName, Verdict::kMissing,
            "glibc " + version +
                ", with which threads are joined at words that this kernel does not tell "
                "(PR_GET_TID_ADDRESS), so joins may wait for ever",
            "boot a kernel with CONFIG_CHECKPOINT_RESTORE, or run in a container with an older C "
            "library"};
  }
  if (is_since(35)) return {kName, Verdict::kOk, "glibc " + version, ""};
  return {kName, Verdict::kWarning, "glibc " + version,
          "tcs is made for glibc 2.35 and newer, and tested with 2.36, 2.41 and 2.43 (Debian 12, "
          "13 and sid)"};
}

Finding JudgeShim(const std::string& path, int wait_status, const std::string& said) {
  if (WIFEXITED(wait_status) && WEXITSTATUS(wait_status) == 0 && said.empty()) {
    return {"shim", Verdict::kOk, path + " loads", ""};
  }
  const std::string first = said.substr(0, said.find('\n'));
  return {"shim", Verdict::kMissing,
          first.empty() ? path + " does not load" : path + " does not load: " + first,
          "build it again with ./dev build; it belongs in ../lib beside the folder of tcsim"};
}

Finding JudgeSteal(const std::string& stat) {
  unsigned long long user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0,
                     steal = 0;
  std::sscanf(stat.c_str(), "cpu %llu %llu %llu %llu %llu %llu %llu %llu", &user, &nice, &system,
              &idle, &wait, &irq, &soft, &steal);
  const unsigned long long busy = user + nice + system + irq + soft + steal;
  const double percent =
      busy == 0 ? 0.0 : 100.0 * static_cast<double>(steal) / static_cast<double>(busy);
  const std::string found = fmt::format("the hypervisor took {:.1f} % of the busy time", percent);
  if (percent < 5.0) return {"stolen time", Verdict::kOk, found, ""};
  return {"stolen time", Verdict::kWarning, found,
          "it is never charged to clients, but runs take longer; use a machine with processors of "
          "its own"};
}

Finding JudgeWakeups(const std::optional<Wakeups>& ordinary,
                     const std::optional<Wakeups>& real_time) {
  const auto spec = [](const Wakeups& of) {
    const auto us = [](std::int64_t ns) { return std::max<std::int64_t>(1, (ns + 500) / 1000); };
    return fmt::format("cpu: {{wakeup: {{median: {}us, p99: {}us}}}}", us(of.median_ns),
                       us(of.p99_ns));
  };
  std::string found = ordinary.has_value() ? "of ordinary threads as " + spec(*ordinary)
                                           : "of ordinary threads not to be measured here";
  if (real_time.has_value()) found += ", of real-time ones as " + spec(*real_time);
  return {"wake-ups", Verdict::kOk, found, ""};
}

}  // namespace tcs
