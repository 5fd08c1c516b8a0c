#include "coordinator/tasks/answer_feed.h"

#include <utility>
#include <vector>

namespace tcs {

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
    ++robot_number;
  }
  book_.Open(std::move(clients));
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

std::optional<AnswerBook::Who> AnswerFeed::WhoIs(const Task& task) const {
  const Process* client = task.process->client;
  if (client == nullptr || client->spec == nullptr) return std::nullopt;
  std::optional<AnswerBook::Who> who = WhoIs(*client->spec);
  if (!who.has_value()) return std::nullopt;
  who->thread = task.order;
  who->is_first = !task.is_further;
  return who;
}

}  // namespace tcs
