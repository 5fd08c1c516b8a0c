#include "coordinator/calls/datagram_queues.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/un.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "coordinator/answers/unheard.h"

namespace tcs {

namespace {

using shm::DatagramNotes;

constexpr const char* kWrong = "datagrams that cannot be";
// Of one address. A receiver that lets more datagrams wait does not receive any more.
constexpr std::size_t kMostOnTheWay = 4096;
// A program that sends to ever other addresses is not followed beyond that.
constexpr std::size_t kMostAddresses = 4096;
// The kind of an address, beyond the numbers of robots.
constexpr std::uint64_t kInternet = std::uint64_t{1} << 32;

// Of an address of the internet: the host and the port.
struct Internet {
  in_addr host;
  std::uint16_t port;
  bool is_any = false;  // of all of this computer's, which the loopback interface's stands for
  bool IsMulticast() const {
    const in_addr_t address = ntohl(host.s_addr);
    return IN_MULTICAST(address) || address == INADDR_BROADCAST;
  }
};

std::optional<Internet> InternetOf(const DatagramNotes::Note& note) {
  sockaddr_in address{};
  if (note.size > sizeof address) return std::nullopt;
  memcpy(&address, note.bytes, note.size);
  if (address.sin_family != AF_INET) return std::nullopt;
  const bool is_any = address.sin_addr.s_addr == INADDR_ANY;
  if (is_any) address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return Internet{address.sin_addr, ntohs(address.sin_port), is_any};
}

// A part of a name that is another one in each run: ${run} of a scenario.
bool IsRunName(std::string_view part) {
  constexpr std::size_t kDigits = 8;
  return part.size() == kDigits &&
         part.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

// The address in words, for the label of what two programs send each other. The text is the same in
// each run, so it is without ${run} and ${loopback}.
std::string TextOf(const DatagramNotes::Note& note) {
  if (const auto internet = InternetOf(note)) {
    return "UDP port " + std::to_string(internet->port);
  }
  std::string text(reinterpret_cast<const char*>(note.bytes), note.size);
  text.erase(0, std::min(text.size(), offsetof(sockaddr_un, sun_path)));
  if (text.starts_with('\0')) text[0] = '@';
  if (const std::size_t end = text.find('/');
      end != std::string::npos && end > 0 && IsRunName(std::string_view(text).substr(1, end - 1))) {
    text.erase(1, end);
  }
  std::ranges::replace_if(
      text, [](unsigned char c) { return c == ',' || c == '"' || c < ' '; }, '_');
  return text;
}

DatagramNotes::Note NoteOf(const shm::ReceiverAddress& address) {
  return shm::NoteAbout(address.bytes, address.size);
}

}  // namespace

DatagramQueues::DatagramQueues(RunState& run, AnswerFeed& answers, DatagramLog& log)
    : run_(run), answers_(answers), log_(log) {
  for (std::size_t i = 0; i < run.scenario.sensors.size(); ++i)
    sensors_[run.scenario.sensors[i].name] = i;
}

DatagramQueues::Address DatagramQueues::AddressAt(std::uint32_t host, std::uint16_t port) {
  return {kInternet, std::uint64_t{host} << 16 | port};
}

// Addresses that mean the same are one; with a network abstract names are each robot's own.
DatagramQueues::Address DatagramQueues::AddressOf(const Robot* by,
                                                  const DatagramNotes::Note& note) const {
  if (const auto internet = InternetOf(note))
    return AddressAt(internet->host.s_addr, internet->port);
  const std::size_t begin = offsetof(sockaddr_un, sun_path);
  const bool is_abstract = note.size > begin && note.bytes[begin] == 0;
  const std::uint32_t robot =
      is_abstract && by != nullptr && run_.scenario.network ? by->number : shm::kNoRobot;
  return {robot, note.hash};
}

void DatagramQueues::AddCommandAddress(const shm::ReceiverAddress& address, std::size_t command) {
  commands_.emplace(AddressOf(nullptr, NoteOf(address)), command);
}

DatagramQueues::Queue* DatagramQueues::QueueTo(const Address& to) {
  const auto found = queues_.find(to);
  if (found != queues_.end()) return &found->second;
  return queues_.size() < kMostAddresses ? &queues_[to] : nullptr;
}

// The place where datagrams to the address are looked for. If a socket listens on all addresses of
// this computer, and none on this address alone, these datagrams are among those to any address.
DatagramQueues::Address DatagramQueues::PlaceOf(const Address& to) const {
  const auto port = static_cast<std::uint16_t>(to.second);
  if (to.first != kInternet || !ports_of_all_.contains(port)) return to;
  const auto found = queues_.find(to);
  if (found != queues_.end() && found->second.has_reader) return to;
  return AddressAt(htonl(INADDR_LOOPBACK), port);
}

// A socket listens at that port of all addresses: a datagram to any of them is that socket's.
void DatagramQueues::ListensOnAll(std::uint16_t port) {
  if (!ports_of_all_.insert(port).second) return;
  const Address place = AddressAt(htonl(INADDR_LOOPBACK), port);
  Queue* all = QueueTo(place);
  if (all == nullptr) return;
  for (auto& [address, queue] : queues_) {
    const bool is_at_port =
        address.first == kInternet && static_cast<std::uint16_t>(address.second) == port;
    if (!is_at_port || address == place || queue.has_reader) continue;
    if (all->of_programs.empty()) all->of_programs = queue.of_programs;
    for (const Flow& flow : queue.flows)
      FlowOf(*all, flow.sender, flow.channel).input.sent += flow.input.sent;
    for (Sent& sent : queue.waiting)
      sent.flow = &FlowOf(*all, sent.flow->sender, sent.flow->channel);
    std::ranges::move(queue.waiting, std::back_inserter(all->waiting));
    queue.waiting.clear();
    queue.flows.clear();
  }
  std::ranges::stable_sort(all->waiting, {}, &Sent::at);
}

DatagramQueues::Flow& DatagramQueues::FlowOf(Queue& queue, const std::string& sender,
                                             const std::string& channel) {
  for (Flow& flow : queue.flows) {
    if (flow.sender == sender && flow.channel == channel) return flow;
  }
  Flow& flow = queue.flows.emplace_back(Flow{sender, channel});
  flow.input.from = sender + " over " + channel;
  return flow;
}

DatagramQueues::Flow& DatagramQueues::FlowOfWorld(Queue& queue, const std::string& channel) {
  static const std::string kWorld = "dynamics";
  Flow& flow = FlowOf(queue, kWorld, channel);
  if (flow.sensor >= 0) return flow;
  const auto found = sensors_.find(channel);
  if (found == sensors_.end()) return flow;
  flow.sensor = static_cast<int>(found->second);
  flow.period_ns = run_.scenario.sensors[found->second].period.ns();
  flow.input.from = channel;
  return flow;
}

AnswerBook::Taken DatagramQueues::TakenOf(const Sent& sent) {
  return {.arrived_ns = sent.at.ns(),
          .sampled_ns = sent.sampled_ns,
          .period_ns = sent.flow->period_ns,
          .sensor = sent.flow->sensor};
}

void DatagramQueues::Add(Queue& queue, Sent sent) {
  if (queue.waiting.size() == kMostOnTheWay) queue.waiting.pop_front();
  ++sent.flow->input.sent;
  queue.waiting.push_back(std::move(sent));
}

void DatagramQueues::WorldSent(const std::string& channel, const shm::ReceiverAddress& to,
                               VirtualTime at) {
  Queue* queue = QueueTo(PlaceOf(AddressOf(nullptr, NoteOf(to))));
  if (queue == nullptr) return;
  Flow& flow = FlowOfWorld(*queue, channel);
  Sent sent{.at = at, .flow = &flow};
  if (flow.sensor >= 0) {
    const auto sensor = static_cast<std::size_t>(flow.sensor);
    sent.sampled_ns = (at - run_.scenario.sensors[sensor].latency).ns();
    sent.lineage = answers_.chains().Sampled(flow.sensor, sent.sampled_ns);
  }
  Add(*queue, std::move(sent));
}

void DatagramQueues::WorldReceived(std::size_t channel, const CommandSent& sent) {
  if (sent.by.id == 0) return;
  const Task* task = run_.table.Living(static_cast<pid_t>(sent.by.id));
  if (task == nullptr) return;
  log_.Write(sent.at, task->process->name, sent.at, "dynamics",
             run_.scenario.commands[channel].name);
}

// A full socket takes nothing more until it is read: the lost datagrams are those that were sent
// last before that.
void DatagramQueues::DropLost(Queue& queue, std::uint16_t drops, VirtualTime at) {
  const std::uint16_t lost = drops - std::exchange(queue.drops, drops);
  const auto later =
      std::ranges::find_if(queue.waiting, [at](const Sent& sent) { return sent.at > at; });
  const std::ptrdiff_t there = std::distance(queue.waiting.begin(), later);
  if (lost == 0 || lost >= there) return;  // or another socket has the address by now
  for (auto sent = later - lost; sent != later; ++sent) ++sent->flow->input.lost;
  queue.waiting.erase(later - lost, later);
}

// The socket was empty then: datagrams that were sent before the taken ones met nobody who
// listened.
void DatagramQueues::DropNeverThere(Queue& queue, std::uint16_t taken, VirtualTime at) {
  const auto later =
      std::ranges::find_if(queue.waiting, [at](const Sent& sent) { return sent.at > at; });
  const std::ptrdiff_t there = std::distance(queue.waiting.begin(), later);
  if (there <= taken) return;
  const auto first = queue.waiting.begin() + (there - taken);
  for (auto sent = queue.waiting.begin(); sent != first; ++sent) --sent->flow->input.sent;
  queue.waiting.erase(queue.waiting.begin(), first);
}

void DatagramQueues::TakeBack(Queue& queue, const std::string& sender) {
  const auto last =
      std::find_if(queue.waiting.rbegin(), queue.waiting.rend(),
                   [&sender](const Sent& sent) { return sent.flow->sender == sender; });
  if (last == queue.waiting.rend()) return;
  --last->flow->input.sent;
  queue.waiting.erase(std::next(last).base());
}

void DatagramQueues::Take(const Task& task, const DatagramNotes::Note& note, Queue& queue,
                          VirtualTime at) {
  DropLost(queue, note.drops, at);
  if (note.is_last != 0 && InternetOf(note)) DropNeverThere(queue, note.count, at);
  const auto who = answers_.WhoIs(task);
  if (who.has_value()) {
    queue.reader = *who;
    queue.has_reader = true;
  }
  const auto waiting =
      std::ranges::count_if(queue.waiting, [at](const Sent& sent) { return sent.at <= at; });
  for (std::uint32_t n = 0; n < note.count && !queue.waiting.empty(); ++n) {
    const Sent& sent = queue.waiting.front();
    InputFigures& input = sent.flow->input;
    ++input.received;
    input.most_waiting = std::max<std::int64_t>(input.most_waiting, waiting);
    input.age.Add((at - VirtualTime()).ns() -
                  (sent.sampled_ns >= 0 ? sent.sampled_ns : sent.at.ns()));
    if (who.has_value()) {
      AnswerBook::Taken taken = TakenOf(sent);
      taken.activation = note.activation;
      answers_.book().Took(*who, taken);
      answers_.chains().Took(AnswerFeed::OnChain(*who), sent.lineage, sent.at.ns(), at.ns());
    }
    log_.Write(sent.at, sent.flow->sender, at, task.process->name, sent.flow->channel);
    queue.waiting.pop_front();
  }
}

const char* DatagramQueues::TakeNotes(const Task& task, VirtualTime until) {
  DatagramNotes& notes = SlotOf(task).datagrams;
  const std::uint32_t count = notes.count.load();
  if (count == 0) return nullptr;
  notes.count.store(0);
  if (count > DatagramNotes::kMost) return kWrong;
  ProgramClock& clock = task.process->clock;
  const std::string& name = task.process->name;
  const auto who = answers_.WhoIs(task);
  for (std::uint32_t i = 0; i < count; ++i) {
    const DatagramNotes::Note note = notes.notes[i];
    std::atomic_signal_fence(std::memory_order_seq_cst);  // a checked value is not read again
    if (note.size > DatagramNotes::kMostBytes || note.what > DatagramNotes::What::kTaken ||
        note.count > kMostOnTheWay || note.activation > shm::Receipts::kMost) {
      return kWrong;
    }
    const VirtualTime at =
        std::clamp(clock.RobotTimeOf(OwnTime(note.time_ns)), VirtualTime(), until);
    if (note.what == DatagramNotes::What::kTaken) {
      if (samples_ != nullptr) samples_->Taken(task, note, at);
      continue;
    }
    const Address address = AddressOf(task.process->robot, note);
    const auto command = commands_.find(address);
    if (note.what == DatagramNotes::What::kSent && command != commands_.end()) {
      if (who.has_value()) {
        answers_.book().Commanded(*who, at.ns());
        answers_.chains().Commanded(AnswerFeed::OnChain(*who), static_cast<int>(command->second),
                                    at.ns());
      }
      continue;
    }
    const auto internet = InternetOf(note);
    // Between robots of a network packets may be lost.
    if (run_.scenario.network && internet) continue;
    if (internet && internet->IsMulticast()) multicast_.insert(internet->port);
    if (internet && multicast_.contains(internet->port)) continue;
    if (note.what == DatagramNotes::What::kReceived && internet && internet->is_any)
      ListensOnAll(internet->port);
    if (note.what == DatagramNotes::What::kSent) {
      Queue* queue = QueueTo(PlaceOf(address));
      if (queue == nullptr) continue;
      if (queue->of_programs.empty()) queue->of_programs = TextOf(note);
      Sent sent{.at = at,
                .sampled_ns = answers_.book().LastSampledOf(task.order),
                .flow = &FlowOf(*queue, name, queue->of_programs)};
      if (who.has_value())
        sent.lineage = answers_.chains().Sends(AnswerFeed::OnChain(*who), at.ns());
      sent.flow->is_of_dds = !task.process->dds_endpoints;
      Add(*queue, std::move(sent));
      continue;
    }
    if (note.what == DatagramNotes::What::kTakenBack) {
      const auto found = queues_.find(PlaceOf(address));
      if (found != queues_.end()) TakeBack(found->second, name);
    } else if (Queue* queue = QueueTo(address); queue != nullptr) {
      Take(task, note, *queue, at);
    }
  }
  return nullptr;
}

std::map<int, std::vector<InputFigures>> DatagramQueues::Conclude(VirtualTime end) {
  std::map<int, std::vector<InputFigures>> all;
  for (auto& [address, queue] : queues_) {
    if (!queue.has_reader) continue;
    const auto unread =
        std::ranges::count_if(queue.waiting, [end](const Sent& sent) { return sent.at <= end; });
    for (const Sent& sent : queue.waiting) {
      if (sent.at > end) continue;
      InputFigures& input = sent.flow->input;
      ++input.unread;
      input.most_waiting = std::max<std::int64_t>(input.most_waiting, unread);
      if (input.oldest_unread_ns < 0) input.oldest_unread_ns = sent.at.ns();
    }
    if (unread > 0 && queue.waiting.front().at < end) {
      answers_.book().NeverCameTo(queue.reader, TakenOf(queue.waiting.front()), end.ns());
    }
    std::ranges::sort(queue.flows, {},
                      [](const Flow& flow) { return std::tie(flow.sender, flow.channel); });
    for (const Flow& flow : queue.flows) all[queue.reader.client].push_back(flow.input);
  }
  return all;
}

std::vector<std::string> DatagramQueues::WhatNobodyHeard() const {
  std::vector<Unheard> unheard;
  std::vector<Heard> heard;
  const std::vector<std::string> names = answers_.NamesOfClients();
  for (const auto& [address, queue] : queues_) {
    const auto port = static_cast<std::uint16_t>(address.second);
    const bool is_elsewhere =  // or may be
        address.first == kInternet &&
        (ntohl(static_cast<std::uint32_t>(address.second >> 16)) >> IN_CLASSA_NSHIFT !=
             IN_LOOPBACKNET ||
         multicast_.contains(port));
    for (const Flow& flow : queue.flows) {
      // World::UnheardSensors warns of datagrams that the world sends to nobody.
      if (!answers_.WhoIs(flow.sender).has_value()) continue;
      if (queue.has_reader) {
        heard.push_back({names[static_cast<std::size_t>(queue.reader.client)], flow.channel});
        break;
      }
      if (is_elsewhere || flow.is_of_dds) continue;
      if (flow.input.sent > 0) unheard.push_back({flow.sender, flow.channel, flow.input.sent});
    }
  }
  return SentencesOn(unheard, heard);
}

}  // namespace tcs
