// From sensors over programs to actuators: which samples a command can know of, and how old they
// were when it acted. A thread knows of the newest sample of each sensor that it has taken, from
// the sensor or in a message of a thread that knew of it. A thread that has taken nothing knows
// what its client knows. Fed with messages; pure. Times are virtual nanoseconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/answers/chain_figures.h"
#include "coordinator/answers/lineage.h"

namespace tcs {

class ChainBook {
 public:
  struct Sensor {
    std::string name;
    std::int64_t period_ns = 0;
  };
  struct Command {
    std::string name;
    std::int64_t latency_ns = 0;
  };
  // A chain that the scenario names.
  struct Chain {
    std::string name;
    int sensor = 0, command = 0;
    std::vector<int> through;  // clients; empty: by any way
    std::int64_t deadline_ns = 0;
  };
  struct Who {
    int thread = -1;  // as AnswerBook::Who has it
    int client = 0;
  };

  // The numbers of clients, sensors, commands and chains are places in these lists.
  void Open(std::vector<std::string> clients, std::vector<Sensor> sensors,
            std::vector<Command> commands, std::vector<Chain> chains);

  // The lineage of a message from the world: the sensor's sample of that time.
  Lineage Sampled(int sensor, std::int64_t sampled_ns) const;
  // The lineage of a message that the thread sends.
  Lineage Sends(const Who& who, std::int64_t at_ns);
  // The thread takes a message, which was there from `arrived_ns` on.
  void Took(const Who& who, const Lineage& lineage, std::int64_t arrived_ns, std::int64_t at_ns);
  void Commanded(const Who& who, int command, std::int64_t at_ns);
  // The thread's knowledge is dropped; its client's stays.
  void Dies(int thread);

  // The run is over. The result has the chains on which commands came, and those that the scenario
  // names.
  std::vector<ChainFigures> Conclude() const;

 private:
  static constexpr std::size_t kMostWorst = 5;
  // More programs than on any way that does not go round in circles.
  static constexpr int kMostSteps = 16;

  // A sample as a thread knows it, with the time at which the thread took it.
  struct Had {
    KnownSample sample;
    std::int64_t arrived_ns = 0, took_ns = 0;
    std::int64_t first_ns = -1;  // when the thread first sent something then; -1: not yet
  };
  // In order, without duplicates: the entries are few, and looked at for each message.
  using Knows = std::vector<std::pair<LineageOf, Had>>;
  struct Kept {
    ChainFigures figures;
    std::int64_t last_sampled_ns = -1;
    std::map<std::vector<int>, std::int64_t> paths;  // how many commands came on each
    std::pair<const std::vector<int>, std::int64_t>* newest = nullptr;  // of `paths`; null: none
  };

  static Had& HadOf(Knows& knows, const LineageOf& of);
  // The knowledge of the thread, or of its client, from which the thread sends at that time.
  Knows& UsedBy(const Who& who, std::int64_t at_ns);
  void Count(const LineageOf& of, const Had& had, int client, int command, std::int64_t at_ns);
  ChainCase CaseOf(const LineageOf& of, const Had& had, int client, int command,
                   std::int64_t at_ns) const;
  const std::string& NameOf(int client) const;

  std::vector<std::string> clients_;
  std::vector<Sensor> sensors_;
  std::vector<Command> commands_;
  std::vector<Chain> chains_;
  std::vector<Knows> threads_, of_clients_;
  std::map<std::pair<int, int>, Kept> kept_;  // by sensor and command
  std::vector<Kept> named_;                   // as `chains_`
  std::vector<int> path_;                     // of the command that is counted
};

}  // namespace tcs
