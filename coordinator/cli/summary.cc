#include "coordinator/cli/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "coordinator/answers/verdict.h"
#include "coordinator/cli/chain_table.h"
#include "coordinator/cli/client_table.h"
#include "coordinator/cli/figures_json.h"
#include "coordinator/cli/metrics_text.h"
#include "coordinator/cli/print.h"
#include "coordinator/engine/failures.h"
#include "coordinator/expect/expect_json.h"
#include "coordinator/os/files.h"
#include "coordinator/os/say.h"
#include "coordinator/text/spoken.h"
#include "simbody_bridge/engines.h"

namespace tcs {

namespace {

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }
double Milliseconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

std::int64_t NotOnOurCpu(const RunReport& r) {
  return r.real_ns - (r.client_ns - r.ahead_ns) - r.awaited_ns - r.dynamics_ns - r.coordinating_ns;
}

// How long each core was busy, in all and with each client; the core was idle for the rest of the
// run.
nlohmann::ordered_json UseOfCores(const RobotSpec& robot, const RunReport& r) {
  auto cores = nlohmann::ordered_json::array();
  for (int core = 0; core < robot.cores; ++core) {
    std::int64_t busy_ns = 0;
    auto clients = nlohmann::ordered_json::object();
    for (const ClientReport& client : r.clients) {
      const bool is_of_robot = std::ranges::any_of(
          robot.clients, [&](const ClientSpec& spec) { return spec.name == client.name; });
      const auto had = client.figures.core_ns.find(core);
      if (!is_of_robot || had == client.figures.core_ns.end()) continue;
      busy_ns += had->second;
      clients[client.name] = had->second;
    }
    cores.push_back({{"busy_ns", busy_ns}, {"clients_ns", std::move(clients)}});
  }
  return cores;
}

// The engine's name; null where there is no world.
nlohmann::json EngineOf(const Scenario& scenario) {
  if (!scenario.world.has_value()) return {};
  return TraitsOf(scenario.world->integrator.engine).name;
}

}  // namespace

namespace {

// Prints nothing of a run that had no pace, and that nobody let stand.
void PrintPace(const PaceReport& pace) {
  if (pace.stood_ns > 0) Print("it was paused for {:.3f} s of that\n", Seconds(pace.stood_ns));
  if (pace.pace <= 0) return;
  if (pace.behind_ns == 0) {
    Print("it kept its pace of {:g} x the wall clock, and was at most {:.1f} ms behind\n",
          pace.pace, Milliseconds(pace.most_ns));
    return;
  }
  Print("it was behind its pace of {:g} x the wall clock for {:.3f} s, {:.3f} s at its end\n",
        pace.pace, Seconds(pace.behind_ns), Seconds(pace.late_ns));
}

// Prints nothing of clients that had no answers.
void PrintOutside(const std::vector<ClientReport>& clients) {
  for (const ClientReport& c : clients) {
    const std::int64_t answers = c.outside.answers;
    if (answers == 0) continue;
    Print("{} waited {:.3f} s for {} from outside of the run, {} each\n", c.name,
          c.outside.waited.seconds(),
          answers == 1 ? "an answer" : fmt::format("{} answers", answers),
          Spoken(c.outside.waited.ns() / answers));
  }
}

}  // namespace

double OverheadPercent(const RunReport& r) {
  return r.real_ns == 0 ? 0.0 : 100.0 * Seconds(r.coordinating_ns) / Seconds(r.real_ns);
}

bool HasFailedClient(const RunReport& report) {
  return std::any_of(report.clients.begin(), report.clients.end(), HasFailed);
}

void PrintSummary(const Scenario& scenario, const RunReport& r, const std::string& directory) {
  Print("{}{:.3f} s of virtual time in {:.3f} s: {:.2f} x real time\n",
        r.interrupted ? "interrupted; " : "", Seconds(r.virtual_ns), Seconds(r.real_ns),
        Seconds(r.virtual_ns) / std::max(1e-9, Seconds(r.real_ns)));
  PrintPace(r.pace);
  const bool all_ended = std::all_of(r.clients.begin(), r.clients.end(),
                                     [](const ClientReport& c) { return c.ended_at_ns >= 0; });
  if (!r.interrupted && all_ended && r.virtual_ns < scenario.duration.ns()) {
    Print("ended before its {:.3f} s because all programs had ended\n",
          Seconds(scenario.duration.ns()));
  }
  for (const std::string& sentence : Shortened(r.verdict)) Print("! {}\n", sentence);
  Print("{}", ClientTable(r.clients));
  PrintOutside(r.clients);
  Print("{}", ChainTable(r.chains));
  Print("{}", MetricsTable(r.metrics));
  Print("of the simulation itself, not of the robots:\n");
  Print("drift {:.3f} ms (bound {:.3f} ms), staleness {} ns, lateness {:.3f} ms\n",
        Milliseconds(r.drift_ns), Milliseconds(scenario.drift_bound.ns()), r.staleness_ns,
        Milliseconds(r.lateness_ns));
  Print(
      "coordinating {:.3f} s = {:.2f} % overhead, clients {:.3f} s, dynamics {:.3f} s, "
      "not on our CPU {:.3f} s; {} dispatches, {} samples, {} commands\n",
      Seconds(r.coordinating_ns), OverheadPercent(r), Seconds(r.client_ns), Seconds(r.dynamics_ns),
      Seconds(std::max<std::int64_t>(0, NotOnOurCpu(r))), r.switches, r.samples, r.commands);
  if (r.ahead_ns > 0) {
    Print("of the clients' {:.3f} s, {:.3f} s were computed ahead on further processors\n",
          Seconds(r.client_ns), Seconds(r.ahead_ns));
  }
  if (r.unaccounted_steals > 0) {
    Print(
        "the host took the processor {} in the middle of a turn, and no clock of the kernel showed "
        "it: {:.3f} ms are not charged (they are part of stolen_ns in summary.json)\n",
        r.unaccounted_steals == 1 ? "once" : fmt::format("{} times", r.unaccounted_steals),
        Milliseconds(r.unaccounted_steal_ns));
  }
  Print("written to {}: summary.json, *.csv, trace.json (for ui.perfetto.dev), *.log\n", directory);
  Print("to look at it: tcsim report {}\n", directory);
  for (const ClientReport& c : r.clients) {
    if (HasFailed(c)) Say(FailureOf(c, directory, directory + "/"));
  }
}

