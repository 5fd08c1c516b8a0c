#include "tests/bench/run_costs.h"

#include "tests/bench/attempt.h"

namespace tcs::bench {

RunCosts RunCosts::Of(const nlohmann::json& summary, double events) {
  const auto number = [&summary](const char* key) { return summary.at(key).get<double>(); };
  const auto each_us = [&](const char* key) { return number(key) / 1e3 / events; };
  return {.speed = number("virtual_ns") / number("real_ns"),
          .real_us = each_us("real_ns"),
          .programs_us = each_us("clients_ns"),
          .world_us = each_us("dynamics_ns"),
          .coordinating_us = each_us("coordinating_ns"),
          .dispatches = number("dispatches") / events};
}

CostsSpread CostsSpread::Of(const std::vector<RunCosts>& runs) {
  const auto spread = [&runs](double RunCosts::*number) {
    std::vector<double> values;
    for (const RunCosts& run : runs) values.push_back(run.*number);
    return SpreadOf(values);
  };
  return {.speed = spread(&RunCosts::speed),
          .real_us = spread(&RunCosts::real_us).median,
          .programs_us = spread(&RunCosts::programs_us).median,
          .world_us = spread(&RunCosts::world_us).median,
          .coordinating_us = spread(&RunCosts::coordinating_us).median,
          .dispatches = spread(&RunCosts::dispatches).median};
}

std::optional<std::vector<CostsSpread>> CostsInTurns(
    std::size_t cases, int rounds, const std::function<std::optional<RunCosts>(std::size_t)>& run) {
  std::vector<std::vector<RunCosts>> runs(cases);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < cases; ++i) {
      const auto costs = Attempt([&] { return run(i); });
      if (!costs) return std::nullopt;
      runs[i].push_back(*costs);
    }
  }
  std::vector<CostsSpread> all;
  for (const auto& of_one : runs) all.push_back(CostsSpread::Of(of_one));
  return all;
}

}  // namespace tcs::bench
