// Programs of clients into which the loader preloads no shim: statically linked ones, and those of
// another C library. Such programs are told from others when they begin, before they have read any
// clock.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include <map>
#include <set>
#include <string>
#include <tuple>

#include "coordinator/os/counter_patches.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class BarePrograms {
 public:
  explicit BarePrograms(RunState& run) : run_(run) { draws_.Seed(~run.scenario.seed); }

  // The process has executed a program, which is about to set itself up.
  void Begins(pid_t pid);
  // Whether the process did so before it was known which process it is. True once: the process is
  // known from now on.
  bool TakeUnknown(pid_t pid) { return unknown_.erase(pid) != 0; }

 private:
  // A file as it was: where it is, when it last changed, and its size.
  using FileKey = std::tuple<std::uint64_t, std::uint64_t, std::int64_t, std::int64_t>;

  void RepeatKernelsDraws(pid_t pid, const std::map<std::uint64_t, std::uint64_t>& told);
  void LeadClocks(pid_t pid, const Process* process, const std::string& name);
  void LeadCounter(pid_t pid, const Process* process, const std::string& name);

  RunState& run_;
  std::map<FileKey, CounterPatches> counter_patches_;
  shm::Draws draws_;
  std::set<pid_t> unknown_;
};

}  // namespace tcs
