#include "coordinator/calls/datagram_log.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/un.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace tcs {

namespace {

using shm::DatagramNotes;

constexpr const char* kWrong = "datagrams that cannot be";
// Of one address. Who lets more wait does not receive any more.
constexpr std::size_t kMostOnTheWay = 4096;

// Of an address of the internet: the host and the port.
struct Internet {
  in_addr host;
  std::uint16_t port;
};

std::optional<Internet> InternetOf(const DatagramNotes::Note& note) {
  sockaddr_in address{};
  if (note.size > sizeof address) return std::nullopt;
  memcpy(&address, note.bytes, note.size);
  if (address.sin_family != AF_INET) return std::nullopt;
  // Whoever listens on all addresses is reached by this one.
  if (address.sin_addr.s_addr == INADDR_ANY) address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return Internet{address.sin_addr, ntohs(address.sin_port)};
}

// A part of a name that is another one in each run: ${run} of a scenario.
bool IsRunName(std::string_view part) {
  constexpr std::size_t kDigits = 8;
  return part.size() == kDigits &&
         part.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

// In words, for the label of what two programs send each other; the same in each run, so without
// ${run} and ${loopback}.
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

void DatagramLog::Open() {
  std::error_code ignored;
  std::filesystem::remove(run_.options.output_directory + "/datagrams.csv", ignored);
}

// Addresses that mean the same are one; with a network abstract names are each robot's own.
DatagramLog::Address DatagramLog::AddressOf(const Robot* by,
                                            const DatagramNotes::Note& note) const {
  std::string address;
  if (const auto internet = InternetOf(note)) {
    address.append(reinterpret_cast<const char*>(&internet->host), sizeof internet->host);
    return address + std::to_string(internet->port);
  }
  const std::size_t begin = offsetof(sockaddr_un, sun_path);
  const bool is_abstract = note.size > begin && note.bytes[begin] == 0;
  const std::uint32_t robot =
      is_abstract && by != nullptr && run_.scenario.network ? by->number : shm::kNoRobot;
  return std::to_string(robot) + " " + std::to_string(note.hash);
}

void DatagramLog::Add(const Address& to, Sent sent) {
  std::deque<Sent>& waiting = on_the_way_[to];
  if (waiting.size() == kMostOnTheWay) waiting.pop_front();
  waiting.push_back(std::move(sent));
}

void DatagramLog::WorldSent(const std::string& channel, const shm::ReceiverAddress& to,
                            VirtualTime at) {
  Add(AddressOf(nullptr, NoteOf(to)), {at, "dynamics", channel});
}

void DatagramLog::WorldReceived(std::size_t channel, const CommandSent& sent) {
  if (sent.by.id == 0) return;
  const Task* task = run_.table.Living(static_cast<pid_t>(sent.by.id));
  if (task == nullptr) return;
  Write({sent.at, task->process->name, run_.scenario.commands[channel].name}, sent.at, "dynamics");
}

const char* DatagramLog::TakeNotes(const Task& task) {
  DatagramNotes& notes = SlotOf(task).datagrams;
  const std::uint32_t count = notes.count.load();
  if (count == 0) return nullptr;
  notes.count.store(0);
  if (count > DatagramNotes::kMost) return kWrong;
  ProgramClock& clock = task.process->clock;
  const std::string& name = task.process->name;
  for (std::uint32_t i = 0; i < count; ++i) {
    const DatagramNotes::Note note = notes.notes[i];
    std::atomic_signal_fence(std::memory_order_seq_cst);  // what is checked is not read again
    if (note.size > DatagramNotes::kMostBytes || note.what > DatagramNotes::What::kTakenBack ||
        note.count > kMostOnTheWay) {
      return kWrong;
    }
    const VirtualTime at =
        std::clamp(clock.RobotTimeOf(OwnTime(note.time_ns)), VirtualTime(), task.cpu->progress);
    // Between robots of a network packets may be lost.
    if (run_.scenario.network && InternetOf(note)) continue;
    const Address address = AddressOf(task.process->robot, note);
    if (note.what == DatagramNotes::What::kSent) {
      Add(address, {at, name, TextOf(note)});
      continue;
    }
    const auto found = on_the_way_.find(address);
    if (found == on_the_way_.end()) continue;
    std::deque<Sent>& waiting = found->second;
    if (note.what == DatagramNotes::What::kTakenBack) {
      const auto last = std::find_if(waiting.rbegin(), waiting.rend(),
                                     [&name](const Sent& sent) { return sent.sender == name; });
      if (last != waiting.rend()) waiting.erase(std::next(last).base());
      continue;
    }
    for (std::uint32_t n = 0; n < note.count && !waiting.empty(); ++n) {
      Write(waiting.front(), at, name);
      waiting.pop_front();
    }
  }
  return nullptr;
}

void DatagramLog::Write(const Sent& sent, VirtualTime received, const std::string& receiver) {
  if (!file_.is_open()) {
    if (!failure_.empty()) return;
    failure_ = file_.Open(run_.options.output_directory + "/datagrams.csv",
                          "sent_ns,sender,received_ns,receiver,channel");
    if (!failure_.empty()) return;
  }
  file_.Line(sent.at.ns(), sent.sender, std::max(sent.at, received).ns(), receiver, sent.channel);
}

std::string DatagramLog::Close() {
  std::string error = file_.Close();
  return failure_.empty() ? error : failure_;
}

}  // namespace tcs
