// tcsim: the command.
#include <fmt/format.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "coordinator/core/coordinator.h"
#include "coordinator/os/host.h"
#include "coordinator/scenario/duration.h"
#include "coordinator/scenario/executable.h"
#include "coordinator/scenario/load.h"

namespace {

int Fail(const std::string& sentence) {
  fmt::print(stderr, "tcsim: {}\n", sentence);
  return 2;
}

std::string PreloadLibrary() {
  char self[PATH_MAX];
  const ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
  if (n <= 0) return {};
  const std::string path(self, static_cast<std::size_t>(n));
  const std::string bin = path.substr(0, path.rfind('/'));
  return bin.substr(0, bin.rfind('/')) + "/lib/libtcs_preload.so";
}

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

double OverheadPercent(const tcs::RunReport& r) {
  return r.real_ns == 0 ? 0.0 : 100.0 * Seconds(r.coordinating_ns) / Seconds(r.real_ns);
}

void PrintSummary(const tcs::RunReport& r) {
  fmt::print("virtual {:.3f} s in {:.3f} s real; drift {:.3f} ms; staleness {} ns\n",
             Seconds(r.virtual_ns), Seconds(r.real_ns), Seconds(r.drift_ns) * 1e3, r.staleness_ns);
  fmt::print(
      "clients {:.3f} s, dynamics {:.3f} s, coordinating {:.3f} s ({:.2f} %), not on our CPU "
      "{:.3f} s, "
      "{} dispatches\n",
      Seconds(r.client_ns), Seconds(r.dynamics_ns), Seconds(r.coordinating_ns), OverheadPercent(r),
      Seconds(r.real_ns - r.client_ns - r.dynamics_ns - r.coordinating_ns), r.switches);
  for (const tcs::ClientReport& c : r.clients) {
    fmt::print("  {:<24} charged {:8.3f} s (own CPU clock {:8.3f} s)  activations {}\n", c.name,
               Seconds(c.charged_ns), Seconds(c.host_cpu_ns), c.activations);
  }
  for (const std::string& w : r.warnings) fmt::print(stderr, "tcsim: warning: {}\n", w);
}

void WriteSummary(const tcs::RunReport& r, const std::string& path) {
  nlohmann::ordered_json json{{"virtual_ns", r.virtual_ns},
                              {"real_ns", r.real_ns},
                              {"drift_ns", r.drift_ns},
                              {"staleness_ns", r.staleness_ns},
                              {"clients_ns", r.client_ns},
                              {"dynamics_ns", r.dynamics_ns},
                              {"coordinating_ns", r.coordinating_ns},
                              {"samples", r.samples},
                              {"commands", r.commands},
                              {"warnings", r.warnings}};
  for (const tcs::ClientReport& c : r.clients) {
    json["clients"][c.name] = {{"charged_ns", c.charged_ns},
                               {"host_cpu_ns", c.host_cpu_ns},
                               {"stolen_ns", c.stolen_ns},
                               {"activations", c.activations}};
  }
  std::ofstream(path) << json.dump(2) << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Runs robot programs in a simulation in which computing takes time"};
  app.require_subcommand(1);
  std::string accounting = "measured";

  std::string path, duration, drift, out = "out";
  std::uint64_t seed = 0;
  CLI::App* run = app.add_subcommand("run", "run a scenario");
  run->add_option("scenario", path, "the YAML file")->required();
  run->add_option("--duration", duration, "of virtual time, such as 20s");
  run->add_option("--drift", drift, "the drift bound, such as 1ms");
  CLI::Option* seeded = run->add_option("--seed", seed, "what ${seed} stands for");
  run->add_option("--out", out, "folder for logs, CSV and summary");

  double speed = 1.0;
  std::vector<std::string> command;
  CLI::App* exec = app.add_subcommand("exec", "run any program in virtual time");
  exec->add_option("--speed", speed, "of its processor")->check(CLI::PositiveNumber);
  exec->add_option("command", command, "after --")->required();
  for (CLI::App* sub : {run, exec}) {
    sub->add_option("--accounting", accounting)->check(CLI::IsMember({"measured", "fixed"}));
  }
  CLI11_PARSE(app, argc, argv);

  tcs::RunOptions options;
  options.preload_library = PreloadLibrary();
  if (access(options.preload_library.c_str(), R_OK) != 0) {
    return Fail("the shim is missing: " + options.preload_library + "; build it again");
  }
  if (accounting == "fixed") options.accounting = tcs::shm::Accounting::kFixed;

  if (exec->parsed()) {
    char cwd[PATH_MAX];
    if (getcwd(cwd, sizeof cwd) == nullptr) return Fail("the current folder is gone");
    auto found = tcs::FindExecutable(command[0], cwd);
    if (auto* error = std::get_if<tcs::LoadError>(&found)) {
      Fail(error->message);
      return 127;
    }
    if (auto error = tcs::CheckExecutable(std::get<std::string>(found)))
      return Fail(error->message);
    tcs::Scenario scenario;
    scenario.duration = tcs::VirtualDuration::Nanoseconds(tcs::shm::kNeverNs);
    tcs::ClientSpec client;
    client.name = command[0];
    client.command = command;
    scenario.robots.push_back({"computer", 1, speed, {client}});
    const tcs::RunReport report = tcs::RunScenario(scenario, options);
    for (const std::string& w : report.warnings) fmt::print(stderr, "tcsim: warning: {}\n", w);
    return report.error.empty() ? report.exit_status : Fail(report.error);
  }

  tcs::ScenarioOverrides overrides;
  for (auto [text, to] : {std::pair{&duration, &overrides.duration}, {&drift, &overrides.drift}}) {
    if (text->empty()) continue;
    auto parsed = tcs::ParseDuration(*text);
    if (auto* error = std::get_if<tcs::LoadError>(&parsed)) return Fail(error->message);
    *to = std::get<tcs::VirtualDuration>(parsed);
  }
  if (seeded->count() > 0) overrides.seed = seed;
  auto loaded = tcs::LoadScenario(path, overrides);
  if (auto* error = std::get_if<tcs::LoadError>(&loaded)) return Fail(error->message);
  if (mkdir(out.c_str(), 0755) != 0 && errno != EEXIST)
    return Fail("cannot make the folder " + out);
  options.output_directory = std::filesystem::absolute(out);
  const tcs::RunReport report = tcs::RunScenario(std::get<tcs::Scenario>(loaded), options);
  if (!report.error.empty()) return Fail(report.error);
  PrintSummary(report);
  WriteSummary(report, out + "/summary.json");
  return 0;
}
