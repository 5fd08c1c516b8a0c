#include "coordinator/core/command_input.h"

#include <fmt/format.h>

namespace tcs {

void CommandInput::Refused(const std::string& channel, const std::string& why) {
  if (++counts_[channel].refused == 1) warn_("channel " + channel + ": " + why);
}

std::vector<std::string> CommandInput::Complaints(const Scenario& scenario) const {
  std::vector<std::string> complaints;
  const auto look = [&](const std::string& channel, int body, const std::string& where,
                        const std::string& mend) {
    const auto found = counts_.find(channel);
    const Counts counts = found == counts_.end() ? Counts{} : found->second;
    if (counts.taken + counts.refused == 0) {
      complaints.push_back(fmt::format(
          "channel {}: nothing came in {}, so that no command moved {}; let a client {}", channel,
          where, scenario.world->bodies[static_cast<std::size_t>(body)].name, mend));
    } else if (counts.refused > 1) {
      complaints.push_back(
          fmt::format("channel {}: {} of the {} messages that came in were no commands", channel,
                      counts.refused, counts.taken + counts.refused));
    }
  };
  for (const CommandChannelSpec& spec : scenario.commands) {
    look(spec.name, spec.body, fmt::format("on {}:{}", spec.listen.host, spec.listen.port),
         "send its commands there");
  }
  for (const DdsCommandSpec& spec : scenario.dds_commands) {
    look(spec.name, spec.body, "on " + spec.end.topic,
         fmt::format("write {} there", dds::NameOf(spec.message)));
  }
  return complaints;
}

}  // namespace tcs
