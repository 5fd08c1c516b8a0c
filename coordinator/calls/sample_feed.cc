#include "coordinator/calls/sample_feed.h"

#include <algorithm>
#include <cstddef>
#include <variant>

namespace tcs {

namespace {

// Of one client. A client whose reader lets more samples wait keeps only the last ones.
constexpr std::size_t kMostWaiting = 4096;

std::map<std::string, int> CommandsByTopic(const Scenario& scenario) {
  std::map<std::string, int> commands;
  for (std::size_t i = 0; i < scenario.commands.size(); ++i) {
    if (const auto* from = std::get_if<DdsCommandEnd>(&scenario.commands[i].from))
      commands[from->end.topic] = static_cast<int>(i);
  }
  return commands;
}

}  // namespace

SampleFeed::SampleFeed(RunState& run, AnswerFeed& answers, const dds::TopicLog& topics, NameOf name)
    : run_(run),
      answers_(answers),
      topics_(topics),
      name_(std::move(name)),
      commanded_(CommandsByTopic(run.scenario)) {}

// When the sample was sent, on the world's clock.
std::int64_t SampleFeed::SentAt(const dds::TopicLog::Delivery& delivery) const {
  // The world keeps the date that it began with.
  const std::int64_t now_ns = run_.header->realtime_offset_ns;
  const std::int64_t offset_ns =
      delivery.from == 0 ? run_.first_realtime_offset_ns.value_or(now_ns) : now_ns;
  return delivery.source_timestamp_ns - offset_ns;
}

// A number is never given to another process.
const std::optional<AnswerBook::Who>& SampleFeed::WhoIs(dds::Hub::Number number) {
  const auto [who, is_new] = clients_.try_emplace(number);
  if (is_new) who->second = answers_.WhoIs(name_(number));
  return who->second;
}

SampleFeed::Sample SampleFeed::SampleOf(const dds::TopicLog::Delivery& delivery) {
  const std::string& topic = topics_.reports()[delivery.topic].topic;
  Sample sample{.topic = delivery.topic,
                .source_ns = delivery.source_timestamp_ns,
                .arrived_ns = delivery.sent_ns,
                .from = topic};
  if (delivery.from != 0) {
    sample.from = name_(delivery.from) + " over " + topic;
    sample.lineage = LineageFrom(delivery);
    return sample;
  }
  for (std::size_t i = 0; i < run_.scenario.sensors.size(); ++i) {
    const SensorChannelSpec& sensor = run_.scenario.sensors[i];
    const auto* to = std::get_if<DdsSensorEnd>(&sensor.to);
    if (to == nullptr || to->end.topic != topic) continue;
    sample.sampled_ns = SentAt(delivery);
    sample.lineage = answers_.chains().Sampled(static_cast<int>(i), sample.sampled_ns);
    sample.period_ns = sensor.period.ns();
    sample.sensor = static_cast<int>(i);
    sample.from = sensor.name;
  }
  return sample;
}

// Of a sample that a late reader gets the sender is no longer at what it was made of.
Lineage SampleFeed::LineageFrom(const dds::TopicLog::Delivery& delivery) {
  const auto found = on_the_way_.find(delivery.from);
  if (found == on_the_way_.end()) return {};
  const auto& sent = found->second;
  const auto it = std::find_if(sent.rbegin(), sent.rend(), [&](const OnTheWay& one) {
    return one.topic == delivery.topic && one.source_ns == delivery.source_timestamp_ns;
  });
  return it == sent.rend() ? Lineage{} : it->lineage;
}

void SampleFeed::Sent(const dds::TopicLog::Delivery& sample) {
  if (sample.from == 0) return;
  if (sample.to == 0) return Commanded(sample);
  const auto sender = SenderOf(sample);
  if (!sender.has_value()) return;
  auto& sent = on_the_way_[sample.from];
  if (sent.size() == kMostWaiting) sent.pop_front();
  sent.push_back({sample.topic, sample.source_timestamp_ns,
                  answers_.chains().Sends(AnswerFeed::OnChain(*sender), SentAt(sample))});
}

void SampleFeed::Delivered(const dds::TopicLog::Delivery& delivery) {
  if (delivery.to == 0) return;
  const auto who = WhoIs(delivery.to);
  if (!who.has_value()) return;
  Receiver& receiver = receivers_[who->client];
  if (receiver.waiting.size() == kMostWaiting) receiver.waiting.pop_front();
  const Sample& sample = receiver.waiting.emplace_back(SampleOf(delivery));
  InputFigures& input = receiver.inputs[sample.from];
  input.from = sample.from;
  ++input.sent;
}

std::optional<AnswerBook::Who> SampleFeed::SenderOf(const dds::TopicLog::Delivery& sample) {
  const std::optional<AnswerBook::Who> client = WhoIs(sample.from);
  if (!client.has_value()) return client;
  // The gateway's commands, which count as its second client, are made of what came by sockets.
  if (answers_.IsOurs(client->client)) return AnswerBook::Who{.client = client->client + 1};
  const auto sender = sender_ == nullptr ? std::nullopt : answers_.WhoIs(*sender_);
  if (sender.has_value() && answers_.book().LastSampledOf(sender->thread) >= 0) return sender;
  // What a thread sends that takes no samples of sensors is made of what another one took.
  if (const auto found = receivers_.find(client->client);
      found != receivers_.end() && found->second.last.has_value()) {
    return found->second.last;
  }
  return sender.has_value() ? sender : client;
}

void SampleFeed::Commanded(const dds::TopicLog::Delivery& delivery) {
  const auto command = commanded_.find(topics_.reports()[delivery.topic].topic);
  if (command == commanded_.end()) return;
  const auto who = SenderOf(delivery);
  if (!who.has_value()) return;
  answers_.book().Commanded(*who, SentAt(delivery));
  answers_.chains().Commanded(AnswerFeed::OnChain(*who), command->second, SentAt(delivery));
}

std::optional<SampleFeed::Topic> SampleFeed::TopicOf(std::pair<std::uint32_t, std::int32_t> reader,
                                                     const Receiver& receiver,
                                                     std::int64_t newest_ns) {
  if (const auto known = readers_.find(reader); known != readers_.end()) return known->second;
  std::optional<Topic> found;
  for (const Sample& sample : receiver.waiting) {
    if (sample.source_ns != newest_ns) continue;
    if (found.has_value() && *found != sample.topic) return found;  // not certain
    found = sample.topic;
  }
  if (found.has_value()) readers_[reader] = *found;
  return found;
}

void SampleFeed::Taken(const Task& task, const shm::DatagramNotes::Note& note, VirtualTime at) {
  const auto who = answers_.WhoIs(task);
  if (!who.has_value()) return;
  const shm::TakenSamples taken = shm::SamplesOf(note);
  Receiver& receiver = receivers_[who->client];
  receiver.last = who;
  const auto topic = TopicOf({task.process->index, taken.reader}, receiver, taken.newest_ns);
  if (!topic.has_value()) return;
  const auto is_past = [&](const Sample& sample) {
    return sample.topic == *topic && sample.source_ns <= taken.newest_ns;
  };
  const auto waiting = std::ranges::count_if(receiver.waiting, is_past);
  AnswerBook::Taken all{.arrived_ns = INT64_MAX, .activation = note.activation};
  for (const Sample& sample : receiver.waiting) {
    if (!is_past(sample)) continue;
    InputFigures& input = receiver.inputs[sample.from];
    input.most_waiting = std::max<std::int64_t>(input.most_waiting, waiting);
    if (sample.source_ns < taken.oldest_ns) {
      ++input.replaced;
      continue;
    }
    ++input.received;
    input.age.Add(at.ns() - (sample.sampled_ns >= 0 ? sample.sampled_ns : sample.arrived_ns));
    all.arrived_ns = std::min(all.arrived_ns, sample.arrived_ns);
    answers_.chains().Took(AnswerFeed::OnChain(*who), sample.lineage, sample.arrived_ns, at.ns());
    all.sampled_ns = std::max(all.sampled_ns, sample.sampled_ns);
    all.period_ns = sample.period_ns;
    all.sensor = sample.sensor;
  }
  if (all.arrived_ns != INT64_MAX) answers_.book().Took(*who, all);
  std::erase_if(receiver.waiting, is_past);
}

std::map<int, std::vector<InputFigures>> SampleFeed::Conclude() const {
  std::map<int, std::vector<InputFigures>> all;
  for (const auto& [client, receiver] : receivers_) {
    for (const auto& [from, input] : receiver.inputs) all[client].push_back(input);
  }
  return all;
}

}  // namespace tcs
