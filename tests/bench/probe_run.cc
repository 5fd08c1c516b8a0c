#include "tests/bench/probe_run.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "tests/bench/attempt.h"
#include "tests/bench/child.h"

namespace tcs::bench {

namespace {

std::string Beside(const char* program) {
  return std::filesystem::read_symlink("/proc/self/exe").replace_filename(program);
}

std::vector<std::string> CommandFor(const Probe& probe) {
  const std::string program = Beside("tcs_bench_probe");
  switch (probe.world) {
    case World::kTcs:
      return {Beside("tcsim"), "exec", "--rdtsc",  "host",     "--",
              program,         "tcs",  probe.what, probe.steps};
    case World::kFaketime:
      return {"faketime", "2000-01-01 00:00:00", program, "faketime", probe.what, probe.steps};
    case World::kNative:
      break;
  }
  return {program, "native", probe.what, probe.steps};
}

std::optional<double> RunOnce(const Probe& probe) {
  const ChildResult run = RunChild(CommandFor(probe));
  if (!run.error.empty()) {
    fmt::print(stderr, "tcs_bench: {}: {}\n", probe.what, run.error);
    return std::nullopt;
  }
  char* end = nullptr;
  const double number = std::strtod(run.output.c_str(), &end);
  if (end == run.output.c_str() || number <= 0) {
    fmt::print(stderr, "tcs_bench: {}: not a measurement: '{}'\n", probe.what, run.output);
    return std::nullopt;
  }
  return number;
}

}  // namespace

std::optional<double> RunProbe(const Probe& probe) {
  return Attempt([&] { return RunOnce(probe); });
}

}  // namespace tcs::bench
