#include "tests/bench/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace tcs::bench {

namespace {

using Json = nlohmann::ordered_json;

std::string CallTable(const std::vector<CallRow>& rows) {
  static constexpr char kLine[] = "{:<24}{:>9}   {:<31}{:>9}{:>8}  {:<16}{}\n";
  auto one_digit = [](double ns) { return fmt::format("{:.1f}", ns); };
  std::string text =
      fmt::format(kLine, "under tcs", "ns", "reference", "ns", "ratio", "lowest-highest", "goal");
  for (const CallRow& row : rows) {
    text += fmt::format(
        kLine, row.benchmark.title, one_digit(row.ns), row.benchmark.reference_title,
        one_digit(row.reference_ns), fmt::format("{:.2f}", row.ratio.median),
        fmt::format("{:.2f}-{:.2f}", row.ratio.lowest, row.ratio.highest), row.benchmark.goal);
  }
  return text;
}

// `unit` is what the idle values are in.
std::string LoadTable(const char* title, const char* unit, const char* goal,
                      const std::vector<LoadRow>& rows) {
  std::string text = fmt::format("{:<24}{:>16}", title, "idle");
  for (std::size_t load = 1; load < kSpinnerCounts.size(); ++load) {
    text += fmt::format("   {:<21}", fmt::format("beside {} spinners", kSpinnerCounts[load]));
  }
  text += "goal\n";
  for (const LoadRow& row : rows) {
    text += fmt::format("{:<24}{:>9.6g} {:<6}", row.title, row.idle, unit);
    // Beside no spinners it is the idle value itself.
    for (std::size_t load = 1; load < kSpinnerCounts.size(); ++load) {
      const Spread& relative = row.relative[load];
      text += fmt::format("   {:<21}", fmt::format("{:.3f} ({:.3f}-{:.3f})", relative.median,
                                                   relative.lowest, relative.highest));
    }
    text += row.world == World::kTcs ? fmt::format("{}\n", goal) : "\n";
  }
  return text;
}

// Three significant digits, and as few as a whole number needs.
std::string Brief(double value) {
  return value >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:#.3g}", value);
}

std::string DdsTable(const DdsRows& dds) {
  static constexpr char kLine[] = "{:<7}{:<20}{:>3}{:>10}{:>10}{:>10}{:>12}  {:<16}{}\n";
  std::string text;
  const auto group = [&text](const char* title, const std::vector<DdsRow>& rows, bool has_goal) {
    text += fmt::format("{}\n", title);
    for (const DdsRow& row : rows) {
      const char* goal = !has_goal ? "" : row.more_is_better ? "ratio > 1" : "ratio < 1";
      text +=
          fmt::format(kLine, row.size, row.what, row.unit, Brief(row.value[0]), Brief(row.value[1]),
                      Brief(row.value[2]), fmt::format("{:.2f}", row.ratio.median),
                      fmt::format("{:.2f}-{:.2f}", row.ratio.lowest, row.ratio.highest), goal);
    }
  };
  text += fmt::format(kLine, "ddsperf", "", "", kCarrierNames[0], kCarrierNames[1],
                      kCarrierNames[2], "E/native", "lowest-highest", "goal");
  group("by the programs' own clocks: one way, and samples as fast as possible", dds.own_clocks,
        true);
  group("real seconds on the host, for 100,000 round trips or samples", dds.real_s, false);
  group("processor seconds on the host, for 100,000 round trips or samples", dds.cpu_s, false);
  text += fmt::format(
      "Medians of {} round{}. Natively over the kernel's loopback, on {} processor{}, in real "
      "time.\n"
      "Under tcs both programs are on a robot with two cores, and their clocks show what they "
      "compute\n"
      "themselves (Cyclone DDS and the shim included), not what tcs does between them. The host's\n"
      "seconds have all of it: real ones, and processor time of all programs and of tcs.\n",
      dds.rounds, dds.rounds == 1 ? "" : "s", dds.processors, dds.processors == 1 ? "" : "s");
  return text;
}

std::string PhysicsTable(const PhysicsRows& physics) {
  static constexpr char kLine[] =
      "{:>6}{:>10}{:>13}{:>7}  {:<11}{:>7}{:>10}{:>7}  {:<13}{:>6}{:>9}\n";
  const auto two_digits = [](double ratio) { return fmt::format("{:.2f}", ratio); };
  const auto span = [](const Spread& spread) {
    return fmt::format("{:.2f}-{:.2f}", spread.lowest, spread.highest);
  };
  std::string text = fmt::format(kLine, "bodies", "bare µs", "changing µs", "ratio", "goal <= 5",
                                 "unlike", "same µs", "ratio", "goal <= 1.2", "steps", "saved µs");
  for (const PhysicsRow& row : physics.rows) {
    text += fmt::format(kLine, row.bodies, Brief(row.bare_us), Brief(row.changing_us),
                        two_digits(row.changing.median), span(row.changing),
                        two_digits(row.unlike.median), Brief(row.same_us),
                        two_digits(row.same.median), span(row.same),
                        two_digits(row.steps_per_sample), two_digits(row.checkpoint_us));
  }
  text += fmt::format(
      "Microseconds of processor time for each body and sample at 100 Hz, for {:g} virtual s; "
      "medians of {} round{}.\n"
      "Bare Simbody: one system that stops at each sample. Changing: each body has another "
      "command\n"
      "0.5 ms after each sample (unlike: the ratio where no two bodies have the same mass); same: "
      "it\n"
      "is the same again. Steps: of a body between two samples, with commands that change. Saved: "
      "a\n"
      "checkpoint, for each body.\n"
      "A sample of one body at 1 kHz that nothing changes for: {} µs (goal <= 50).\n",
      physics.virtual_s, physics.rounds, physics.rounds == 1 ? "" : "s",
      Brief(physics.sample_at_1khz_us));
  return text;
}

std::string DispatchTable(const DispatchRows& dispatches) {
  static constexpr char kLine[] = "{:>7}{:>9}{:>8}{:>7}  {:<11}{:>14}\n";
  std::string text =
      fmt::format(kLine, "clients", "bare µs", "tcs µs", "ratio", "", "coordinating");
  for (const DispatchRow& row : dispatches.rows) {
    text += fmt::format(kLine, row.clients, Brief(row.bare_us), Brief(row.tcs_us),
                        Brief(row.ratio.median),
                        fmt::format("{}-{}", Brief(row.ratio.lowest), Brief(row.ratio.highest)),
                        Brief(row.coordinating_us));
  }
  const double most = dispatches.rows.back().tcs_us / dispatches.rows.front().tcs_us;
  const double bare = dispatches.rows.back().bare_us / dispatches.rows.front().bare_us;
  text += fmt::format(
      "A dispatch of one of so many clients on a core, without what it computes, beside what the "
      "kernel\nneeds to have one of so many processes run and say so. From {} to {} clients {} "
      "times as much\n(the kernel alone: {}). Medians of {} round{}.\n",
      dispatches.rows.front().clients, dispatches.rows.back().clients, Brief(most), Brief(bare),
      dispatches.rounds, dispatches.rounds == 1 ? "" : "s");
  return text;
}

// How a line of a table goes on that says what runs cost, and the head of these columns.
constexpr char kCostColumns[] = "{:>13}  {:<11}{:>6}{:>9}{:>10}{:>7}{:>14}{:>12}\n";

std::string CostTitles() {
  return fmt::format(kCostColumns, "x real time", "", "goal", "real µs", "programs", "world",
                     "coordinating", "dispatches");
}

std::string CostCells(const CostsSpread& costs, double goal) {
  return fmt::format(kCostColumns, Brief(costs.speed.median),
                     fmt::format("{}-{}", Brief(costs.speed.lowest), Brief(costs.speed.highest)),
                     goal > 0 ? fmt::format(">= {:g}", goal) : "", Brief(costs.real_us),
                     Brief(costs.programs_us), Brief(costs.world_us), Brief(costs.coordinating_us),
                     Brief(costs.dispatches));
}

std::string FleetTable(const FleetRows& fleets) {
  static constexpr char kCase[] = "{:>6}{:>6}{:>9}";
  std::string text = fmt::format(kCase, "robots", "Hz", "answers") + CostTitles();
  for (const FleetRow& row : fleets.rows) {
    text +=
        fmt::format(kCase, row.fleet.robots, row.fleet.rate_hz, row.fleet.answers ? "yes" : "no") +
        CostCells(row.costs, row.fleet.goal);
  }
  text += fmt::format(
      "Robots with a body and a program each, which answers each sample by a command or sleeps, "
      "for "
      "{:g}\n"
      "virtual s on one processor; medians of {} round{}. Microseconds and dispatches for each "
      "sample; what\n"
      "is left of the real ones is switching between programs.\n",
      fleets.virtual_s, fleets.rounds, fleets.rounds == 1 ? "" : "s");
  return text;
}

std::string ZooTable(const std::vector<ZooRow>& rows) {
  static constexpr char kLine[] = "{:<18}{:>8}{:>10}{:>10}{:>12}\n";
  const auto cell = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.2g}", *value) : std::string("-");
  };
  std::string text = fmt::format(kLine, "zoo", "load ms", "Simbody", "MuJoCo", "from DART");
  for (const ZooRow& row : rows) {
    text += fmt::format(kLine, row.robot, cell(row.load_ms), cell(row.simbody), cell(row.mujoco),
                        cell(row.from_dart));
  }
  return text +
         "Robots in the style of those that people bring (tests/zoo). Engines: times real time on "
         "one\n"
         "processor, the slowest of 1 s free, held by servos and moved at random; -: it did not go "
         "well.\n"
         "From DART: rad or m, of the joint that is farthest off after 1 s of smooth motion; -: no "
         "DART, or\n"
         "it does not read the file.\n";
}

