#include "tests/bench/fleet_rows.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tests/bench/tcsim_run.h"

namespace tcs::bench {

namespace {

using Json = nlohmann::json;

constexpr int kFirstSensorPort = 28000, kFirstCommandPort = 28100;

std::string Address(int port) { return fmt::format("127.0.0.1:{}", port); }

// The results' tables and traces are written as ever.
std::string ScenarioFor(const FleetCase& fleet, double virtual_s) {
  Json bodies, robots, channels;
  for (int i = 0; i < fleet.robots; ++i) {
    const std::string body = fmt::format("drone{}", i), robot = fmt::format("robot{}", i);
    const int eyes = kFirstSensorPort + i, hands = kFirstCommandPort + i;
    bodies[body] = {{"mass", 2}, {"inertia", {0.1, 0.2, 0.25}}, {"position", {2 * i, 0, 1}}};
    Json command = {TCS_FLEET_CONTROLLER, std::to_string(eyes)};
    if (fleet.answers) command.push_back(std::to_string(hands));
    robots[robot]["clients"]["controller"] = {
        {"command", command}, {"class", "periodic"}, {"priority", 80}, {"body", body}};
    channels[fmt::format("eyes{}", i)] = {
        {"type", "udp_json"},
        {"sensors", {{"bodies", {body}}, {"rate", fleet.rate_hz}, {"to", Address(eyes)}}}};
    if (!fleet.answers) continue;
    channels[fmt::format("hands{}", i)] = {
        {"type", "udp_json"}, {"commands", {{"body", body}, {"listen", Address(hands)}}}};
  }
  return Json{{"duration", fmt::format("{}s", virtual_s)},
              {"dynamics", {{"gravity", {0, 0, -9.81}}}},
              {"bodies", bodies},
              {"robots", robots},
              {"channels", channels}}
      .dump();
}

std::optional<RunCosts> RunOnce(const FleetCase& fleet, double virtual_s) {
  const auto run = TcsimRun::Of("fleet", ScenarioFor(fleet, virtual_s));
  if (!run) return std::nullopt;
  const auto number = [&run](const char* key) { return run->summary().at(key).get<double>(); };
  const double samples = number("samples"), commands = number("commands");
  // The first sample comes before the programs have begun, the last one is not answered any more.
  if (fleet.answers && commands < samples - 2 * fleet.robots) {
    fmt::print(stderr, "tcs_bench: fleet: {} samples, but {} commands\n", samples, commands);
    return std::nullopt;
  }
  return RunCosts::Of(run->summary(), samples);
}

}  // namespace

std::optional<FleetRows> MeasureFleets(int rounds, bool quick) {
  FleetRows results{.rounds = rounds, .virtual_s = quick ? 0.1 : 10, .rows = {}};
  const auto fleets = CostsInTurns(kFleets.size(), rounds, [&results](std::size_t i) {
    return RunOnce(kFleets[i], results.virtual_s);
  });
  if (!fleets) return std::nullopt;
  for (std::size_t i = 0; i < kFleets.size(); ++i) {
    results.rows.push_back({kFleets[i], (*fleets)[i]});
  }
  return results;
}

}  // namespace tcs::bench
