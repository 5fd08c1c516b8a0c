// `robots` of a scenario file: virtual computers and the clients on them.
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/executable.h"
#include "coordinator/scenario/load_lives.h"
#include "coordinator/scenario/load_outside.h"
#include "coordinator/scenario/load_prices.h"
#include "coordinator/scenario/sections.h"
#include "coordinator/scenario/substitute.h"

namespace tcs {
namespace {

constexpr std::int64_t kMostCores = 64;
constexpr double kSlowest = 1e-3;
constexpr double kFastest = 1e3;

// `50us`, or {median: 20us, p99: 80us}.
WakeupSpec LoadWakeup(const YamlValue& value) {
  if (!value.IsMap()) {
    const VirtualDuration always = value.AsDuration();
    if (always > WakeupSpec::kLongest)
      value.Fail("is " + value.AsText() + "; it must be at most 1 s");
    return {always, always};
  }
  const YamlMap map = value.AsMap();
  map.AllowOnly({"median", "p99"});
  WakeupSpec wakeup;
  wakeup.median = map.Require("median", "20us").AsPositiveDuration();
  wakeup.p99 = map.Require("p99", "80us").AsPositiveDuration();
  if (wakeup.p99 < wakeup.median) value.Fail("has a p99 that is below its median");
  if (wakeup.p99 > WakeupSpec::kLongest) value.Fail("has a p99 of more than 1 s");
  return wakeup;
}

// `none`, or a file.
void LoadCosts(const YamlValue& value, const Variables& variables, RobotSpec* robot) {
  const std::string text = Substitute(value, variables);
  if (text.empty()) value.Fail("is empty; give the path of a list of prices, or write none");
  robot->prices_are_hosts = false;
  robot->prices = NoPrices();
  if (text == "none") return;
  const auto path = std::filesystem::path(variables.scenario_directory) / text;
  LoadResult<PriceList> list = LoadPriceFile(path.lexically_normal());
  if (const auto* error = std::get_if<LoadError>(&list)) {
    value.FailPlainly(value.name() + ": " + error->message);
  }
  robot->prices = std::get<PriceList>(std::move(list));
}

void LoadCpu(const YamlValue& value, const Variables& variables, RobotSpec* robot) {
  if (!value.IsMap()) {
    robot->is_ideal = value.AsText() == "ideal";
    if (robot->is_ideal) return;
    value.Fail("is '" + value.AsText() + "'; write ideal, or a map like {cores: 1, speed: 1.0}");
  }
  const YamlMap map = value.AsMap();
  map.AllowOnly({"cores", "speed", "outside_speed", "wakeup", "costs"});
  if (const YamlValue* cores = map.Find("cores")) {
    robot->cores = static_cast<int>(cores->AsInteger(1, kMostCores));
  }
  if (const YamlValue* speed = map.Find("speed")) {
    robot->speed = speed->AsPositiveNumber(" (1.0 is the host's speed)");
    if (robot->speed < kSlowest || robot->speed > kFastest) {
      speed->Fail("is " + speed->AsText() + "; it must be between 0.001 and 1000");
    }
  }
  if (const YamlValue* speed = map.Find("outside_speed")) {
    robot->outside_speed = speed->AsPositiveNumber(" (1.0: an hour outside is an hour inside)");
    if (robot->outside_speed < kSlowest || robot->outside_speed > kFastest) {
      speed->Fail("is " + speed->AsText() + "; it must be between 0.001 and 1000");
    }
  }
  if (const YamlValue* wakeup = map.Find("wakeup"))
    wakeup->Try([&] { robot->wakeup = LoadWakeup(*wakeup); });
  if (const YamlValue* costs = map.Find("costs"))
    costs->Try([&] { LoadCosts(*costs, variables, robot); });
}

ClientClass LoadClass(const YamlValue& value) {
  const std::string text = value.AsText();
  if (text == "periodic") return ClientClass::kPeriodic;
  if (text == "best-effort" || text == "best_effort") return ClientClass::kBestEffort;
  value.Fail("is the unknown '" + text + "'; " +
             Suggest(text, {"periodic", "best-effort"}, "classes"));
}

DdsTransport LoadDdsTransport(const YamlValue& value) {
  const std::string text = value.AsText();
  if (text == "endpoints") return DdsTransport::kEndpoints;
  if (text == "sockets") return DdsTransport::kSockets;
  value.Fail("is the unknown '" + text + "'; " +
             Suggest(text, {"endpoints", "sockets"}, "ways of DDS"));
}

CycleCounter LoadCycleCounter(const YamlValue& value) {
  const std::string text = value.AsText();
  if (text == "virtual") return CycleCounter::kVirtual;
  if (text == "host") return CycleCounter::kHost;
  value.Fail("is the unknown '" + text + "'; " +
             Suggest(text, {"virtual", "host"}, "cycle counters"));
}

SchedulerPolicy LoadScheduler(const YamlValue& value) {
  const std::string text = value.AsText();
  if (text == "fixed_priority") return SchedulerPolicy::kFixedPriority;
  if (text == "edf") return SchedulerPolicy::kEarliestDeadlineFirst;
  value.Fail("is the unknown '" + text + "'; " +
             Suggest(text, {"fixed_priority", "edf"}, "schedulers"));
}

// A controller without a known deadline would come last, behind all that have one.
void LoadDeadline(const YamlMap::Entry& entry, const YamlMap& map, SchedulerPolicy scheduler,
                  ClientSpec* client) {
  const YamlValue* deadline = map.Find("deadline");
  const bool is_edf = scheduler == SchedulerPolicy::kEarliestDeadlineFirst;
  if (deadline != nullptr) {
    client->deadline = deadline->AsPositiveDuration();
  } else if (is_edf && client->client_class == ClientClass::kPeriodic) {
    entry.value.Fail(
        "has no deadline, by which `scheduler: edf` orders periodic clients; add one, as in "
        "deadline: 10ms");
  }
}

std::vector<std::string> LoadCommand(const YamlValue& value, const Variables& variables) {
  std::vector<std::string> command;
  const std::vector<YamlValue> words = value.AsList("[./controller, --rate, 100]");
  for (const YamlValue& word : words) command.push_back(Substitute(word, variables));

  LoadResult<std::string> program = FindExecutable(command[0], variables.scenario_directory);
  if (const auto* error = std::get_if<LoadError>(&program)) {
    words[0].FailPlainly(value.name() + ": " + error->message);
  }
  command[0] = std::get<std::string>(std::move(program));
  if (const auto error = CheckExecutable(command[0])) {
    words[0].FailPlainly(value.name() + ": " + error->message);
  }
  return command;
}

std::map<std::string, std::string> LoadEnvironment(const YamlValue& value,
                                                   const Variables& variables) {
  std::map<std::string, std::string> environment;
  const YamlMap map = value.AsMap();
  for (const YamlMap::Entry& entry : map.entries()) {
    if (entry.key.empty() ||
        entry.key.find_first_of(std::string_view("=\0", 2)) != std::string::npos) {
      entry.value.Fail("is no environment variable's name: it must not be empty or contain '='");
    }
    environment[entry.key] = Substitute(entry.value, variables);
  }
  return environment;
}

ClientSpec LoadClient(const YamlMap::Entry& entry, const std::string& robot,
                      SchedulerPolicy scheduler, const Variables& variables,
                      const Scenario& scenario) {
  CheckName(entry);
  const YamlMap map = entry.value.AsMap();
  map.AllowOnly({"command", "class", "priority", "deadline", "body", "environment",
                 "fixed_call_cost", "fixed_allocation_cost", "patch_vdso", "rdtsc", "dds",
                 "working_directory", "start", "after", "stop_signal", "stop_grace", "outside"});
  ClientSpec client;
  client.name = robot + "/" + entry.key;
  client.working_directory = variables.scenario_directory;
  client.command = LoadCommand(map.Require("command", "command: [./controller]"), variables);
  if (const YamlValue* v = map.Find("class")) client.client_class = LoadClass(*v);
  if (const YamlValue* v = map.Find("priority")) {
    client.priority = static_cast<int>(v->AsInteger(0, 99));
  }
  LoadDeadline(entry, map, scheduler, &client);
  if (const YamlValue* v = map.Find("body")) client.body = FindBody(*v, scenario);
  if (const YamlValue* v = map.Find("environment")) {
    client.environment = LoadEnvironment(*v, variables);
  }
  if (const YamlValue* v = map.Find("fixed_call_cost")) {
    client.fixed_call_cost = v->AsPositiveDuration();
  }
  if (const YamlValue* v = map.Find("fixed_allocation_cost")) {
    client.fixed_allocation_cost = v->AsDuration();
  }
  if (const YamlValue* v = map.Find("patch_vdso")) client.patch_vdso = v->AsBoolean();
  if (const YamlValue* v = map.Find("rdtsc")) client.cycle_counter = LoadCycleCounter(*v);
  if (const YamlValue* v = map.Find("dds")) client.dds = LoadDdsTransport(*v);
  if (const YamlValue* v = map.Find("outside")) client.outside = LoadOutside(*v, variables);
  LoadLife(map, variables, &client);
  return client;
}

RobotSpec LoadRobot(const YamlMap::Entry& entry, const Variables& variables,
                    const Scenario& scenario) {
  CheckName(entry);
  const YamlMap map = entry.value.AsMap();
  map.AllowOnly({"cpu", "scheduler", "address", "clients"});
  RobotSpec robot;
  robot.name = entry.key;
  if (const YamlValue* cpu = map.Find("cpu")) LoadCpu(*cpu, variables, &robot);
  if (const YamlValue* v = map.Find("scheduler")) robot.scheduler = LoadScheduler(*v);
  const YamlValue& clients =
      map.Require("clients", "clients: {controller: {command: [./controller]}}");
  const YamlMap client_map = clients.AsMap();
  if (client_map.entries().empty()) clients.Fail("is empty; a robot needs at least one client");
  client_map.ForEach([&](const YamlMap::Entry& client) {
    robot.clients.push_back(LoadClient(client, robot.name, robot.scheduler, variables, scenario));
  });
  return robot;
}

}  // namespace

const YamlValue& RobotsOf(const YamlMap& top) {
  return top.Require("robots", "robots: {predator: {clients: {controller: {command: [./fly]}}}}");
}

void LoadRobots(const YamlMap& top, const Variables& variables, Scenario* scenario) {
  const YamlValue& robots = RobotsOf(top);
  const YamlMap map = robots.AsMap();
  if (map.entries().empty()) robots.Fail("is empty; a scenario needs at least one robot");
  map.ForEach([&](const YamlMap::Entry& entry) {
    scenario->robots.push_back(LoadRobot(entry, variables, *scenario));
  });
  if (!robots.HasMistakes()) LoadOrder(map, scenario);
}

}  // namespace tcs