std::string RobotTables(const RobotRows& robots) {
  static constexpr char kModelLine[] = "{:<18}{:<9}{:>12}  {:<11}{:>7}{:>7}{:>8}  {}\n";
  std::string text =
      fmt::format(kModelLine, "physics", "engine", "x real time", "", "goal", "bare", "ratio", "");
  for (const ModelRow& row : robots.models) {
    text += fmt::format(kModelLine, row.robot, row.engine, Brief(row.speed.median),
                        fmt::format("{}-{}", Brief(row.speed.lowest), Brief(row.speed.highest)),
                        fmt::format(">= {:g}", row.goal), Brief(row.bare_speed),
                        Brief(row.ratio.median),
                        fmt::format("{}-{}", Brief(row.ratio.lowest), Brief(row.ratio.highest)));
  }
  static constexpr char kSwarm[] = "{:>6}{:>6}{:>6}";
  text += "\n" + fmt::format(kSwarm, "drones", "Hz", "CPUs") + CostTitles();
  for (const SwarmRow& row : robots.swarms) {
    text += fmt::format(kSwarm, row.swarm.drones, row.swarm.rate_hz, row.swarm.host_cpus) +
            CostCells(row.costs, row.swarm.goal);
  }
  text += fmt::format(
      "Physics: processor time of a robot that is read at that rate, and commanded 0.05 ms (the\n"
      "arm's six servos 0.5 ms) after each sample; bare: the engine alone, with the same model, "
      "stopped\n"
      "at the samples alone; ratio: of the times. Swarms: examples/quadrotor/swarm.py for {:g} "
      "virtual s, four\n"
      "programs a drone; microseconds and dispatches for each tick of a rate loop and all that\n"
      "belongs to it. Medians of {} round{}.\n",
      robots.virtual_s, robots.rounds, robots.rounds == 1 ? "" : "s");
  return text + "\n" + ZooTable(robots.zoo);
}

