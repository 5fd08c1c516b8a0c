// The coordinator's end of the memory that it shares with `tcsim dump` (state_page.h). What it does
// is noted there as it goes, which costs a few stores; its whole state is written when somebody has
// asked for it.
//
// For the coordinator's thread only. Whoever asks is another process, and whatever it does the run
// goes on.
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

  // From now on others can ask. `folder` is absolute, or empty. Where the memory cannot be made
  // nobody can, and the run goes on without.
  void Open(const std::string& folder);
  // Readable once somebody has asked; -1 where nobody can.
  int wake_fd() const { return pipe_.read_end.get(); }

  // From `tsc` on.
  void Does(Doing what, std::uint64_t tsc) {
    page_->since_tsc.store(tsc, std::memory_order_relaxed);
    page_->doing.store(what, std::memory_order_relaxed);
  }
  // The thread was dispatched at `tsc`, and at virtual `at_ns`.
  void Dispatched(pid_t tid, std::uint64_t tsc, std::int64_t at_ns);
  void RunsOn(int host_cpu) { page_->host_cpu.store(host_cpu); }

  // The last dispatch.
  std::uint64_t dispatched_tsc() const { return page_->dispatched_tsc.load(); }

  // Empties the pipe. True if somebody has asked and was not answered yet.
  bool TakeAsked();
  void Answer(std::string_view text);

 private:
  StatePage own_;  // until it is opened, and where it cannot be
  StatePage* page_ = &own_;
  UniqueFd memory_;
  Pipe pipe_;
  std::uint32_t asked_ = 0;
};

}  // namespace tcs
