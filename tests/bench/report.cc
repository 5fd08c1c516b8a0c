#include "tests/bench/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace tcs::bench {

namespace {

using Json = nlohmann::ordered_json;

std::string CallTable(const std::vector<CallRow>& rows) {
  std::string text =
      fmt::format("{:<26}{:>10}   {:<34}{:>10}{:>8}  {:<14}{}\n", "under tcs", "ns a call",
                  "reference", "ns a call", "ratio", "  (lowest-highest)", "  goal");
  for (const CallRow& row : rows) {
    text += fmt::format(
        "{:<26}{:>10.1f}   {:<34}{:>10.1f}{:>8.2f}  {:<20}{}\n", row.benchmark.title, row.ns,
        row.benchmark.reference_title, row.reference_ns, row.ratio.median,
        fmt::format("({:.2f}-{:.2f})", row.ratio.lowest, row.ratio.highest), row.benchmark.goal);
  }
  return text;
}

std::string WorkTable(const std::vector<WorkRow>& rows) {
  std::string text = fmt::format("{:<26}{:>10}", "fixed work, own clock", "idle");
  for (const int count : kSpinnerCounts)
    text += fmt::format("   {:<24}", fmt::format("beside {} spinners", count));
  text += "\n";
  for (const WorkRow& row : rows) {
    text += fmt::format("{:<26}{:>8.3f} s", row.title, row.idle_seconds);
    for (const Spread& relative : row.relative) {
      text += fmt::format("   {:<24}", fmt::format("{:.3f} ({:.3f}-{:.3f})", relative.median,
                                                   relative.lowest, relative.highest));
    }
    text += "\n";
  }
  return text + "  goal under tcs: 0.97 to 1.03 beside any number of spinners\n";
}

Json ToJson(const Spread& spread) {
  return {{"median", spread.median}, {"lowest", spread.lowest}, {"highest", spread.highest}};
}

}  // namespace

std::string ToTables(const Results& results) {
  std::string text;
  if (!results.calls.empty()) text += CallTable(results.calls);
  if (!results.calls.empty() && !results.work.empty()) text += "\n";
  if (!results.work.empty()) text += WorkTable(results.work);
  return text + fmt::format("\nMedians of {} rounds, on one processor.\n", results.rounds);
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
  for (const WorkRow& row : results.work) {
    Json& to = json["work"][row.title];
    to["idle_seconds"] = row.idle_seconds;
    for (std::size_t load = 0; load < kSpinnerCounts.size(); ++load) {
      to["beside_spinners"][std::to_string(kSpinnerCounts[load])] = ToJson(row.relative[load]);
    }
  }
  return json.dump(2) + "\n";
}

}  // namespace tcs::bench