Json ToJson(const Spread& spread) {
  return {{"median", spread.median}, {"lowest", spread.lowest}, {"highest", spread.highest}};
}

Json ToJson(const std::vector<LoadRow>& rows) {
  Json json = Json::object();
  for (const LoadRow& row : rows) {
    Json& to = json[row.title];
    to["idle"] = row.idle;
    for (std::size_t load = 0; load < kSpinnerCounts.size(); ++load) {
      to["beside_spinners"][std::to_string(kSpinnerCounts[load])] = ToJson(row.relative[load]);
    }
  }
  return json;
}

Json ToJson(const std::vector<DdsRow>& rows) {
  Json json = Json::array();
  for (const DdsRow& row : rows) {
    Json& to = json.emplace_back(Json{{"size", row.size}, {"what", row.what}, {"unit", row.unit}});
    for (std::size_t i = 0; i < kCarrierNames.size(); ++i) to[kCarrierNames[i]] = row.value[i];
    to["ratio"] = ToJson(row.ratio);
  }
  return json;
}

// A row that says which runs these were, and what they cost.
Json WithCosts(Json row, const CostsSpread& costs) {
  row["times_real_time"] = ToJson(costs.speed);
  row["real_us"] = costs.real_us;
  row["programs_us"] = costs.programs_us;
  row["world_us"] = costs.world_us;
  row["coordinating_us"] = costs.coordinating_us;
  row["dispatches"] = costs.dispatches;
  return row;
}

}  // namespace

std::string ToTables(const Results& results) {
  std::vector<std::string> tables;
  if (!results.calls.empty()) tables.push_back(CallTable(results.calls));
  if (!results.work.empty()) {
    tables.push_back(LoadTable("fixed work, own clock", "s", "0.97 to 1.03", results.work));
  }
  if (!results.planning.empty()) {
    tables.push_back(
        LoadTable("explored by solve(1.0)", "states", "0.95 to 1.05", results.planning));
  }
  if (!tables.empty()) {
    tables.push_back(fmt::format("Medians of {} round{}, on one processor.\n", results.rounds,
                                 results.rounds == 1 ? "" : "s"));
  }
  if (results.dds.has_value()) tables.push_back(DdsTable(*results.dds));
  if (results.physics.has_value()) tables.push_back(PhysicsTable(*results.physics));
  if (results.dispatches.has_value()) tables.push_back(DispatchTable(*results.dispatches));
  if (results.fleets.has_value()) tables.push_back(FleetTable(*results.fleets));
  if (results.robots.has_value()) tables.push_back(RobotTables(*results.robots));
  return fmt::format("{}", fmt::join(tables, "\n"));
}

