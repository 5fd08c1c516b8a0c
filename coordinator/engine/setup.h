// What a run needs before its first step: the run's memory, the sockets that clients find us by,
// the processor that they run on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/engine/engine_part.h"

namespace tcs {

class Setup : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Who has to be told of waits and ends is named. Once, before anything else.
  void Connect();
  // Empty on success, else one sentence.
  [[nodiscard]] std::string Prepare();
  // Of that, what takes nothing of the machine's: the run's memory, and those who hear of its
  // events. The same is returned.
  [[nodiscard]] std::string PrepareParts(const std::vector<int>& further_cpus);
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
