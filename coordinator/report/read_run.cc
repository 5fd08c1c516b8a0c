#include "coordinator/report/read_run.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "coordinator/explain/told.h"
#include "coordinator/report/read_answers.h"
#include "coordinator/report/text.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

namespace {

using UnorderedJson = nlohmann::json;

// Why the run is no good: one of its clients failed; none if it is good.
std::optional<std::string> FailureOf(const UnorderedJson& clients) {
  for (const auto& [name, client] : clients.items()) {
    const auto status = client.at("wait_status").get<int>();
    const auto ended_ns = client.at("ended_at_ns").get<std::int64_t>();
    if (ended_ns < 0 || status == 0) continue;
    const std::string how = WIFEXITED(status) ? fmt::format("exit status {}", WEXITSTATUS(status))
                                              : fmt::format("signal {}", WTERMSIG(status));
    return fmt::format("{} ended at {} with {}", name,
                       Seconds(static_cast<double>(ended_ns) * 1e-9), how);
  }
  return {};
}

// A run without a summary: no more is known of the run than what its tables say.
LoadResult<Run> WithoutSummary(const std::string& folder) {
  Run run;
  run.folder = folder;
  run.is_whole = run.has_summary = false;
  const auto take = [&run](const CsvFields& fields) {
    const auto end_ns = ToInteger(fields[0]);
    if (end_ns) run.virtual_ns = std::max(run.virtual_ns, *end_ns);
    return end_ns.has_value();
  };
  const auto read = ReadCsv(folder + "/dispatches.csv", {"virtual_end_ns"}, take);
  if (std::holds_alternative<LoadError>(read)) {
    return LoadError{folder + " has neither summary.json nor dispatches.csv: the run did not end"};
  }
  return run;
}

// Takes the place of a verdict that nobody could give.
std::string CutOff(const Run& run) {
  return fmt::format(
      "the run was cut off soon after {}: it was killed, ended by an error, or it still goes on",
      Seconds(static_cast<double>(run.virtual_ns) * 1e-9));
}

LoadResult<Run> FromSummary(const std::string& folder, Ends ends,
                            std::vector<std::string>* warnings) {
  std::string path = folder + "/summary.json";
  std::optional<std::string> text = ReadFile(path);
  const bool was_cut = !text && ends == Ends::kAny;
  if (was_cut) {
    path = folder + "/unfinished.json";
    text = ReadFile(path);
  }
  if (!text && !was_cut) return LoadError{folder + " has no summary.json: the run did not end"};
  if (!text) {
    LoadResult<Run> without = WithoutSummary(folder);
    if (Run* run = std::get_if<Run>(&without)) {
      run->verdict = {CutOff(*run)};
      warnings->push_back(folder +
                          " has no summary.json, so that nothing is known of deadlines, response "
                          "times, ages and costs; the page shows what the run had written");
    }
    return without;
  }
  Run run;
  run.folder = folder;
  try {
    const UnorderedJson json = UnorderedJson::parse(*text);
    const bool was_interrupted = json.at("interrupted").get<bool>();
    if (was_interrupted && ends == Ends::kWhole) return LoadError{folder + " was interrupted"};
    run.measures = MeasuresFromSummary(*text).value_or(Measures());
    run.scenario = json.at("scenario").get<std::string>();
    // Runs of earlier versions did not say these.
    run.sync = json.value("sync", "");
    run.accounting = json.value("accounting", "");
    json.at("virtual_ns").get_to(run.virtual_ns);
    json.at("real_ns").get_to(run.real_ns);
    json.at("drift_ns").get_to(run.drift_ns);
    json.at("drift_bound_ns").get_to(run.drift_bound_ns);
    json.at("staleness_ns").get_to(run.staleness_ns);
    json.at("coordinating_ns").get_to(run.coordinating_ns);
    json.at("clients_ns").get_to(run.clients_ns);
    json.at("dynamics_ns").get_to(run.dynamics_ns);
    run.overhead = json.at("overhead_percent").get<double>() / 100.0;
    const UnorderedJson& clients = json.at("clients");
    const auto failure = was_cut ? std::nullopt : FailureOf(clients);
    if (failure && ends == Ends::kWhole) return LoadError{folder + ": " + *failure};
    for (const auto& [name, entry] : clients.items()) {
      Client& client = run.clients[name];
      client.robot = entry.value("robot", "");
      client.is_periodic = entry.value("class", "") == "periodic";
      entry.at("charged_ns").get_to(client.charged_ns);
      client.priced_ns = entry.value("priced_ns", std::int64_t{0});  // runs of earlier versions
      entry.at("host_cpu_ns").get_to(client.own_clock_ns);
      entry.at("stolen_ns").get_to(client.stolen_ns);
      entry.at("activations").get_to(client.activations);
      entry.at("overruns").get_to(client.overruns);
    }
    if (!was_cut) TakeAnswers(json, &run);
    run.is_whole = !was_cut && !was_interrupted && !failure;
    // Runs of earlier versions have no verdict.
    if (failure && run.verdict.empty()) run.verdict.push_back(*failure);
    if (was_interrupted && run.verdict.empty()) {
      run.verdict.push_back(fmt::format("the run was stopped at {}",
                                        Seconds(static_cast<double>(run.virtual_ns) * 1e-9)));
    }
    if (was_cut) {
      run.verdict = {CutOff(run)};
      warnings->push_back(
          fmt::format("{} is of a run that was cut off soon after {} (killed, ended by an error, "
                      "or it is still going on); this is what it had written, and nothing is known "
                      "of deadlines, response times and ages",
                      folder, Seconds(static_cast<double>(run.virtual_ns) * 1e-9)));
    }
  } catch (const UnorderedJson::exception&) {
    return LoadError{path + " is damaged; make the run again"};
  }
  return run;
}

struct BodyPoint {
  double x = 0, y = 0, z = 0;
};

std::optional<BodyPoint> PointOf(const CsvFields& fields) {
  const auto x = ToReal(fields[2]), y = ToReal(fields[3]), z = ToReal(fields[4]);
  if (!x || !y || !z) return {};
  return BodyPoint{*x, *y, *z};
}

// The links of a model are called MODEL/LINK.
std::string_view ModelOf(std::string_view body) { return body.substr(0, body.find('/')); }

// Pairs the states of the two bodies that have the same time.
class TrackBuilder {
 public:
  TrackBuilder(Run* run, std::vector<std::string> wanted)
      : run_(*run), wanted_(std::move(wanted)) {}

