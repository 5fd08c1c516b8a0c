// The coordinator's end of the memory that it shares with `tcsim dump` (state_page.h). The
// coordinator notes there what it does, as it goes, which costs a few stores. Its whole state is
// written when another process has asked for it.
//
// For the coordinator's thread only. The asker is another process, and the run goes on whatever
// that process does.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "coordinator/dump/state_page.h"
#include "coordinator/os/pipe.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

class StateLink {
 public:
  StateLink() = default;
  ~StateLink();
  StateLink(const StateLink&) = delete;
  StateLink& operator=(const StateLink&) = delete;

  // From now on other processes can ask. `folder` is absolute, or empty. Where the memory cannot be
  // made no process can ask, and the run goes on without.
  void Open(const std::string& folder);
  // Readable once a process has asked; -1: no process can ask.
  int wake_fd() const { return pipe_.read_end.get(); }

  // The coordinator does that from `tsc` on.
  void Does(Doing what, std::uint64_t tsc) {
    page_->since_tsc.store(tsc, std::memory_order_relaxed);
    page_->doing.store(what, std::memory_order_relaxed);
  }
  // The thread was dispatched at `tsc`, and at virtual `at_ns`.
  void Dispatched(pid_t tid, std::uint64_t tsc, std::int64_t at_ns);
  void RunsOn(int host_cpu) { page_->host_cpu.store(host_cpu); }

  // The last dispatch.
  std::uint64_t dispatched_tsc() const { return page_->dispatched_tsc.load(); }

  // Empties the pipe. True if a process has asked and was not answered yet.
  bool TakeAsked();
  void Answer(std::string_view text);

 private:
  StatePage own_;  // until Open, and where the memory cannot be made
  StatePage* page_ = &own_;
  UniqueFd memory_;
  Pipe pipe_;
  std::uint32_t asked_ = 0;
};

}  // namespace tcs
