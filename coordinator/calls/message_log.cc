#include "coordinator/calls/message_log.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace tcs {
namespace {

// Names that are not ROS 2's may be anything.
std::string AsField(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c == ',' || c == '"' || c < ' '; }, '_');
  return name;
}

// The DDS topics that move the world.
std::set<std::string> CommandedTopics(const Scenario& scenario) {
  std::set<std::string> topics;
  for (const CommandChannelSpec& command : scenario.commands) {
    if (const auto* from = std::get_if<DdsCommandEnd>(&command.from))
      topics.insert(from->end.topic);
  }
  return topics;
}

}  // namespace

MessageLog::MessageLog(std::string folder, const Scenario& scenario, const dds::TopicLog& topics,
                       NameOf name, std::int64_t realtime_offset_ns)
    : path_(std::move(folder) + "/messages.csv"),
      topics_(topics),
      name_(std::move(name)),
      realtime_offset_ns_(realtime_offset_ns),
      commanded_(CommandedTopics(scenario)) {}

// A number is never given to another process. The world is called as in the schedule.
const std::string& MessageLog::NameOfProcess(dds::Hub::Number number) {
  const auto [name, is_new] = names_.try_emplace(number);
  if (is_new) name->second = number == 0 ? "dynamics" : AsField(name_(number));
  return name->second;
}

void MessageLog::Delivered(const dds::TopicLog::Delivery& delivery) {
  const std::string& topic = topics_.reports()[delivery.topic].topic;
  if (delivery.to == 0 && !commanded_.contains(topic)) return;
  if (!file_.is_open()) {
    if (!failure_.empty()) return;
    failure_ = file_.Open(path_, "sent_ns,sender,received_ns,receiver,topic");
    if (!failure_.empty()) return;
  }
  // The world has seen what a message says earlier than it sends the message.
  const std::int64_t sent_ns =
      delivery.from == 0 ? delivery.source_timestamp_ns - realtime_offset_ns_ : delivery.sent_ns;
  file_.Line(sent_ns, NameOfProcess(delivery.from), delivery.received_ns,
             NameOfProcess(delivery.to), AsField(topic));
}

std::string MessageLog::Close() {
  std::string error = file_.Close();
  return failure_.empty() ? error : failure_;
}

}  // namespace tcs
