// Which datagrams reached whom, and when: datagrams.csv of a run that is recorded, a line for each
// UDP or UNIX datagram of a channel or between two programs. Datagrams of one address are received
// in the order in which they were sent there; that is how the ends are told.
//
// The file is made with the first line. For the coordinator's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "coordinator/channel/datagram_watch.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/trace/csv_file.h"

namespace tcs {

class DatagramLog final : public DatagramWatch {
 public:
  explicit DatagramLog(RunState& run) : run_(run) {}

  // What an earlier run has left is removed.
  void Open();
  void WorldSent(const std::string& channel, const shm::ReceiverAddress& to,
                 VirtualTime at) override;
  void WorldReceived(std::size_t channel, const CommandSent& sent) override;
  // What the thread, which has stopped, has noted. Null; or what of it cannot be, as SlotCheck has
  // it.
  const char* TakeNotes(const Task& task);

  void Flush() { file_.Flush(); }
  // Empty on success, else one sentence.
  [[nodiscard]] std::string Close();

 private:
  struct Sent {
    VirtualTime at;
    std::string sender, channel;
  };
  using Address = std::string;
  Address AddressOf(const Robot* by, const shm::DatagramNotes::Note& note) const;
  void Add(const Address& to, Sent sent);
  void Write(const Sent& sent, VirtualTime received, const std::string& receiver);

  RunState& run_;
  std::map<Address, std::deque<Sent>> on_the_way_;
  CsvFile file_;
  std::string failure_;
};

}  // namespace tcs
