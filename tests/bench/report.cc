#include "tests/bench/report.h"

#include <fmt/format.h>

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

std::string WorkTable(const std::vector<WorkRow>& rows) {
  std::string text = fmt::format("{:<24}{:>9}", "fixed work, own clock", "idle");
  for (std::size_t load = 1; load < kSpinnerCounts.size(); ++load) {
    text += fmt::format("   {:<22}", fmt::format("beside {} spinners", kSpinnerCounts[load]));
  }
  text += "goal\n";
  for (const WorkRow& row : rows) {
    text += fmt::format("{:<24}{:>7.3f} s", row.title, row.idle_seconds);
    // Beside no spinners it is the idle value itself.
    for (std::size_t load = 1; load < kSpinnerCounts.size(); ++load) {
      const Spread& relative = row.relative[load];
      text += fmt::format("   {:<22}", fmt::format("{:.3f} ({:.3f}-{:.3f})", relative.median,
                                                   relative.lowest, relative.highest));
    }
    text += row.world == World::kTcs ? "0.97 to 1.03\n" : "\n";
  }
  return text;
}

Json ToJson(const Spread& spread) {
  return {{"median", spread.median}, {"lowest", spread.lowest}, {"highest", spread.highest}};
}

}  // namespace

std::string ToTables(const Results& results) {
  std::string text;
  if (results.calls.empty() && results.work.empty()) return text;
  if (!results.calls.empty()) text += CallTable(results.calls);
  if (!results.calls.empty() && !results.work.empty()) text += "\n";
  if (!results.work.empty()) text += WorkTable(results.work);
  return text + fmt::format("\nMedians of {} round{}, on one processor.\n", results.rounds,
                            results.rounds == 1 ? "" : "s");
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
