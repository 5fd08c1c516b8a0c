#include "tests/bench/dispatch_rows.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/bench/attempt.h"
#include "tests/bench/bare_switches.h"
#include "tests/bench/tcsim_run.h"

namespace tcs::bench {

namespace {

using Json = nlohmann::json;

// However many there are, one of them wakes so often.
constexpr int kUsBetweenWakes = 50;

// One robot with one core: its clients wake in turns.
std::string ScenarioFor(int clients, double virtual_s) {
  Json all;
  for (int i = 0; i < clients; ++i) {
    all[fmt::format("sleeper{}", i)]["command"] = {TCS_BENCH_SLEEPER,
                                                   std::to_string(clients * kUsBetweenWakes),
                                                   std::to_string(i * kUsBetweenWakes)};
  }
  return Json{{"duration", fmt::format("{}s", virtual_s)},
              {"robots", {{"crowd", {{"clients", all}}}}}}
      .dump();
}

struct Numbers {
  double bare_us, tcs_us, ratio, coordinating_us;
};

// What a run came to.
struct Sums {
  double dispatches, real_us, coordinating_us;
};

std::optional<Sums> RunFor(int clients, double virtual_s) {
  const auto run = TcsimRun::Of("dispatch", ScenarioFor(clients, virtual_s));
  if (!run) return std::nullopt;
  const auto number = [&run](const char* key) { return run->summary().at(key).get<double>(); };
  return Sums{number("dispatches"), (number("real_ns") - number("clients_ns")) / 1e3,
              number("coordinating_ns") / 1e3};
}

// What a longer run takes more than a shorter one: starting its clients is no part of that.
std::optional<Numbers> MeasureOnce(int clients, double virtual_s) {
  const auto bare_us =
      MeasureBareSwitches(clients, static_cast<int>(virtual_s * 1e6 / kUsBetweenWakes));
  if (!bare_us) return std::nullopt;
  const auto shorter = RunFor(clients, virtual_s), longer = RunFor(clients, 2 * virtual_s);
  if (!shorter || !longer) return std::nullopt;
  const double dispatches = longer->dispatches - shorter->dispatches;
  const double tcs_us = (longer->real_us - shorter->real_us) / dispatches;
  return Numbers{*bare_us, tcs_us, tcs_us / *bare_us,
                 (longer->coordinating_us - shorter->coordinating_us) / dispatches};
}

DispatchRow RowOf(int clients, const std::vector<Numbers>& rounds) {
  const auto spread = [&rounds](double Numbers::*number) {
    std::vector<double> values;
    for (const Numbers& round : rounds) values.push_back(round.*number);
    return SpreadOf(values);
  };
  return {.clients = clients,
          .bare_us = spread(&Numbers::bare_us).median,
          .tcs_us = spread(&Numbers::tcs_us).median,
          .ratio = spread(&Numbers::ratio),
          .coordinating_us = spread(&Numbers::coordinating_us).median};
}

}  // namespace

std::optional<DispatchRows> MeasureDispatches(int rounds, bool quick) {
  const double virtual_s = quick ? 0.1 : 3;
  DispatchRows results{.rounds = rounds, .rows = {}};
  auto crowds = kCrowds;
  if (quick) {
    for (int& crowd : crowds) crowd = (crowd + 3) / 4;
  }
  std::array<std::vector<Numbers>, kCrowds.size()> all;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < crowds.size(); ++i) {
      const auto got = Attempt([&] { return MeasureOnce(crowds[i], virtual_s); });
      if (!got) return std::nullopt;
      all[i].push_back(*got);
    }
  }
  for (std::size_t i = 0; i < crowds.size(); ++i) {
    results.rows.push_back(RowOf(crowds[i], all[i]));
  }
  return results;
}

}  // namespace tcs::bench
