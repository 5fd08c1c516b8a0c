// tcs_bench_probe WORLD WHAT [STEPS]: measures one thing and prints one number, TSC ticks per call
// (of `work`: seconds, of `explored`: states in STEPS seconds). Exit status 1, with a sentence on
// stderr, where it could not.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/bench/probe/calls.h"
#include "tests/bench/probe/explored.h"
#include "tests/bench/probe/handover.h"
#include "tests/bench/probe/ping_pong.h"
#include "tests/bench/probe/whose_time.h"
#include "tests/bench/probe/work.h"

namespace {

int Fail(const std::string& why) {
  fprintf(stderr, "tcs_bench_probe: %s\n", why.c_str());
  return 1;
}

double Measure(const std::string& what, const char* steps) {
  if (what == "clock") return tcs::bench::ClockReadTicks();
  if (what == "sleep") return tcs::bench::ShortSleepTicks();
  if (what == "exchange") return tcs::bench::ExchangeTicks();
  if (what == "mutex") return tcs::bench::MutexTicks();
  if (what == "kernel_call") return tcs::bench::KernelCallTicks();
  if (what == "handover") return tcs::bench::HandoverTicks();
  if (what == "ping_pong") return tcs::bench::PingPongTicks();
  if (what == "work") return tcs::bench::SecondsOfWork(std::atoll(steps));
  if (what == "explored") return tcs::bench::StatesExplored(std::atof(steps));
  return -1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return Fail("usage: tcs_bench_probe WORLD WHAT [STEPS]");
  const std::string world = argv[1];
  if (const std::string why = tcs::bench::NotIn(world); !why.empty()) {
    return Fail("this is not " + world + ": " + why);
  }
  const double number = Measure(argv[2], argc > 3 ? argv[3] : "0");
  if (number < 0) return Fail(std::string(argv[2]) + " cannot be measured here");
  printf("%.6f\n", number);
  return 0;
}
