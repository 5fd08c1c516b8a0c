// tcs_simulate: the coordinator's engine on a simulated host, seed by seed.
//
//   tcs_simulate [--seeds N] [--seed S] [--steps N] [--trace]
//
// Each seed is a script of programs that runs four times: with levels and without, measured and
// under set costs; the last ones on two hosts whose luck differs, on which they have to come to the
// same, to the nanosecond. It ends at the first thing that does not hold, with the seed that shows
// it.
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "tests/simulate/broken.h"
#include "tests/simulate/simulation.h"

namespace tcs::simulate {

struct Course {
  SimulationSeeds seeds;
  bool has_levels = true, is_fixed = false;
};

namespace {

Course g_course;
long g_steps = 0;

}  // namespace

bool g_traces = false;

namespace {

void Tell(const Course& course) {
  fprintf(stderr, "seed %lu, host %lu, %s, %s: tcs_simulate --seed %lu\n", course.seeds.script,
          course.seeds.host, course.has_levels ? "levels" : "gates only",
          course.is_fixed ? "fixed" : "measured", course.seeds.script);
}

// Of a check of the coordinator's own that does not hold.
void OnAbort(int) {
  Tell(g_course);
  _exit(1);
}

std::vector<std::vector<std::int64_t>> Run(const Course& course, int steps) {
  g_course = course;
  Simulation simulation(course.seeds, course.has_levels, course.is_fixed);
  if (g_traces) simulation.TraceAll();
  g_steps += simulation.Run(steps);
  if (g_traces) {
    Tell(course);
    simulation.Trace();
  }
  return simulation.Shown();
}

// As far as both have come. What differs first is told.
void Compare(const std::vector<std::vector<std::int64_t>>& one,
             const std::vector<std::vector<std::int64_t>>& other) {
  std::size_t first = one.size(), act = 0;
  std::int64_t at_ns = INT64_MAX;
  for (std::size_t thread = 0; thread < one.size(); ++thread) {
    const std::size_t both = std::min(one[thread].size(), other[thread].size());
    for (std::size_t i = 0; i < both && one[thread][i] < at_ns; ++i) {
      if (one[thread][i] == other[thread][i]) continue;
      first = thread;
      act = i;
      at_ns = std::min(one[thread][i], other[thread][i]);
    }
  }
  if (first == one.size()) return;
  Broken("thread %zu's clock showed %ld after its act %zu, and %ld on another host", first,
         one[first][act], act, other[first][act]);
}

void RunSeed(std::uint64_t seed, int steps) {
  const SimulationSeeds seeds{seed, 2 * seed}, elsewhere{seed, 2 * seed + 1};
  Run({seeds, true, false}, steps);
  Run({seeds, false, false}, steps);
  const auto once = Run({seeds, true, true}, steps);
  Compare(once, Run({elsewhere, true, true}, steps));
  const auto by_gates = Run({seeds, false, true}, steps);
  Compare(by_gates, Run({elsewhere, false, true}, steps));
  if (seed % 3 == 0) Compare(once, by_gates);
}

}  // namespace

void Broken(const char* what, ...) {
  va_list arguments;
  va_start(arguments, what);
  vfprintf(stderr, what, arguments);
  va_end(arguments);
  fprintf(stderr, "\n");
  Tell(g_course);
  _exit(1);
}

}  // namespace tcs::simulate

int main(int count, char** arguments) {
  std::uint64_t first = 1, seeds = 100;
  int steps = 2'000;
  for (int i = 1; i < count; ++i) {
    const std::string_view name = arguments[i];
    if (name == "--trace") {
      tcs::simulate::g_traces = true;
      continue;
    }
    const std::uint64_t value = i + 1 < count ? strtoull(arguments[++i], nullptr, 10) : 0;
    if (name == "--seeds") seeds = value;
    if (name == "--seed") first = value, seeds = 1;
    if (name == "--first") first = value;
    if (name == "--steps") steps = static_cast<int>(value);
  }
  signal(SIGABRT, tcs::simulate::OnAbort);
  const auto begun = std::chrono::steady_clock::now();
  for (std::uint64_t seed = first; seed < first + seeds; ++seed)
    tcs::simulate::RunSeed(seed, steps);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  printf("%lu seeds, %ld steps, %.0f steps a second\n", seeds, tcs::simulate::g_steps,
         static_cast<double>(tcs::simulate::g_steps) / took.count());
}
