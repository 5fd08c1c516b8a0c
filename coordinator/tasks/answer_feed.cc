#include "coordinator/tasks/answer_feed.h"

#include <utility>
#include <vector>

#include "coordinator/answers/by_number.h"

namespace tcs {

namespace {

// Of the gateway's threads (gateway/main.cc): samples are taken by the deliverer of the process by
// endpoints, and written by the first thread of the one by sockets.
bool CarriesSensors(const Task& task) {
  const Process& process = *task.process;
  return process.is_client ? task.is_deliverer : task.tid == process.pid;
}

}  // namespace

void AnswerFeed::Open(const Scenario& scenario) {
  std::vector<AnswerBook::Client> clients;
  int robot_number = 0;
  for (const RobotSpec& robot : scenario.robots) {
    for (const ClientSpec& client : robot.clients) {
      clients_[&client] = names_[client.name] = static_cast<int>(clients.size());
      clients.push_back({.name = client.name,
                         .robot = robot_number,
                         .deadline_ns = client.deadline.ns(),
                         .is_periodic = client.client_class == ClientClass::kPeriodic});
    }
    if (robot.is_ours) {
      ours_ = static_cast<int>(clients.size()) - 1;
      AnswerBook::Client commands = clients.back();
      commands.name += " (commands)";
      names_[commands.name] = static_cast<int>(clients.size());
      clients.push_back(std::move(commands));
    }
    ++robot_number;
  }
  std::vector<std::string> sensors;
  for (const SensorChannelSpec& sensor : scenario.sensors) sensors.push_back(sensor.name);
  book_.Open(std::move(clients), std::move(sensors));
  OpenChains(scenario);
}

void AnswerFeed::OpenChains(const Scenario& scenario) {
  std::vector<ChainBook::Sensor> sensors;
  for (const SensorChannelSpec& sensor : scenario.sensors)
    sensors.push_back({sensor.name, sensor.period.ns()});
  std::vector<ChainBook::Command> commands;
  for (const CommandChannelSpec& command : scenario.commands)
    commands.push_back({command.name, command.latency.ns()});
  std::vector<ChainBook::Chain> chains;
  for (const ChainSpec& spec : scenario.chains) {
    ChainBook::Chain& chain = chains.emplace_back();
    chain = {spec.name,
             static_cast<int>(spec.sensor),
             static_cast<int>(spec.command),
             {},
             spec.deadline.ns()};
    for (const std::string& client : spec.through) chain.through.push_back(names_.at(client));
  }
  chains_.Open(NamesOfClients(), std::move(sensors), std::move(commands), std::move(chains));
}

std::vector<std::string> AnswerFeed::NamesOfClients() const {
  std::vector<std::string> names(names_.size());
  for (const auto& [name, number] : names_) names[static_cast<std::size_t>(number)] = name;
  return names;
}

std::optional<AnswerBook::Who> AnswerFeed::WhoIs(const ClientSpec& client) const {
  const auto found = clients_.find(&client);
  if (found == clients_.end()) return std::nullopt;
  return AnswerBook::Who{.client = found->second};
}

std::optional<AnswerBook::Who> AnswerFeed::WhoIs(const std::string& client) const {
  const auto found = names_.find(client);
  if (found == names_.end()) return std::nullopt;
  return AnswerBook::Who{.client = found->second};
}

void AnswerFeed::Dies(const Task& task) {
  book_.Dies(task.order);
  chains_.Dies(task.order);
  PlaceOf(known_, task.order) = {};
}

std::optional<AnswerBook::Who> AnswerFeed::WhoIs(const Task& task) const {
  Known& known = PlaceOf(known_, task.order);
  if (known.process != task.process) {
    const Process* client = task.process->client;
    if (client == nullptr || client->spec == nullptr) return std::nullopt;
    const std::optional<AnswerBook::Who> found = WhoIs(*client->spec);
    if (!found.has_value()) return std::nullopt;
    known = {task.process, found->client};
  }
  if (known.client == ours_) {
    return AnswerBook::Who{.client = CarriesSensors(task) ? ours_ : ours_ + 1,
                           .thread = task.order,
                           .is_first = !task.is_further};
  }
  return AnswerBook::Who{
      .client = known.client, .thread = task.order, .is_first = !task.is_further};
}

}  // namespace tcs
