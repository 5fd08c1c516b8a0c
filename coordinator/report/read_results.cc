#include "coordinator/report/read_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "coordinator/report/read_run.h"
#include "coordinator/report/text.h"
#include "coordinator/scenario/duration.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

namespace {

using UnorderedJson = nlohmann::json;
namespace fs = std::filesystem;

// The plan that trials.json has.
struct Plan {
  std::string name;
  std::int64_t first_seed = 1, trials = 0;
  struct Key {
    std::string name;
    std::vector<std::string> values;
  };
  std::vector<Key> keys;  // none: no sweep; several: a grid
};

// Throws nothing, whatever stands in the way.
bool IsThere(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string TextOf(const UnorderedJson& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// Throws where `vary` has no such key.
Plan::Key KeyOf(const UnorderedJson& vary) {
  Plan::Key key{vary.at("key").get<std::string>(), {}};
  for (const UnorderedJson& value : vary.at("values")) key.values.push_back(TextOf(value));
  return key;
}

// All combinations of the keys' values, the last key's value changing first; empty if there are too
// many combinations to be meant.
std::vector<std::vector<std::string>> CombinationsOf(const std::vector<Plan::Key>& keys) {
  constexpr std::size_t kMost = 100'000;
  std::vector<std::vector<std::string>> all(1);
  for (const Plan::Key& key : keys) {
    if (all.size() * key.values.size() > kMost) return {};
    std::vector<std::vector<std::string>> longer;
    for (const std::vector<std::string>& before : all) {
      for (const std::string& value : key.values) {
        longer.push_back(before);
        longer.back().push_back(value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

LoadResult<Plan> ReadPlan(const std::string& folder) {
  const std::string path = folder + "/trials.json";
  const std::optional<std::string> text = ReadFile(path);
  if (!text) return LoadError{path + " cannot be read"};
  try {
    const UnorderedJson json = UnorderedJson::parse(*text);
    Plan plan;
    plan.name = json.value("name", "");
    json.at("first_seed").get_to(plan.first_seed);
    json.at("trials").get_to(plan.trials);
    const UnorderedJson vary = json.value("vary", UnorderedJson());
    if (vary.is_object()) plan.keys.push_back(KeyOf(vary));
    if (vary.is_array()) {
      for (const UnorderedJson& one : vary) plan.keys.push_back(KeyOf(one));
    }
    return plan;
  } catch (const UnorderedJson::exception&) {
    return LoadError{path + " is damaged; make the trials again"};
  }
}

std::string FolderName(const std::string& folder) {
  fs::path path = fs::path(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = path.filename().string();
  if (!name.empty() && name != "." && name != "..") return name;
  std::error_code error;
  return fs::weakly_canonical(folder, error).filename().string();
}

// The folder of a value, as tcsim trials calls it.
std::string FolderOf(std::string value) {
  std::replace(value.begin(), value.end(), '/', '_');
  if (value.starts_with('.')) value[0] = '_';
  return value;
}

// The last sentence of tcsim about a trial that has no summary.
std::string LastWords(const std::string& folder) {
  const std::optional<std::string> log = ReadFile(folder + "/tcsim.log");
  if (!log) return IsThere(folder) ? "it did not end" : "it was not made";
  std::string last;
  for (std::size_t from = 0; from < log->size();) {
    const std::size_t end = std::min(log->find('\n', from), log->size());
    const std::string line = log->substr(from, end - from);
    if (line.starts_with("tcsim: ") && !line.starts_with("tcsim: warning")) last = line.substr(7);
    from = end + 1;
  }
  return last.empty() ? "it did not end" : last;
}

std::optional<double> NumberOf(const std::string& value) {
  if (const auto number = ToReal(value)) return number;
  const auto duration = ParseDuration(value);
  if (const auto* parsed = std::get_if<VirtualDuration>(&duration)) return parsed->seconds();
  return {};
}

class ResultsReader {
 public:
  ResultsReader(const std::vector<std::string>& bodies, Distance distance)
      : bodies_(bodies), distance_(distance) {}

  // Adds the folder. Returns one sentence, or an empty text.
  std::string Add(const std::string& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
      return fmt::format("there is no folder '{}'; give one that tcsim run or tcsim trials wrote",
                         folder);
    }
    if (IsThere(folder + "/trials.json")) return AddTrials(folder);
    if (IsThere(folder + "/summary.json") || IsThere(folder + "/trace.json") ||
        IsThere(folder + "/unfinished.json") || IsThere(folder + "/dispatches.csv")) {
      System system{FolderName(folder), {}, {}};
      std::string mistake = AddRun(folder, FolderName(folder), Ends::kAny, &system);
      if (mistake.empty()) Keep(folder, std::move(system));
      return mistake;
    }
    return fmt::format(
        "'{}' is no result folder: it has neither summary.json nor trials.json; give one that "
        "tcsim run or tcsim trials wrote",
        folder);
  }

  Results Take() {
    MakeNamesDiffer();
    return std::move(results_);
  }

 private:
  std::string AddTrials(const std::string& folder) {
    const auto read = ReadPlan(folder);
    if (const auto* error = std::get_if<LoadError>(&read)) {
      results_.warnings.push_back(error->message + "; it is left out");
      return {};
    }
    const Plan& plan = std::get<Plan>(read);
    const std::string name = plan.name.empty() ? FolderName(folder) : plan.name;
    if (plan.keys.size() > 1) return AddGrid(folder, name, plan);
    if (plan.keys.empty()) {
      System system{name, {}, {}};
      std::string error = AddSeeds(folder, plan, &system);
      if (error.empty()) Keep(folder, std::move(system));
      return error;
    }
    Sweep sweep{name, plan.keys[0].name, {}};
    for (const std::string& value : plan.keys[0].values) {
      SweepValue point{value, NumberOf(value), {name + " at " + value, {}, {}}};
      if (std::string error = AddSeeds(folder + "/" + FolderOf(value), plan, &point.system);
          !error.empty()) {
        return error;
      }
      if (point.system.runs.empty()) {
        results_.warnings.push_back(
            fmt::format("{}/{} has no trial that went to its end{}; it is "
                        "left out",
                        folder, value, WhyOf(point.system)));
      } else {
        sweep.values.push_back(std::move(point));
      }
    }
    if (!sweep.values.empty()) results_.sweeps.push_back(std::move(sweep));
    return {};
  }

  std::string AddGrid(const std::string& folder, const std::string& name, const Plan& plan) {
    Grid grid{name, {}, {}};
    for (const Plan::Key& key : plan.keys) grid.keys.push_back(key.name);
    std::vector<std::string> empty;
    for (std::vector<std::string>& values : CombinationsOf(plan.keys)) {
      std::string place, label;
      for (const std::string& value : values) {
        place += (place.empty() ? "" : ",") + FolderOf(value);
        label += (label.empty() ? "" : ", ") + value;
      }
      GridCell cell{std::move(values), {name + " at " + label, {}, {}}};
      reads_figures_only_ = true;
      std::string error = AddSeeds(folder + "/" + place, plan, &cell.system);
      reads_figures_only_ = false;
      if (!error.empty()) return error;
      if (cell.system.runs.empty()) empty.push_back(label);
      grid.cells.push_back(std::move(cell));
    }
    const bool has_runs = empty.size() < grid.cells.size();
    if (!empty.empty()) {
      results_.warnings.push_back(fmt::format(
          "{} has no trial that went to its end at {} of {} combinations of values, such as {}",
          folder, empty.size(), grid.cells.size(), empty.front()));
    }
    if (has_runs) results_.grids.push_back(std::move(grid));
    return {};
  }

  std::string AddSeeds(const std::string& folder, const Plan& plan, System* system) {
    for (std::int64_t i = 0; i < std::min<std::int64_t>(plan.trials, 100'000); ++i) {
      const std::string name = fmt::format("seed-{:04}", plan.first_seed + i);
      if (std::string error = AddRun(folder + "/" + name, name, Ends::kWhole, system);
          !error.empty()) {
        return error;
      }
    }
    return {};
  }

  std::string AddRun(const std::string& folder, const std::string& name, Ends ends,
                     System* system) {
    const bool has_part = ends == Ends::kAny && (IsThere(folder + "/unfinished.json") ||
                                                 IsThere(folder + "/dispatches.csv"));
    if (!IsThere(folder + "/summary.json") && !has_part) {
      system->failed.push_back({name, LastWords(folder)});
      return {};
    }
    auto read = reads_figures_only_ ? ReadRunFigures(folder, &results_.warnings)
                                    : ReadRun(folder, bodies_, ends, &results_.warnings, distance_);
    if (const auto* error = std::get_if<LoadError>(&read)) {
      // A wrong name is the caller's mistake, not the run's.
      if (error->message.starts_with("there is no body")) return error->message;
      const std::string place = folder + ": ";
      const bool has_place = error->message.starts_with(place);
      system->failed.push_back({name, error->message.substr(has_place ? place.size() : 0)});
      return {};
    }
    Run& run = std::get<Run>(read);
    if (results_.scenario.empty()) {
      results_.scenario = run.scenario;
      first_folder_ = folder;
    }
    // Without a summary nobody knows the scenario.
    if (run.has_summary && run.scenario != results_.scenario) {
      return fmt::format(
          "{} is of scenario '{}', but {} is of '{}'; a report compares runs of one scenario: make "
          "one for each",
          folder, run.scenario, first_folder_, results_.scenario);
    }
    if (results_.bodies[0].empty()) std::copy_n(run.apart, 2, results_.bodies);
    system->runs.push_back(std::move(run));
    return {};
  }

  static std::string WhyOf(const System& system) {
    if (system.failed.empty()) return {};
    return fmt::format(" ({}: {})", system.failed.front().name, system.failed.front().why);
  }

  void Keep(const std::string& folder, System system) {
    if (!system.runs.empty()) {
      results_.systems.push_back(std::move(system));
      return;
    }
    results_.warnings.push_back(
        fmt::format("{} has no run that went to its end{}; it is left out", folder, WhyOf(system)));
  }

  void MakeNamesDiffer() {
    for (std::size_t i = 0; i < results_.systems.size(); ++i) {
      int same = 1;
      for (std::size_t before = 0; before < i; ++before) {
        same += results_.systems[before].name == results_.systems[i].name;
      }
      if (same > 1) results_.systems[i].name += fmt::format(" ({})", same);
    }
  }

  const std::vector<std::string> bodies_;
  const Distance distance_;
  bool reads_figures_only_ = false;  // of a grid, whose tables would be too many
  Results results_;
  std::string first_folder_;
};

}  // namespace

std::string InSystem(const Results& results, const System& system) {
  return results.systems.size() > 1 ? " in " + Quoted(system.name) : "";
}

std::vector<double> Distances(const System& system) {
  std::vector<double> all;
  for (const Run& run : system.runs) {
    all.insert(all.end(), run.track.distance_m.begin(), run.track.distance_m.end());
  }
  return all;
}

std::vector<std::string> Failures(const System& system) {
  constexpr std::size_t kMostNames = 5;
  std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
  for (const FailedRun& run : system.failed) {
    const auto known = std::find_if(reasons.begin(), reasons.end(),
                                    [&](const auto& reason) { return reason.first == run.why; });
    if (known == reasons.end()) {
      reasons.push_back({run.why, {run.name}});
    } else {
      known->second.push_back(run.name);
    }
  }
  std::vector<std::string> sentences;
  for (auto& [why, names] : reasons) {
    if (const std::size_t all = names.size(); all > kMostNames) {
      names.resize(kMostNames - 1);
      names.push_back(fmt::format("{} more", all - names.size()));
    }
    sentences.push_back(fmt::format("{}, {}: {}", system.name, Listed(names), why));
  }
  return sentences;
}

LoadResult<Results> ReadResults(const std::vector<std::string>& folders,
                                const std::vector<std::string>& bodies, Distance distance) {
  ResultsReader reader(bodies, distance);
  for (const std::string& folder : folders) {
    if (std::string error = reader.Add(folder); !error.empty()) return LoadError{error};
  }
  Results results = reader.Take();
  if (results.systems.empty() && results.sweeps.empty() && results.grids.empty()) {
    return LoadError{results.warnings.empty() ? "there is nothing to report"
                                              : results.warnings.front()};
  }
  return results;
}

}  // namespace tcs::report
