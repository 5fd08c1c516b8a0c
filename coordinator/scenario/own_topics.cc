#include "coordinator/scenario/own_topics.h"

#include <algorithm>
#include <vector>

namespace tcs {
namespace {

constexpr std::size_t kMostNames = 4;

}  // namespace

std::string NamesOfOwnTopics(const Scenario& scenario) {
  std::vector<std::string> names;
  const auto add = [&names](const DdsTopicSpec& end) {
    if (std::find(names.begin(), names.end(), end.topic) == names.end()) names.push_back(end.topic);
  };
  for (const SensorChannelSpec& sensor : scenario.sensors) {
    if (const auto* topic = std::get_if<DdsSensorEnd>(&sensor.to)) add(topic->end);
  }
  for (const CommandChannelSpec& command : scenario.commands) {
    if (const auto* topic = std::get_if<DdsCommandEnd>(&command.from)) add(topic->end);
  }
  if (scenario.clock.has_value()) add(scenario.clock->end);
  if (names.size() > kMostNames) {
    const std::size_t more = names.size() - (kMostNames - 1);
    names.resize(kMostNames - 1);
    names.push_back(std::to_string(more) + " more");
  }
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " and ";
    text += names[i];
  }
  return text;
}

}  // namespace tcs
