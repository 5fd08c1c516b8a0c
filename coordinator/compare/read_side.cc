#include "coordinator/compare/read_side.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "coordinator/report/read_run.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/text.h"
#include "coordinator/text/csv.h"
#include "coordinator/trials/outcome.h"
#include "coordinator/trials/record.h"

namespace tcs::compare {

namespace {

using SideJson = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kParts = 20, kFewestInPart = 5;
constexpr const char* kFailedFigure = "run.failed";

// How a run ended, as its summary says.
enum class Ending { kWhole, kFailed, kInterrupted, kNone };

Ending EndingOf(const SideJson& summary) {
  if (summary.at("interrupted").get<bool>()) return Ending::kInterrupted;
  for (const auto& client : summary.value("clients", SideJson::object())) {
    if (client.value("ended_at_ns", std::int64_t{-1}) >= 0 && client.value("wait_status", 0) != 0) {
      return Ending::kFailed;
    }
  }
  return Ending::kWhole;
}

void TakeFacts(const SideJson& summary, Side* side) {
  if (!side->scenario.empty()) return;
  side->scenario = summary.value("scenario", "");
  side->accounting = summary.value("accounting", "");
  side->sync = summary.value("sync", "");
  side->duration_ns = summary.value("virtual_ns", std::int64_t{0});
}

void AddValue(const std::string& name, const Measure& kind, std::uint64_t seed, Cell* cell) {
  Sample& sample = cell->samples[name];
  sample.kind = kind;
  sample.values.push_back(kind.value);
  sample.seeds.push_back(seed);
}

// Takes a summary's figures into the cell.
Ending TakeSummary(const std::string& text, Side* side, Cell* cell) {
  try {
    const SideJson summary = SideJson::parse(text);
    const auto seed = summary.at("seed").get<std::uint64_t>();
    const Ending ending = EndingOf(summary);
    if (ending == Ending::kInterrupted) return ending;
    const bool has_failed = ending == Ending::kFailed;
    ++(has_failed ? cell->failed : cell->trials);
    TakeFacts(summary, side);
    AddValue(kFailedFigure, {has_failed ? 1.0 : 0.0, MeasureUnit::kShare, WorseWhen::kMore, true},
             seed, cell);
    if (has_failed && !side->is_run) return ending;  // the other figures are of a part of the run
    for (const auto& [name, measure] : MeasuresFromSummary(text).value_or(Measures())) {
      AddValue(name, measure, seed, cell);
    }
    return ending;
  } catch (const SideJson::exception&) {
    return Ending::kNone;
  }
}

// Takes how the run varied within itself into the cell.
void TakeParts(const std::string& folder, Cell* cell) {
  if (!IsFile(folder + "/activations.csv")) return;
  std::vector<std::string> ignored;
  const auto read = report::ReadRunTimes(folder, &ignored);
  const auto* run = std::get_if<report::Run>(&read);
  if (run == nullptr) return;
  for (const auto& [name, client] : run->clients) {
    const std::vector<double>& response = client.times.response_s;
    cell->parts[name + ".response_p50"] = PartMedians(response, kParts);
    cell->parts[name + ".execution_p50"] = PartMedians(client.times.computed_s, kParts);
    const auto deadline = cell->samples.find(name + ".deadline");
    if (deadline == cell->samples.end() || response.size() < kParts * kFewestInPart) continue;
    std::vector<double>& shares = cell->parts[name + ".missed"];
    for (std::size_t i = 0; i < kParts; ++i) {
      const auto from =
          response.begin() + static_cast<std::ptrdiff_t>(i * response.size() / kParts);
      const auto to =
          response.begin() + static_cast<std::ptrdiff_t>((i + 1) * response.size() / kParts);
      const auto missed = std::count_if(
          from, to, [&](double time) { return time > deadline->second.values.front(); });
      shares.push_back(static_cast<double>(missed) / static_cast<double>(to - from));
    }
  }
}

LoadResult<Side> ReadOneRun(const std::string& folder) {
  Side side;
  side.folder = folder;
  side.is_run = true;
  Cell& cell = side.cells[""];
  switch (TakeSummary(ReadText(folder + "/summary.json"), &side, &cell)) {
    case Ending::kInterrupted:
      return LoadError{folder +
                       " was interrupted: its figures are of a part of the run; make it again"};
    case Ending::kNone:
      return LoadError{folder + "/summary.json is damaged; make the run again"};
    case Ending::kFailed:
      side.warnings.push_back("in " + folder +
                              " a client failed; its figures are what they were then");
      break;
    case Ending::kWhole:
      break;
  }
  TakeParts(folder, &cell);
  return side;
}

// "drift=1ms speed=0.5", whatever the order of the keys was.
std::string LabelOf(const TrialsPlan& plan, std::size_t group) {
  std::vector<std::string> texts = ValuesOf(plan, group);
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i] = plan.vary[i].key + "=" + texts[i];
  std::sort(texts.begin(), texts.end());
  return fmt::format("{}", fmt::join(texts, " "));
}

// More than anybody can have made are a damaged number.
bool IsPlausible(const TrialsPlan& plan) {
  constexpr std::size_t kMost = 10'000'000;
  if (plan.trials < 1) return false;
  auto all = static_cast<std::size_t>(plan.trials);
  for (const Vary& vary : plan.vary) {
    if (all > kMost || vary.values.size() > kMost) return false;
    all *= vary.values.size();
  }
  return all <= kMost;
}

LoadResult<Side> ReadTrials(const std::string& folder) {
  auto read = RecordFromJson(ReadText(folder + "/trials.json"));
  if (std::holds_alternative<std::string>(read) ||
      !IsPlausible(std::get<TrialsRecord>(read).plan)) {
    return LoadError{folder + "/trials.json is damaged; make the trials again"};
  }
  const TrialsPlan& plan = std::get<TrialsRecord>(read).plan;
  Side side;
  side.folder = folder;
  for (const Vary& vary : plan.vary) side.keys.push_back(vary.key);
  std::sort(side.keys.begin(), side.keys.end());
  std::size_t missing = 0, all = 0;
  for (const Trial& trial : TrialsOf(plan)) {
    Cell& cell = side.cells[plan.vary.empty() ? "" : LabelOf(plan, trial.group)];
    const Ending ending =
        TakeSummary(ReadText(folder + "/" + trial.folder + "/summary.json"), &side, &cell);
    ++all;
    if (ending == Ending::kNone || ending == Ending::kInterrupted) ++missing;
  }
  std::erase_if(side.cells, [](const auto& cell) { return cell.second.samples.empty(); });
  if (side.cells.empty()) {
    return LoadError{folder + " has no trial that went to its end; call tcsim trials again"};
  }
  if (missing > 0) {
    side.warnings.push_back(
        fmt::format("{} of {} of {} did not go to their end, and are left out", missing,
                    report::Count(static_cast<std::int64_t>(all), "trial"), folder));
  }
  return side;
}

}  // namespace

std::vector<double> PartMedians(const std::vector<double>& values, std::size_t parts) {
  std::vector<double> medians;
  if (values.size() < parts * kFewestInPart) return medians;
  for (std::size_t i = 0; i < parts; ++i) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(i * values.size() / parts);
    const auto to = values.begin() + static_cast<std::ptrdiff_t>((i + 1) * values.size() / parts);
    medians.push_back(report::SpreadOf({from, to}).median);
  }
  return medians;
}

LoadResult<Side> ReadSide(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return LoadError{fmt::format(
        "there is no folder '{}'; give one that tcsim run or tcsim trials wrote", folder)};
  }
  if (fs::exists(folder + "/trials.json", error)) return ReadTrials(folder);
  if (fs::exists(folder + "/summary.json", error)) return ReadOneRun(folder);
  if (fs::exists(folder + "/trace.json", error)) {
    return LoadError{folder + " has no summary.json: the run did not end; make it again"};
  }
  return LoadError{
      fmt::format("'{}' is no result folder: it has neither summary.json nor trials.json; give one "
                  "that tcsim run or tcsim trials wrote",
                  folder)};
}

}  // namespace tcs::compare
