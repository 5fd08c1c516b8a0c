// tcs_simulate: the coordinator's engine on a simulated host, seed by seed.
//
//   tcs_simulate [--first S] [--seeds N] [--seed S] [--steps N] [--trace]
//
// Each seed is a script of programs, and says how it runs: with levels or without, measured once,
// or twice under set costs. These two are on hosts whose luck differs, where the script has to come
// to the same, to the nanosecond; without signals a host with levels and one without, too. The
// first thing that does not hold ends it, with the seed that shows it; --seed S --trace then tells
// what happens on the way.
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "tests/simulate/broken.h"
#include "tests/simulate/luck.h"
#include "tests/simulate/simulation.h"

namespace tcs::simulate {

namespace {

struct Course {
  SimulationSeeds seeds;
  bool has_levels = true, is_fixed = false;
};

struct Request {
  std::uint64_t first = 1, seeds = 100;
  int steps = 2'000;
  bool traces = false;
};

Course g_course;  // under way: for who ends the program
long g_steps = 0;

void Tell(const Course& course) {
  fprintf(stderr, "seed %lu, host %lu, %s, %s: tcs_simulate --seed %lu\n", course.seeds.script,
          course.seeds.host, course.has_levels ? "levels" : "unprivileged",
          course.is_fixed ? "fixed" : "measured", course.seeds.script);
}

// Of a check of the coordinator's own that does not hold.
void OnAbort(int) {
  Tell(g_course);
  _exit(1);
}

std::vector<std::vector<std::int64_t>> Run(const Course& course, const Request& request) {
  g_course = course;
  Simulation simulation(course.seeds, course.has_levels, course.is_fixed);
  if (request.traces) simulation.TraceEvents();
  g_steps += simulation.Run(request.steps);
  if (request.traces) {
    Tell(course);
    simulation.TraceThreads();
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

void RunSeed(std::uint64_t seed, const Request& request) {
  const SimulationSeeds seeds{seed, 2 * seed}, elsewhere{seed, 2 * seed + 1};
  Luck luck = Luck(seed).Part(1);
  const bool has_levels = luck.OnceIn(2);
  if (luck.OnceIn(2)) {
    Run({seeds, has_levels, false}, request);
    return;
  }
  const bool has_both =
      !Simulation::HasSignals(seed) && !Simulation::HasTimers(seed) && luck.OnceIn(2);
  const auto one = Run({seeds, has_levels, true}, request);
  Compare(one, Run({elsewhere, has_both ? !has_levels : has_levels, true}, request));
}

Request RequestOf(int count, char** arguments) {
  Request request;
  for (int i = 1; i < count; ++i) {
    const std::string_view name = arguments[i];
    if (name == "--trace") {
      request.traces = true;
      continue;
    }
    const std::uint64_t value = i + 1 < count ? strtoull(arguments[++i], nullptr, 10) : 0;
    if (name == "--seed") {
      request.first = value;
      request.seeds = 1;
    } else if (name == "--first") {
      request.first = value;
    } else if (name == "--seeds") {
      request.seeds = value;
    } else if (name == "--steps") {
      request.steps = static_cast<int>(value);
    } else {
      fprintf(stderr, "tcs_simulate: there is no option %s; use --seeds N, --seed S or --trace\n",
              arguments[i]);
      exit(2);
    }
  }
  return request;
}

void RunSeeds(const Request& request) {
  signal(SIGABRT, OnAbort);
  const auto begun = std::chrono::steady_clock::now();
  for (std::uint64_t seed = request.first; seed < request.first + request.seeds; ++seed)
    RunSeed(seed, request);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  printf("%lu seeds, %ld steps, %.0f seeds and %.0f steps a second\n", request.seeds, g_steps,
         static_cast<double>(request.seeds) / took.count(),
         static_cast<double>(g_steps) / took.count());
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
  tcs::simulate::RunSeeds(tcs::simulate::RequestOf(count, arguments));
}
