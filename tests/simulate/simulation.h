// One run of the real coordinator's engine on a simulated host: robots, programs and their course
// follow from the script's seed, and what the host does meanwhile from its own.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "tests/simulate/program.h"
#include "tests/simulate/simulated_run.h"

namespace tcs::simulate {

struct SimulationSeeds {
  std::uint64_t script = 1, host = 1;
};

class Simulation {
 public:
  Simulation(const SimulationSeeds& seeds, bool has_levels, bool is_fixed);

  // So many steps of the coordinator, or to the run's end. How many it took.
  int Run(int steps);

  // What each thread's clock showed after each thing that it did, one thread after the other.
  std::vector<std::vector<std::int64_t>> Shown() const;
  // On stderr: each thing that happens from now on; what has become of each thread.
  void TraceEvents() { run_.kernel().Trace(); }
  void TraceThreads() const;
  // Programs of that script send signals, or have timers that do. When threads handle these is not
  // the same with levels and without.
  static bool HasSignals(std::uint64_t script) { return script % 3 != 0; }
  static bool HasTimers(std::uint64_t script) { return Luck(script).Part(2).OnceIn(2); }

 private:
  static Scenario ScenarioOf(Luck& luck);
  void AddPrograms(Luck& luck);
  void AddThread(const Robot& robot, Luck& luck, std::deque<SimLock>& locks);
  void Check();
  void CheckCharges();
  void TraceStep();

  const bool is_fixed_;
  int step_ = 0, dies_at_ = -1;  // the first process, at that step
  Luck script_;
  SimulatedRun run_;
  ProgramRules rules_;
  std::deque<std::deque<SimLock>> locks_;
  SimFile file_;
  std::deque<SimProgram> programs_;
  std::vector<Task*> tasks_;
  std::vector<std::int64_t> charged_;
};

}  // namespace tcs::simulate
