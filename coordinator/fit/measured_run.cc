#include "coordinator/fit/measured_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "coordinator/report/text.h"
#include "coordinator/scenario/name.h"
#include "coordinator/text/csv.h"

namespace tcs::fit {

namespace {

using Json = nlohmann::json;

// More than any run has by far, and so little that sums of such values are numbers yet.
constexpr double kMost = 1e18;

std::optional<double> ToCount(std::string_view text) {
  const std::optional<std::int64_t> value = ToInteger(text);
  if (!value || *value < 0 || static_cast<double>(*value) > kMost) return {};
  return static_cast<double>(*value);
}

double CountIn(const Json& json, const char* key) {
  const double value = json.at(key).get<double>();
  return value >= 0 && value <= kMost ? std::floor(value) : 0;
}

// ROBOT/CLIENT, as scenarios have them.
bool IsClient(std::string_view name) {
  const std::size_t slash = name.find('/');
  return slash != std::string_view::npos && IsName(name.substr(0, slash)) &&
         IsName(name.substr(slash + 1));
}

LoadError NotCounted(const std::string& folder) {
  return LoadError{fmt::format(
      "{} has no counts of calls and allocations; make the run again with --for-fit", folder)};
}

LoadResult<MeasuredRun> FromSummary(const std::string& folder) {
  const std::string path = folder + "/summary.json";
  const std::optional<std::string> text = ReadFile(path);
  if (!text) {
    return LoadError{fmt::format(
        "{} has no summary.json: give the folder of a run that has ended, one made by `tcsim run "
        "SCENARIO --for-fit --out {}`",
        folder, folder)};
  }
  MeasuredRun run;
  run.folder = folder;
  try {
    const Json json = Json::parse(*text);
    if (json.value("accounting", "") == "fixed") {
      return LoadError{fmt::format(
          "{} is of a run with --accounting fixed, whose charges were set, not measured; make one "
          "without, with --for-fit",
          folder)};
    }
    json.at("scenario").get_to(run.scenario);
    for (const auto& [name, entry] : json.at("clients").items()) {
      if (!entry.contains("calls") || !entry.contains("allocations")) return NotCounted(folder);
      if (!IsClient(name)) return LoadError{path + " is damaged; make the run again"};
      MeasuredClient& client = run.clients[name];
      client.whole = {std::max(0.0, CountIn(entry, "charged_ns") - CountIn(entry, "priced_ns")),
                      CountIn(entry, "calls"), CountIn(entry, "allocations")};
      client.speed = json.at("robots").at(entry.at("robot").get<std::string>()).at("speed");
    }
  } catch (const Json::exception&) {
    return LoadError{path + " is damaged; make the run again"};
  }
  return run;
}

}  // namespace

LoadResult<MeasuredRun> ReadMeasuredRun(const std::string& folder) {
  LoadResult<MeasuredRun> result = FromSummary(folder);
  MeasuredRun* run = std::get_if<MeasuredRun>(&result);
  if (run == nullptr) return result;
  const std::string path = folder + "/activations.csv";
  const auto take = [run](const CsvFields& fields) {
    const auto client = run->clients.find(std::string(fields[0]));
    const auto charged = ToCount(fields[1]), calls = ToCount(fields[2]),
               allocations = ToCount(fields[3]), priced = ToCount(fields[4]);
    if (client == run->clients.end() || !charged || !calls || !allocations || !priced) return false;
    client->second.activations.push_back({std::max(0.0, *charged - *priced), *calls, *allocations});
    return true;
  };
  const auto read =
      ReadCsv(path, {"client", "charged_ns", "calls", "allocations", "priced_ns"}, take);
  if (const auto* error = std::get_if<LoadError>(&read)) return *error;
  if (const auto unusable = std::get<std::int64_t>(read); unusable > 0) {
    run->warnings.push_back(fmt::format("{} has {} that cannot be used; left out", path,
                                        report::Count(unusable, "line")));
  }
  return result;
}

}  // namespace tcs::fit
