#include "coordinator/trials/results.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "coordinator/os/files.h"
#include "coordinator/trials/outcome.h"

namespace tcs {

namespace {

using ResultJson = nlohmann::ordered_json;

ResultJson LineOf(const TrialsPlan& plan, const TrialResult& result) {
  ResultJson line{{"seed", result.trial.seed}, {"folder", result.trial.folder}};
  if (!plan.vary.empty()) line["values"] = ValuesOf(plan, result.trial.group);
  line["measures"] = ResultJson::object();
  for (const auto& [name, measure] : result.measures) {
    // Counts are written as whole numbers.
    if (measure.unit == MeasureUnit::kCount && std::abs(measure.value) < 1e15) {
      line["measures"][name] = static_cast<std::int64_t>(measure.value);
    } else {
      line["measures"][name] = measure.value;
    }
  }
  return line;
}

}  // namespace

std::string WithResults(const std::string& record, const TrialsPlan& plan,
                        const std::vector<TrialResult>& results) {
  ResultJson json = ResultJson::parse(record, nullptr, false);
  if (!json.is_object()) return record;
  json.erase("results");
  std::string text = json.dump(2, ' ', false, ResultJson::error_handler_t::replace);
  text.resize(text.rfind('\n'));  // the last brace comes after the results
  text += ",\n  \"results\": [";
  for (std::size_t i = 0; i < results.size(); ++i) {
    text += i == 0 ? "\n    " : ",\n    ";
    text += LineOf(plan, results[i]).dump(-1, ' ', false, ResultJson::error_handler_t::replace);
  }
  return text + (results.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

std::string WriteResults(const std::string& folder, const TrialsPlan& plan) {
  std::vector<TrialResult> results;
  for (const Trial& trial : TrialsOf(plan)) {
    const std::string text = ReadText(folder + "/" + trial.folder + "/summary.json");
    if (!OutcomeFromJson(text, trial.seed).has_value()) continue;
    if (auto measures = MeasuresFromSummary(text)) results.push_back({trial, *measures});
  }
  const std::string path = folder + "/trials.json";
  return WriteWhole(path, WithResults(ReadText(path), plan, results));
}

}  // namespace tcs
