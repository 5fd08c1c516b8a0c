#include "coordinator/record/message_definitions.h"

#include <algorithm>
#include <set>
#include <span>

#include "coordinator/dds/message_fields.h"

namespace tcs::record {
namespace {

using dds::MessageFields;

const MessageFields* Find(std::string_view type) {
  const std::span<const MessageFields> known = dds::KnownMessages();
  const auto found = std::ranges::find(known, type, &MessageFields::type);
  return found == known.end() ? nullptr : &*found;
}

// The messages that a message's fields are of, in alphabetical order, as rosbag2 has them.
std::set<std::string> PartsOf(const MessageFields& message) {
  const std::string package(message.type.substr(0, message.type.find('/') + 1));
  std::set<std::string> parts;
  for (std::string_view rest = message.text; !rest.empty();) {
    const std::string name(rest.substr(0, rest.find_first_of(" [")));
    rest.remove_prefix(rest.find('\n') + 1);
    for (const std::string& type : {package + name, name}) {
      if (Find(type) != nullptr) parts.insert(type);
    }
  }
  return parts;
}

void Append(const MessageFields& message, std::set<std::string>* written, std::string* text) {
  *text += message.text;
  for (const std::string& part : PartsOf(message)) {
    if (!written->insert(part).second) continue;
    *text += '\n' + std::string(80, '=') + "\nMSG: " + part + '\n';
    Append(*Find(part), written, text);
  }
}

}  // namespace

std::string DefinitionOf(std::string_view type, dds::RosRelease release) {
  constexpr std::string_view kFolder = "/msg/";
  const std::size_t at = type.find(kFolder);
  if (at == std::string_view::npos) return {};
  const std::string name =
      std::string(type.substr(0, at + 1)) + std::string(type.substr(at + kFolder.size()));
  const MessageFields* message = Find(name);
  std::string text;
  std::set<std::string> written;
  if (message != nullptr) Append(*message, &written, &text);
  // The field that Iron added.
  constexpr std::string_view kVariance = "float32 variance\n";
  if (name == "sensor_msgs/Range" && release == dds::RosRelease::kHumble) {
    text.erase(text.find(kVariance), kVariance.size());
  }
  return text;
}

}  // namespace tcs::record
