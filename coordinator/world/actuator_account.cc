#include "coordinator/world/actuator_account.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tcs {
namespace {

std::string Times(std::int64_t count) {
  return count == 1 ? "once" : count == 2 ? "twice" : fmt::format("{} times", count);
}

bool HasComputedBetween(const CommandSender& one, const CommandSender& next) {
  return one.id == next.id && one.ran_ns != next.ran_ns;
}

}  // namespace

std::size_t ActuatorAccount::Add(const std::string& name, const std::string& channel) {
  const auto known = std::ranges::find(actuators_, name, &Actuator::name);
  if (known == actuators_.end()) {
    actuators_.push_back({.name = name, .channels = {channel}, .asked = {}, .given = {}});
    return actuators_.size() - 1;
  }
  known->channels.push_back(channel);
  return static_cast<std::size_t>(known - actuators_.begin());
}

void ActuatorAccount::Take(std::size_t index, VirtualTime at, const CommandSender& by) {
  Actuator& actuator = actuators_[index];
  const bool is_again =
      actuator.commands++ > 0 && actuator.last == at && !HasComputedBetween(actuator.last_by, by);
  if (is_again && actuator.again++ == 0) actuator.first_again = at;
  actuator.last = at;
  actuator.last_by = by;
}

void ActuatorAccount::TakeBeyond(std::size_t index, VirtualTime at, const std::string& asked,
                                 const std::string& given) {
  Actuator& actuator = actuators_[index];
  if (actuator.beyond++ > 0) return;
  actuator.first_beyond = at;
  actuator.asked = asked;
  actuator.given = given;
}

bool ActuatorAccount::IsForgotten(const Actuator& actuator) const {
  if (actuator.commands > 0) return false;
  return std::ranges::any_of(actuators_, [&](const Actuator& other) {
    return other.commands > 0 &&
           std::ranges::find_first_of(other.channels, actuator.channels) != other.channels.end();
  });
}

std::vector<std::string> ActuatorAccount::Complaints() const {
  std::vector<std::string> sentences;
  for (const Actuator& actuator : actuators_) {
    if (IsForgotten(actuator)) {
      sentences.push_back(fmt::format("{} was never commanded, though others of channel {} were",
                                      actuator.name, fmt::join(actuator.channels, " and ")));
    }
    if (actuator.again > 0) {
      sentences.push_back(
          fmt::format("{} was commanded {} at an instant for which it already had a command, first "
                      "at {:.9g} s (channel {}); the last command acted",
                      actuator.name, Times(actuator.again), actuator.first_again.seconds(),
                      fmt::join(actuator.channels, " and ")));
    }
    if (actuator.beyond > 0) {
      sentences.push_back(fmt::format(
          "{} was commanded {} beyond its limit, first at {:.9g} s: {}, of which it got {}",
          actuator.name, Times(actuator.beyond), actuator.first_beyond.seconds(), actuator.asked,
          actuator.given));
    }
  }
  return sentences;
}

}  // namespace tcs
