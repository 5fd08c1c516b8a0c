// The preparation of a run before its first step: the run's memory, the sockets by which clients
// find the coordinator, the processor on which clients run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/engine/engine_part.h"
#include "coordinator/prices/price_list.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class Setup : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Names the parts that have to be told of waits and ends. Once, before anything else.
  void Connect();
  // Empty on success, else one sentence.
  [[nodiscard]] std::string Prepare();
  // The part of Prepare() that takes nothing of the machine's: the run's memory, and the parts that
  // hear of its events. Returns the same.
  [[nodiscard]] std::string PrepareParts(const std::vector<int>& further_cpus);
  PriceList PricesOf(const RobotSpec& spec) const;
  void MakeRobots();

 private:
  [[nodiscard]] std::string OpenAnswers();
  void TellOfMissingRights() const;
  [[nodiscard]] std::string PrepareMemory();
  [[nodiscard]] std::string PrepareHostCpu();
  std::uint64_t CounterRate() const;
  std::optional<std::uint64_t> TurnsSeed() const;
  void TellOfWaits();
  void TellOfEnds();
};

}  // namespace tcs
