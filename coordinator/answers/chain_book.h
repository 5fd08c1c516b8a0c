// From sensors over programs to actuators: which samples a command can know of, and how old they
// were when it acted. A thread knows of the newest sample of each sensor that it has taken, from
// the sensor or in a message of a thread that knew of it. One that has taken nothing knows what its
// client does. Fed with messages; pure. Times are virtual nanoseconds.
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
  // That the scenario names.
  struct Chain {
    std::string name;
    int sensor = 0, command = 0;
    std::vector<int> through;  // clients; none: by whatever way
    std::int64_t deadline_ns = 0;
  };
  struct Who {
    int thread = -1;  // as AnswerBook::Who has it
    int client = 0;
  };

  // What numbers mean: places in these lists.
  void Open(std::vector<std::string> clients, std::vector<Sensor> sensors,
            std::vector<Command> commands, std::vector<Chain> chains);

  // Of a message of the world's: the sensor's sample of that time.
  Lineage Sampled(int sensor, std::int64_t sampled_ns) const;
  // Of a message that the thread sends.
  Lineage Sends(const Who& who, std::int64_t at_ns);
  // The thread takes a message, which was there from `arrived_ns` on.
  void Took(const Who& who, const Lineage& lineage, std::int64_t arrived_ns, std::int64_t at_ns);
  void Commanded(const Who& who, int command, std::int64_t at_ns);
  // What it knew, nobody knows any more, but its client.
  void Dies(int thread);

  // The run is over. Chains on which commands came, and those that the scenario names.
  std::vector<ChainFigures> Conclude() const;

 private:
  static constexpr std::size_t kMostWorst = 5;
  // More programs than any way has that does not go round in circles.
  static constexpr int kMostSteps = 16;

  // As a thread knows it: when it took it, too.
  struct Had {
    KnownSample sample;
    std::int64_t arrived_ns = 0, took_ns = 0;
    std::int64_t first_ns = -1;  // when it first sent something then; -1: not yet
  };
  // In order, each once: few, and looked at for each message.
  using Knows = std::vector<std::pair<LineageOf, Had>>;
  struct Kept {
    ChainFigures figures;
    std::int64_t last_sampled_ns = -1;
    std::map<std::vector<int>, std::int64_t> paths;  // how many commands came on each
    std::pair<const std::vector<int>, std::int64_t>* newest = nullptr;  // of these; null: none yet
  };

  static Had& HadOf(Knows& knows, const LineageOf& of);
  // What it knows, of which it sends something at that time.
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
