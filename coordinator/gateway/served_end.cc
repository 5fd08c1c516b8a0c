#include "coordinator/gateway/served_end.h"

#include <cstdint>
#include <sstream>
#include <string_view>

namespace tcs::gateway {
namespace {

constexpr std::string_view kNothing = "-";

std::string WordOf(const std::optional<VirtualDuration>& duration) {
  return duration ? std::to_string(duration->ns()) : std::string(kNothing);
}

std::optional<VirtualDuration> DurationIn(const std::string& word) {
  if (word == kNothing) return std::nullopt;
  return VirtualDuration::Nanoseconds(std::strtoll(word.c_str(), nullptr, 10));
}

}  // namespace

// No name in `end` has a space.
std::string ToText(const ServedEnd& end) {
  std::ostringstream text;
  const dds::Qos& qos = end.qos;
  text << (end.is_sensor ? "sensor" : "command") << ' ' << end.domain << ' ' << end.topic << ' '
       << end.type << ' ' << static_cast<int>(qos.reliability) << ' '
       << static_cast<int>(qos.history) << ' ' << qos.depth << ' '
       << static_cast<int>(qos.durability) << ' ' << static_cast<int>(qos.liveliness) << ' '
       << WordOf(qos.deadline) << ' ' << WordOf(qos.lifespan) << ' ' << WordOf(qos.lease) << ' '
       << (end.user_data.empty() ? kNothing : end.user_data) << ' ' << end.name_space;
  return text.str();
}

std::optional<ServedEnd> FromText(const std::string& text) {
  std::istringstream words(text);
  ServedEnd end;
  std::string direction, deadline, lifespan, lease;
  int reliability = 0, history = 0, durability = 0, liveliness = 0;
  words >> direction >> end.domain >> end.topic >> end.type >> reliability >> history >>
      end.qos.depth >> durability >> liveliness >> deadline >> lifespan >> lease >> end.user_data >>
      end.name_space;
  if (!words || (direction != "sensor" && direction != "command")) return std::nullopt;
  end.is_sensor = direction == "sensor";
  end.qos.reliability = static_cast<dds::Reliability>(reliability);
  end.qos.history = static_cast<dds::History>(history);
  end.qos.durability = static_cast<dds::Durability>(durability);
  end.qos.liveliness = static_cast<dds::Liveliness>(liveliness);
  end.qos.deadline = DurationIn(deadline);
  end.qos.lifespan = DurationIn(lifespan);
  end.qos.lease = DurationIn(lease);
  if (end.user_data == kNothing) end.user_data.clear();
  return end;
}

}  // namespace tcs::gateway
