// `chains` of a scenario file: how old samples may be when commands act.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/sections.h"

namespace tcs {
namespace {

constexpr std::string_view kArrow = "->";

// The place of the channel that is called `name` among `channels`.
template <class Channels>
std::size_t FindChannel(const YamlValue& value, const std::string& name, const Channels& channels,
                        const char* what) {
  std::vector<std::string> known;
  for (const auto& channel : channels) known.push_back(channel.name);
  const auto found = std::ranges::find(known, name);
  if (found == known.end()) {
    value.FailAbout(
        name, "begins or ends at '" + name + "', which is no channel of " + what + "; " +
                  (known.empty() ? std::string("there is none") : Suggest(name, known, what)));
  }
  return static_cast<std::size_t>(found - known.begin());
}

std::vector<std::string> LoadThrough(const YamlValue& value, const Scenario& scenario) {
  std::vector<std::string> known;
  for (const RobotSpec& robot : scenario.robots) {
    for (const ClientSpec& client : robot.clients) known.push_back(client.name);
  }
  std::vector<std::string> through;
  for (const YamlValue& one : value.AsList("[robot/detector, robot/controller]")) {
    const std::string name = one.AsText();
    if (std::ranges::find(known, name) == known.end())
      one.Fail("is '" + name + "', which is no client; " + Suggest(name, known, "clients"));
    through.push_back(name);
  }
  return through;
}

// "lidar->wheels", or any name with `from` and `to`.
ChainSpec LoadChain(const YamlMap::Entry& entry, const Scenario& scenario) {
  const YamlMap map = entry.value.AsMap();
  const std::size_t arrow = entry.key.find(kArrow);
  std::vector<std::string> keys = {"deadline", "through"};
  if (arrow == std::string::npos) keys.insert(keys.begin(), {"from", "to"});
  map.AllowOnly(keys);
  ChainSpec chain{.name = entry.key};
  std::string from = entry.key.substr(0, arrow), to;
  if (arrow == std::string::npos) {
    CheckName(entry);
    from = map.Require("from", "from: lidar").AsText();
    to = map.Require("to", "to: wheels").AsText();
  } else {
    to = entry.key.substr(arrow + kArrow.size());
  }
  chain.sensor = FindChannel(entry.value, from, scenario.sensors, "sensors");
  chain.command = FindChannel(entry.value, to, scenario.commands, "commands");
  if (const YamlValue* through = map.Find("through"))
    chain.through = LoadThrough(*through, scenario);
  if (const YamlValue* deadline = map.Find("deadline"))
    chain.deadline = deadline->AsPositiveDuration();
  return chain;
}

}  // namespace

void LoadChains(const YamlMap& top, Scenario* scenario) {
  const YamlValue* chains = top.Find("chains");
  if (chains == nullptr) return;
  chains->AsMap().ForEach([&](const YamlMap::Entry& entry) {
    scenario->chains.push_back(LoadChain(entry, *scenario));
  });
}

}  // namespace tcs