std::string SummaryText(const Scenario& scenario, const RunOptions& options, const RunReport& r,
                        const std::vector<Judgement>& judgements) {
  const bool fixed = options.accounting == shm::Accounting::kFixed;
  const bool callback = options.sync == shm::Sync::kCallback;
  using Json = nlohmann::ordered_json;
  Json json{{"scenario", scenario.name},
            {"seed", scenario.seed},
            {"set", scenario.set},
            {"accounting", fixed ? "fixed" : "measured"},
            {"sync", callback ? "callback" : "consistent"},
            {"engine", EngineOf(scenario)},
            {"interrupted", r.interrupted},
            {"duration_ns", scenario.duration.ns()},
            {"virtual_ns", r.virtual_ns},
            {"real_ns", r.real_ns},
            {"drift_ns", r.drift_ns},
            {"drift_bound_ns", scenario.drift_bound.ns()},
            {"staleness_ns", r.staleness_ns},
            {"lateness_ns", r.lateness_ns},
            {"clients_ns", r.client_ns},
            {"ahead_ns", r.ahead_ns},
            {"awaited_ns", r.awaited_ns},
            {"turns_beside", r.turns_beside},
            {"dynamics_ns", r.dynamics_ns},
            {"coordinating_ns", r.coordinating_ns},
            {"overhead_percent", OverheadPercent(r)},
            {"unaccounted_steals", r.unaccounted_steals},
            {"unaccounted_steal_ns", r.unaccounted_steal_ns},
            {"dispatches", r.switches},
            {"samples", r.samples},
            {"commands", r.commands},
            {"warnings", r.warnings}};
  const bool answers = !options.output_directory.empty();
  if (answers) json["verdict"] = r.verdict;
  if (!judgements.empty()) json["expectations"] = ExpectationsJson(judgements);
  if (answers) json["metrics"] = MetricsJson(r.metrics);
  if (r.pace.pace > 0 || r.pace.stood_ns > 0) {
    json["pace"] = {{"wanted", r.pace.pace},
                    {"behind_ns", r.pace.behind_ns},
                    {"most_ns", r.pace.most_ns},
                    {"late_ns", r.pace.late_ns},
                    {"stood_ns", r.pace.stood_ns}};
  }
  for (const RobotSpec& robot : scenario.robots) {
    json["robots"][robot.name] = {{"cores", robot.cores}, {"speed", robot.speed}};
    if (robot.wakeup.median > VirtualDuration()) {
      json["robots"][robot.name]["wakeup"] = {{"median_ns", robot.wakeup.median.ns()},
                                              {"p99_ns", robot.wakeup.p99.ns()}};
    }
    json["robots"][robot.name]["costs"] = {{"list", robot.is_ideal ? "none" : robot.prices.name},
                                           {"hash", fmt::format("{:016x}", robot.prices.Hash())}};
    json["robots"][robot.name]["scheduler"] =
        robot.scheduler == SchedulerPolicy::kFixedPriority ? "fixed_priority" : "edf";
    if (answers) json["robots"][robot.name]["use"] = UseOfCores(robot, r);
    for (const ClientSpec& client : robot.clients) {
      const bool periodic = client.client_class == ClientClass::kPeriodic;
      json["clients"][client.name] = {{"robot", robot.name},
                                      {"class", periodic ? "periodic" : "best-effort"},
                                      {"priority", client.priority}};
    }
  }
  for (const ClientReport& c : r.clients) {
    json["clients"][c.name].update({
        {"charged_ns", c.usage.charged_ns},
        {"priced_ns", c.usage.priced_ns},
        {"host_cpu_ns", c.usage.host_cpu_ns},
        {"own_work_ns", c.usage.own_work_ns},
        {"stolen_ns", c.usage.stolen_ns},
        {"activations", c.usage.activations},
        {"overruns", c.usage.overruns},
        {"started_at_ns", c.started_at_ns},
        {"ended_at_ns", c.ended_at_ns},
        {"wait_status", c.wait_status},
    });
    if (c.outside.answers > 0) {
      json["clients"][c.name]["outside"] = {{"answers", c.outside.answers},
                                            {"waited_ns", c.outside.waited.ns()}};
    }
    if (answers) AddFigures(c.figures, json["clients"][c.name]);
    if (!options.counts_work) continue;
    json["clients"][c.name]["calls"] = c.usage.work.calls;
    json["clients"][c.name]["allocations"] = c.usage.work.allocations();
  }
  if (answers) {
    json["chains"] = Json::object();
    for (const ChainFigures& chain : r.chains) json["chains"][chain.name] = ChainJson(chain);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tcs
