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
  if (tables.empty()) return {};
  return fmt::format("{}\nMedians of {} round{}, on one processor.\n", fmt::join(tables, "\n"),
                     results.rounds, results.rounds == 1 ? "" : "s");
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
  return json.dump(2) + "\n";
}

}  // namespace tcs::bench