  bool Take(const CsvFields& fields) {
    const auto time = ToReal(fields[0]);
    const auto point = PointOf(fields);
    if (!time || !point) return false;
    NoteBody(fields[1]);
    for (std::size_t i = 0; i < 2; ++i) {
      if (wanted_.size() <= i || fields[1] != wanted_[i]) continue;
      points_[i] = *point;
      times_[i] = *time;
    }
    if (times_[0] != times_[1] || times_[0] == last_) return true;
    last_ = times_[0];
    std::copy_n(wanted_.begin(), 2, run_.apart);
    run_.track.time_s.push_back(last_);
    run_.track.distance_m.push_back(std::hypot(
        points_[0].x - points_[1].x, points_[0].y - points_[1].y, points_[0].z - points_[1].z));
    return true;
  }

 private:
  void NoteBody(std::string_view name) {
    const bool known = std::find(run_.bodies.begin(), run_.bodies.end(), name) != run_.bodies.end();
    if (known) return;
    run_.bodies.emplace_back(name);
    if (!takes_first_ || wanted_.size() == 2) return;
    // How far the links of one model are apart tells nobody anything.
    if (!wanted_.empty() && ModelOf(wanted_[0]) == ModelOf(name)) return;
    wanted_.emplace_back(name);
  }

  Run& run_;
  std::vector<std::string> wanted_;
  const bool takes_first_ = wanted_.empty();
  BodyPoint points_[2];
  double times_[2] = {-1, -2}, last_ = -1;
};

// The activations of the client's first thread; a best-effort client's go on while it waits for
// threads.
class ActivationBuilder {
 public:
  explicit ActivationBuilder(Run* run) : run_(*run) {}

