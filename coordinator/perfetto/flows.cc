#include "coordinator/perfetto/flows.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <utility>
#include <variant>

#include "coordinator/report/read_said.h"
#include "coordinator/text/csv.h"

namespace tcs::perfetto {

namespace {

// The most arrows of datagrams: as many as some seconds of a swarm have.
constexpr std::int64_t kMostDatagrams = 200'000;

std::string AddFile(const std::string& path, std::string_view topic_column, std::int64_t most,
                    const Schedule& schedule, int group, EventWriter* events) {
  const auto read = ReadCsv(
      path, {"sent_ns", "sender", "received_ns", "receiver", topic_column},
      [&](const CsvFields& fields) {
        if (most-- <= 0) return true;
        const auto sent_ns = ToInteger(fields[0]), received_ns = ToInteger(fields[2]);
        if (!sent_ns || !received_ns || *sent_ns < 0 || *sent_ns > *received_ns) return false;
        const std::string sender(fields[1]), receiver(fields[3]), topic(fields[4]);
        const std::string age =
            fmt::format("{}", static_cast<double>(*received_ns - *sent_ns) * 1e-6);
        const std::array values = {std::pair<std::string_view, std::string_view>("age (ms)", age)};
        events->Counter(group, topic + " at " + receiver, *received_ns, values);
        // A thread sends where its slice ends, and is given a message where one begins.
        const Row* from = schedule.ThatStopped(sender, *sent_ns);
        const Row* to = schedule.ThatBegan(receiver, *received_ns);
        if (from == nullptr || to == nullptr) return true;
        events->Flow({*from, "send " + topic, *sent_ns}, {*to, "receive " + topic, *received_ns});
        return true;
      });
  const auto* error = std::get_if<LoadError>(&read);
  return error == nullptr ? "" : error->message;
}

}  // namespace

std::string AddMessages(const std::string& folder, const Schedule& schedule, EventWriter* events) {
  const std::string messages = folder + "/messages.csv", datagrams = folder + "/datagrams.csv";
  const bool has_messages = IsFile(messages), has_datagrams = IsFile(datagrams);
  if (!has_messages && !has_datagrams) return {};
  const int group = events->AddGroup("age of messages when they are received");
  std::string error;
  if (has_messages) error = AddFile(messages, "topic", INT64_MAX, schedule, group, events);
  if (error.empty() && has_datagrams) {
    error = AddFile(datagrams, "channel", kMostDatagrams, schedule, group, events);
  }
  return error;
}

void AddOutput(const std::string& folder, const Schedule& schedule, EventWriter* events) {
  report::Replay replay;
  report::ReadSaid(folder, &replay);
  for (const report::Said& line : replay.said) {
    const Row* row = schedule.Find(line.client);
    if (row != nullptr) events->Instant(*row, line.text, line.time_us * 1000);
  }
}

}  // namespace tcs::perfetto
