// The time that the shim takes for a call beyond the system call that the program has asked for: to
// ask the kernel what a descriptor is, to see whether the thread may go on, to tell the
// coordinator. Natively nothing of that happens, so it is neither the thread's time nor its charge.
//
// Where set costs are charged nothing is reckoned. The coordinator believes only what can be
// (coordinator/host/own_work.h): a program may write to the memory where this is told.
// Async-signal-safe; no system call.
#pragma once

#include <errno.h>

#include <cstdint>

#include "libtcs_preload/guest.h"
#include "libtcs_preload/non_blocking.h"
#include "shm/clock_page.h"
#include "shm/tsc.h"

namespace tcs::preload {

// Takes out what the shim has worked since it was last taken out. The shim works on.
void TakeOutOwnWork(GuestThread& thread);

// What is between the two is the program's.
inline void EndOwnWork(GuestThread& thread) {
  if (thread.own_work_tsc == 0) return;
  TakeOutOwnWork(thread);
  thread.own_work_tsc = 0;
}
inline void BeginOwnWork(GuestThread& thread) {
  if (thread.slot->clock.ns_per_tick_q32 != 0) thread.own_work_tsc = shm::ReadTsc();
}

// From here to the end of the scope the shim works for a call of the thread's, but for what is made
// AsProgram. In a scope within, nothing changes. Null: the call is let through.
class OwnWork {
 public:
  explicit OwnWork(GuestThread* thread)
      : thread_(thread != nullptr && thread->own_work_tsc == 0 ? thread : nullptr) {
    if (thread_ != nullptr) BeginOwnWork(*thread_);
  }
  // A child by fork has not begun it.
  ~OwnWork() {
    if (thread_ != nullptr && thread_->slot != nullptr) EndOwnWork(*thread_);
  }
  OwnWork(const OwnWork&) = delete;
  OwnWork& operator=(const OwnWork&) = delete;

 private:
  GuestThread* const thread_;
};

// What a call that is made AsProgram takes more than the same call natively: the filter that looks
// at it, and the reckoning. Measured once in each process, in the shim's own work.
std::uint64_t SurplusTicks(GuestThread& thread);

// Makes the system call that the program has asked for: its time is the program's, unless it has
// found only that it would have to wait, or that the descriptor has no form that cannot. Then the
// call was a look of the shim's. `form_ticks`: what the call takes more in the form in which it is
// made.
template <class Call>
auto AsProgram(GuestThread& thread, Call call, std::uint64_t form_ticks = 0) {
  if (thread.own_work_tsc == 0) return call();
  const std::uint64_t surplus = SurplusTicks(thread) + form_ticks;
  TakeOutOwnWork(thread);
  const std::uint64_t begun_tsc = shm::ReadTsc();
  // Goes to the next part of the shim's work.
  const std::uint64_t taking_out = begun_tsc - thread.own_work_tsc;
  thread.own_work_tsc = 0;
  const std::uint32_t handlers = thread.handlers;
  const auto result = call();
  const std::uint64_t ended_tsc = shm::ReadTsc();
  const std::uint64_t ticks = ended_tsc - begun_tsc;
  const std::uint64_t not_its = surplus < ticks ? surplus : ticks;
  const bool was_look = (result == -EAGAIN || result == -EOPNOTSUPP || result == kNoForm) &&
                        thread.handlers == handlers;
  thread.look_ticks = was_look ? ticks - not_its : 0;
  thread.own_work_tsc = (was_look ? begun_tsc : ended_tsc - not_its) - taking_out;
  return result;
}

// The last look has been the program's own call after all: its answer is the program's.
inline void AnswerByLook(GuestThread& thread) {
  if (thread.own_work_tsc != 0) thread.own_work_tsc += thread.look_ticks;
  thread.look_ticks = 0;
}

// From here to the end of the scope the shim does not work for the call, if it did: a handler of
// the program's runs in the midst of it, whose time is the program's; or the thread is in an
// exchange, which is taken out otherwise (exchange.cc).
class PausedOwnWork {
 public:
  explicit PausedOwnWork(GuestThread& thread)
      : thread_(thread), was_under_way_(thread.own_work_tsc != 0) {
    EndOwnWork(thread);
  }
  ~PausedOwnWork() {
    if (was_under_way_) BeginOwnWork(thread_);
  }
  PausedOwnWork(const PausedOwnWork&) = delete;
  PausedOwnWork& operator=(const PausedOwnWork&) = delete;

 private:
  GuestThread& thread_;
  const bool was_under_way_;
};

}  // namespace tcs::preload