  bool Take(const CsvFields& fields) {
    const auto client = run_.clients.find(std::string(fields[0]));
    const auto thread = ToInteger(fields[1]);
    const auto release = ToInteger(fields[3]), start = ToInteger(fields[4]),
               end = ToInteger(fields[5]), charged = ToInteger(fields[6]);
    if (client == run_.clients.end() || !thread || !release || !start || !end || !charged) {
      return false;
    }
    if (*thread != 0 || fields[2] == "start") return true;
    ActivationTimes& times = client->second.times;
    const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
    if (fields[2] == "thread" && !client->second.is_periodic && !times.response_s.empty()) {
      times.response_s.back() = seconds(*end - released_ns_[&client->second]);
      times.computed_s.back() += seconds(*charged);
      return true;
    }
    released_ns_[&client->second] = *release;
    times.lateness_s.push_back(seconds(*start - *release));
    times.response_s.push_back(seconds(*end - *release));
    times.computed_s.push_back(seconds(*charged));
    return true;
  }

 private:
  Run& run_;
  std::map<const Client*, std::int64_t> released_ns_;
};

void WarnOfLines(const std::string& path, std::int64_t lines, std::vector<std::string>* warnings) {
  if (lines == 0) return;
  warnings->push_back(
      fmt::format("{} has {} that cannot be used; left out", path, Count(lines, "line")));
}

// Runs of earlier versions have no activations.
std::optional<LoadError> ReadActivations(const std::string& folder, Run* run,
                                         std::vector<std::string>* warnings) {
  if (const std::string path = folder + "/activations.csv"; IsFile(path)) {
    ActivationBuilder activations(run);
    const auto read = ReadCsv(
        path, {"client", "thread", "cause", "release_ns", "start_ns", "end_ns", "charged_ns"},
        [&](const CsvFields& fields) { return activations.Take(fields); });
    if (const auto* error = std::get_if<LoadError>(&read)) return *error;
    WarnOfLines(path, std::get<std::int64_t>(read), warnings);
  }
  return {};
}

// Runs of earlier versions have no responses; without a summary nobody knows which responses count.
void TakeResponses(const std::string& folder, Run* run) {
  if (!run->has_answers || !IsFile(folder + "/responses.csv")) return;
  const auto read = explain::ReadTold(folder);
  const auto* told = std::get_if<explain::Told>(&read);
  if (told == nullptr) return;
  for (const explain::Activation& one : told->activations) {
    const auto client = run->clients.find(one.client);
    if (client == run->clients.end()) continue;
    client->second.responses_s.push_back(static_cast<double>(one.TookNs()) * 1e-9);
  }
}

}  // namespace

LoadResult<Run> ReadRunFigures(const std::string& folder, std::vector<std::string>* warnings) {
  return FromSummary(folder, Ends::kWhole, warnings);
}

LoadResult<Run> ReadRunTimes(const std::string& folder, std::vector<std::string>* warnings) {
  LoadResult<Run> result = FromSummary(folder, Ends::kAny, warnings);
  Run* run = std::get_if<Run>(&result);
  if (run == nullptr) return result;
  if (auto error = ReadActivations(folder, run, warnings)) return *error;
  return result;
}

LoadResult<Run> ReadRun(const std::string& folder, const std::vector<std::string>& bodies,
                        Ends ends, std::vector<std::string>* warnings, Distance distance) {
  LoadResult<Run> result = FromSummary(folder, ends, warnings);
  Run* run = std::get_if<Run>(&result);
  if (run == nullptr) return result;

  // Without dynamics there are no bodies.
  if (const std::string path = folder + "/bodies.csv";
      distance == Distance::kRead && IsFile(path)) {
    TrackBuilder track(run, bodies);
    const auto read = ReadCsv(path, {"time_s", "body", "x_m", "y_m", "z_m"},
                              [&](const CsvFields& fields) { return track.Take(fields); });
    if (const auto* error = std::get_if<LoadError>(&read)) return *error;
    WarnOfLines(path, std::get<std::int64_t>(read), warnings);
  }
  for (const std::string& body : bodies) {
    if (std::find(run->bodies.begin(), run->bodies.end(), body) != run->bodies.end()) continue;
    return LoadError{fmt::format("there is no body '{}' in {}; it has {}", body, folder,
                                 run->bodies.empty() ? "none" : Listed(run->bodies))};
  }
  TakeResponses(folder, run);
  return result;
}

}  // namespace tcs::report