std::string ToJson(const Results& results) {
  Json json{{"rounds", results.rounds}};
  for (const CallRow& row : results.calls) {
    json["calls"][row.benchmark.name] = {{"ns", row.ns},
                                         {"reference", row.benchmark.reference_title},
                                         {"reference_ns", row.reference_ns},
                                         {"ratio", ToJson(row.ratio)},
                                         {"goal", row.benchmark.goal}};
  }
  if (!results.work.empty()) json["work_seconds"] = ToJson(results.work);
  if (!results.planning.empty()) json["explored_states"] = ToJson(results.planning);
  if (const auto& dds = results.dds; dds.has_value()) {
    json["dds"] = {{"rounds", dds->rounds},
                   {"native_processors", dds->processors},
                   {"own_clocks", ToJson(dds->own_clocks)},
                   {"real_seconds_per_100000", ToJson(dds->real_s)},
                   {"cpu_seconds_per_100000", ToJson(dds->cpu_s)}};
  }
  if (const auto& physics = results.physics; physics.has_value()) {
    Json& to = json["physics"];
    to = {{"rounds", physics->rounds},
          {"virtual_seconds", physics->virtual_s},
          {"sample_at_1khz_us", physics->sample_at_1khz_us},
          {"rows", Json::array()}};
    for (const PhysicsRow& row : physics->rows) {
      to["rows"].push_back({{"bodies", row.bodies},
                            {"bare_us", row.bare_us},
                            {"changing_us", row.changing_us},
                            {"same_us", row.same_us},
                            {"changing_ratio", ToJson(row.changing)},
                            {"unlike_ratio", ToJson(row.unlike)},
                            {"same_ratio", ToJson(row.same)},
                            {"checkpoint_us", row.checkpoint_us},
                            {"steps_per_sample", row.steps_per_sample}});
    }
  }
  if (const auto& dispatches = results.dispatches; dispatches.has_value()) {
    Json& to = json["dispatches"];
    to = {{"rounds", dispatches->rounds}, {"rows", Json::array()}};
    for (const DispatchRow& row : dispatches->rows) {
      to["rows"].push_back({{"clients", row.clients},
                            {"bare_us", row.bare_us},
                            {"tcs_us", row.tcs_us},
                            {"ratio", ToJson(row.ratio)},
                            {"coordinating_us", row.coordinating_us}});
    }
  }
  if (const auto& fleets = results.fleets; fleets.has_value()) {
    Json& to = json["fleets"];
    to = {{"rounds", fleets->rounds},
          {"virtual_seconds", fleets->virtual_s},
          {"rows", Json::array()}};
    for (const FleetRow& row : fleets->rows) {
      to["rows"].push_back(WithCosts({{"robots", row.fleet.robots},
                                      {"rate_hz", row.fleet.rate_hz},
                                      {"answers", row.fleet.answers}},
                                     row.costs));
    }
  }
  if (const auto& robots = results.robots; robots.has_value()) {
    Json& to = json["robots"];
    to = {{"rounds", robots->rounds},
          {"virtual_seconds", robots->virtual_s},
          {"models", Json::array()},
          {"swarms", Json::array()},
          {"zoo", Json::array()}};
    const auto or_null = [](const std::optional<double>& value) {
      return value ? Json(*value) : Json();
    };
    for (const ZooRow& row : robots->zoo) {
      to["zoo"].push_back({{"robot", row.robot},
                           {"load_ms", row.load_ms},
                           {"simbody_times_real_time", or_null(row.simbody)},
                           {"mujoco_times_real_time", or_null(row.mujoco)},
                           {"from_dart", or_null(row.from_dart)}});
    }
    for (const ModelRow& row : robots->models) {
      to["models"].push_back({{"robot", row.robot},
                              {"engine", row.engine},
                              {"times_real_time", ToJson(row.speed)},
                              {"bare_times_real_time", row.bare_speed},
                              {"ratio", ToJson(row.ratio)},
                              {"goal", row.goal}});
    }
    for (const SwarmRow& row : robots->swarms) {
      to["swarms"].push_back(WithCosts({{"drones", row.swarm.drones},
                                        {"rate_hz", row.swarm.rate_hz},
                                        {"host_cpus", row.swarm.host_cpus}},
                                       row.costs));
    }
  }
  return json.dump(2) + "\n";
}

}  // namespace tcs::bench
