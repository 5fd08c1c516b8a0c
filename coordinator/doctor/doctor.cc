#include "coordinator/doctor/doctor.h"

#include <errno.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "coordinator/doctor/interpret.h"
#include "coordinator/doctor/wakeups.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/own_computer.h"
#include "coordinator/os/pipe.h"
#include "coordinator/os/real_time_facts.h"
#include "coordinator/os/spawning.h"
#include "coordinator/os/trap.h"
#include "coordinator/port/pidfds.h"
#include "coordinator/port/traps.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

std::string TextOf(const char* path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// As the shim asks it.
bool TellsEndWords() {
  std::uint64_t address = 0;
  return prctl(PR_GET_TID_ADDRESS, &address, 0, 0, 0) == 0;
}

Finding TryDescriptors() {
  const pid_t child = fork();
  if (child < 0) return JudgeDescriptors(errno, errno);
  if (child == 0) {
    alarm(5);
    for (;;) pause();
  }
  const UniqueFd pidfd(OpenPidfd(child));
  const UniqueFd fd(pidfd ? DuplicateFd(pidfd.get(), 0) : -1);
  const int descriptor_error = fd ? 0 : errno, memory_error = WhyNoLooksInto(child);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return JudgeDescriptors(descriptor_error, memory_error);
}

Finding TryShim(const std::string& path) {
  std::optional<Pipe> said = Pipe::Make();
  if (!said.has_value()) return JudgeShim(path, -1, "no pipe can be made");
  const pid_t child = fork();
  if (child == 0) {
    dup2(said->write_end.get(), STDERR_FILENO);
    setenv("LD_PRELOAD", path.c_str(), 1);
    unsetenv("TCS_SOCKET");
    alarm(5);
    execlp("true", "true", nullptr);
    _exit(127);
  }
  said->write_end.Reset();
  char text[512];
  const ssize_t n = child < 0 ? 0 : read(said->read_end.get(), text, sizeof text);
  int status = -1;
  if (child > 0) waitpid(child, &status, 0);
  return JudgeShim(path, status,
                   std::string(text, static_cast<std::size_t>(std::max<ssize_t>(0, n))));
}

Finding LookAtCpu() {
  cpu_set_t allowed;
  sched_getaffinity(0, sizeof allowed, &allowed);
  return JudgeCpu(LastAllowedCpu(), CPU_COUNT(&allowed),
                  TextOf("/sys/devices/system/cpu/isolated"));
}

const char* Word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kWarning:
      return "warning";
    case Verdict::kMissing:
      break;
  }
  return "missing";
}

const char* Colour(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "\033[32m";
    case Verdict::kWarning:
      return "\033[33m";
    case Verdict::kMissing:
      break;
  }
  return "\033[31m";
}

}  // namespace

std::vector<Finding> Examine(const std::string& preload_library) {
  return {
      JudgeRealTime(AskForRealTime()),
      JudgeThrottling(TextOf("/proc/sys/kernel/sched_rt_runtime_us"),
                      TextOf("/proc/sys/kernel/sched_rt_period_us"),
                      TextOf("/proc/sys/kernel/osrelease")),
      JudgeTrap(WhyNoTrap()),
      JudgeTsc(TextOf("/proc/cpuinfo"),
               TextOf("/sys/devices/system/clocksource/clocksource0/current_clocksource")),
      LookAtCpu(),
      TryDescriptors(),
      JudgeLayout(WhyNoFixedLayout()),
      JudgeNetworks(WhyNoComputer(), !MayMakeNamespaces()),
      JudgeLibc(gnu_get_libc_version(), TellsEndWords()),
      TryShim(preload_library),
      JudgeSteal(TextOf("/proc/stat")),
  };
}

Finding Calibrate() {
  return JudgeWakeups(MeasureWakeups(SCHED_OTHER), MeasureWakeups(SCHED_FIFO));
}

std::string ToText(const std::vector<Finding>& findings, bool colour) {
  std::string text;
  for (const Finding& f : findings) {
    const std::string word = fmt::format("{:<7}", Word(f.verdict));
    text += fmt::format("{}  {:<22}  {}\n", colour ? Colour(f.verdict) + word + "\033[0m" : word,
                        f.name, f.found);
    if (!f.mend.empty()) text += fmt::format("{:33}{}\n", "", f.mend);
  }
  return text;
}

std::string ToJson(const std::vector<Finding>& findings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Finding& f : findings) {
    json.push_back(
        {{"name", f.name}, {"verdict", Word(f.verdict)}, {"found", f.found}, {"mend", f.mend}});
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

bool CanRun(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& f) { return f.verdict == Verdict::kMissing; });
}

}  // namespace tcs
