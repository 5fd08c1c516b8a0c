#include "tests/simulate/program.h"

#include <linux/futex.h>
#include <signal.h>
#include <string.h>

#include <algorithm>
#include <utility>

#include "libtcs_preload/virtual_clock.h"
#include "shm/layout.h"
#include "tests/simulate/actions.h"
#include "tests/simulate/broken.h"

namespace tcs::simulate {

namespace {

constexpr std::int64_t kUs = 1'000, kMs = 1'000'000;

constexpr int kSignal = SIGUSR1, kTimerSignal = SIGUSR2;

}  // namespace

void SimProgram::Note(std::int64_t now_ns) {
  Kernel::This().Note(*Kernel::This().running(), "reads its clock:", now_ns);
  if (now_ns < last_ns_ && MustHold())
    Broken("a clock went back from %ld to %ld", last_ns_, now_ns);
  last_ns_ = now_ns;
}

std::int64_t SimProgram::LookAtClock() {
  const std::int64_t now_ns = ReadClock();
  Note(now_ns);
  return now_ns;
}

void SimProgram::Sleep() {
  const std::int64_t for_ns = luck_.Long(kUs, 20 * kMs);
  const std::int64_t begun_ns = LookAtClock(), until_ns = begun_ns + for_ns;
  const int handled = handled_;
  first_handled_ns_ = 0;
  const bool is_over = SleepUntil(until_ns);
  const std::int64_t now_ns = LookAtClock();
  const bool was_disturbed = handled_ != handled;
  if (!MustHold()) return;
  if (!is_over && !was_disturbed)
    Broken("a sleep until %ld ended at %ld, and no signal was handled", until_ns, now_ns);
  if (is_over && now_ns < until_ns) Broken("a sleep until %ld was over at %ld", until_ns, now_ns);
  // One that comes before the sleep has begun ends nothing.
  if (is_over && first_handled_ns_ > begun_ns + rules_.slack_ns &&
      first_handled_ns_ < until_ns - rules_.slack_ns)
    Broken("a sleep until %ld went on though a signal was handled at %ld", until_ns,
           first_handled_ns_);
  if (is_over && !was_disturbed && rules_.has_own_core && now_ns > until_ns + rules_.slack_ns)
    Broken("a sleep until %ld was over at %ld only", until_ns, now_ns);
}

// Whoever is woken is not earlier than whoever has woken it.
void SimProgram::AwaitRelease(SimLock& lock) {
  const std::size_t before = lock.wakes_done;
  if (Futex(lock.word, FUTEX_WAIT, 2) != 0) return;
  const std::int64_t now_ns = LookAtClock();
  const auto since = lock.woken_ns.begin() + static_cast<std::ptrdiff_t>(before);
  if (!MustHold()) return;
  if (since == lock.woken_ns.end()) Broken("a wait at a lock ended though nobody had released it");
  const std::int64_t earliest_ns = *std::min_element(since, lock.woken_ns.end());
  if (now_ns < earliest_ns)
    Broken("a thread that was woken at %ld went on at %ld", earliest_ns, now_ns);
}

void SimProgram::Lock(SimLock& lock) {
  std::uint32_t expected = 0;
  Compute(20);
  if (!lock.word.compare_exchange_strong(expected, 1)) {
    while (lock.word.exchange(2) != 0) AwaitRelease(lock);
  }
  if (lock.holder != nullptr && MustHold()) Broken("two threads have one lock");
  lock.holder = this;
  const std::int64_t now_ns = LookAtClock();
  // What memory alone tells may come from as far ahead as cores are apart.
  if (now_ns < lock.released_ns - rules_.drift_bound_ns && MustHold())
    Broken("a lock that was released at %ld was taken at %ld", lock.released_ns, now_ns);
}

void SimProgram::Unlock(SimLock& lock) {
  lock.released_ns = LookAtClock();
  lock.holder = nullptr;
  Compute(20);
  if (lock.word.exchange(0) != 2) return;
  lock.woken_ns.push_back(lock.released_ns);
  Futex(lock.word, FUTEX_WAKE, 1);
  ++lock.wakes_done;
}

void SimProgram::UseLock() {
  SimLock& lock = luck_.OneOf(locks_);
  Lock(lock);
  Compute(luck_.Long(kUs / 5, kMs));
  Unlock(lock);
}

void SimProgram::WriteToFile() {
  const preload::Entered guest;
  preload::HoldForWrite(*guest.thread());
  const std::int64_t now_ns = preload::NowNs(*guest.thread());
  if (now_ns + rules_.call_ns < file_.read_ns)
    Broken("what was read at %ld is written at %ld only then", file_.read_ns, now_ns);
  file_.written_ns = std::max(file_.written_ns, now_ns);
}

void SimProgram::ReadFile() {
  const preload::Entered guest;
  preload::HoldForRead(*guest.thread());
  const std::int64_t now_ns = preload::NowNs(*guest.thread());
  if (file_.written_ns > now_ns + rules_.call_ns)
    Broken("what is written at %ld is read at %ld", file_.written_ns, now_ns);
  file_.read_ns = std::max(file_.read_ns, now_ns);
}

// To one thread, or to whichever of a process takes it.
void SimProgram::SendSignal() {
  const SimThread& to = *luck_.OneOf(others_);
  Kernel::This().running()->sends_ns = LookAtClock();
  if (luck_.OnceIn(2)) {
    Simulated_tgkill(to.process.pid, to.tid, kSignal);
  } else {
    Simulated_kill(to.process.pid, kSignal);
  }
}

void SimProgram::OnSignal(int, siginfo_t* info, void*) {
  const auto sent_ns = reinterpret_cast<std::int64_t>(info->si_value.sival_ptr);
  SimProgram& program = *Kernel::This().running()->program;
  ++program.handled_;
  if (program.first_handled_ns_ == 0) program.first_handled_ns_ = program.LookAtClock();
  if (program.luck_.OnceIn(2)) Compute(program.luck_.Long(kUs / 5, 200 * kUs));
  const std::int64_t now_ns = program.LookAtClock();
  if (now_ns < sent_ns && program.MustHold())
    Broken("a signal that was sent at %ld was handled at %ld", sent_ns, now_ns);
  Compute(program.luck_.Long(kUs / 5, 100 * kUs));
  if (program.luck_.OnceIn(3)) program.WriteToFile();
  if (program.luck_.OnceIn(3)) program.ReadFile();
  program.LookAtClock();
}

std::int64_t SimTimer::NextNs() const {
  if (interval_ns == 0 && told > 0) return INT64_MAX;
  return first_ns + told * interval_ns;
}

// Where nothing keeps the thread from its core it is told of each expiration before the next one.
void SimProgram::CheckTimer(std::int64_t now_ns) const {
  const std::int64_t next_ns = timer_.NextNs();
  if (next_ns == INT64_MAX || timer_.is_unknown || !rules_.has_own_core || !MustHold()) return;
  if (next_ns + timer_.interval_ns + 2 * shm::kShortIntervalNs + rules_.slack_ns + rules_.call_ns <
      now_ns)
    Broken("a timer that ran out at %ld has told nobody by %ld", next_ns, now_ns);
}

void SimProgram::ChangeTimer(std::int64_t after_ns, std::int64_t interval_ns) {
  const std::int64_t now_ns = LookAtClock();
  const int handled = handled_;
  timer_.is_unknown = true;
  SetTimer(timer_.number, after_ns, interval_ns);
  timer_.first_ns = after_ns == 0 ? INT64_MAX : now_ns + after_ns - rules_.call_ns;  // not before
  timer_.interval_ns = interval_ns;
  timer_.told = timer_.signals = 0;
  timer_.may_be_stale = true;
  timer_.is_unknown = handled_ != handled;
}

void SimProgram::UseTimer() {
  if (timer_.number < 0) timer_.number = CreateTimer(kTimerSignal);
  CheckTimer(LookAtClock());
  ChangeTimer(luck_.Long(10 * kUs, 20 * kMs), luck_.OnceIn(3) ? 0 : luck_.Long(kUs, 10 * kMs));
}

void SimProgram::NoteTold(std::int64_t count, std::int64_t now_ns) {
  const std::int64_t told = std::exchange(timer_.told, timer_.told + count - 1);
  const std::int64_t last_ns = timer_.NextNs();
  if (last_ns <= now_ns) {
    ++timer_.told;
    return CheckTimer(now_ns);
  }
  timer_.told = told;
  if (!std::exchange(timer_.may_be_stale, false))
    Broken("a timer told at %ld of %ld expirations, the last at %ld", now_ns, count, last_ns);
}

void SimProgram::OnTimer(int, siginfo_t*, void*) {
  SimProgram& program = *Kernel::This().running()->program;
  const std::int64_t now_ns = program.LookAtClock();
  ++program.handled_;
  if (program.first_handled_ns_ == 0) program.first_handled_ns_ = now_ns;
  SimTimer& timer = program.timer_;
  const std::int64_t count = 1 + OverrunsOf(timer.number);
  const std::int64_t told_ns = program.LookAtClock();
  if (!timer.is_unknown && program.MustHold()) program.NoteTold(count, told_ns);
  Compute(program.luck_.Long(kUs / 5, 20 * kUs));
  // Nothing else would be done any more.
  constexpr int kMostSignals = 5;
  if (++timer.signals >= kMostSignals && timer.interval_ns < 200 * kUs) program.ChangeTimer(0, 0);
}

void SimProgram::HandleSignals() {
  HandleBy(kSignal, OnSignal, SA_RESTART);
  HandleBy(kTimerSignal, OnTimer, SA_RESTART);
}

// It says that it has computed a little less than it has, or slept a little longer.
void SimProgram::Cheat() {
  shm::ThreadSlot& slot = *preload::t_thread.slot;
  const std::int64_t by_ns = luck_.Long(kUs, 5 * kMs);
  switch (luck_.Between(0, 5)) {
    case 0:
      slot.clock.executed_adjust.fetch_sub(static_cast<std::uint64_t>(by_ns));
      return;
    case 1:
      slot.clock.host_cpu_origin_ns += by_ns;
      return;
    case 2:
      slot.clock.stolen_ns.fetch_add(by_ns);
      return;
    case 3:
      slot.note.time_ns -= by_ns;
      return;
    case 4:
      slot.clock.last_check_tsc.fetch_add(static_cast<std::uint64_t>(by_ns));
      return;
    default:
      slot.clock.waited_adjust.fetch_add(static_cast<std::uint64_t>(by_ns));
  }
}

// Into whatever its process shares with the coordinator.
void SimProgram::Scribble() {
  if (luck_.OnceIn(2)) return Cheat();
  auto* const slot = reinterpret_cast<unsigned char*>(preload::t_thread.slot);
  constexpr std::int64_t kSize = sizeof(shm::ThreadSlot);
  // Where the words are that are looked at most, mostly.
  const std::int64_t at = luck_.Between(0, luck_.OnceIn(4) ? kSize - 8 : 512) / 8 * 8;
  std::uint64_t value = 0;
  memcpy(&value, slot + at, sizeof value);
  switch (luck_.Between(0, 3)) {
    case 0:
      value = luck_.Next();
      break;
    case 1:
      value += static_cast<std::uint64_t>(luck_.Between(-100 * kMs, 100 * kMs));
      break;
    case 2:
      value ^= std::uint64_t{1} << luck_.Between(0, 63);
      break;
    default:
      value = 0;
  }
  memcpy(slot + at, &value, sizeof value);
  // By that the shim divides, in the program's own process, which would end it.
  std::uint64_t& rate = preload::t_thread.slot->clock.ns_per_host_ns_q32;
  if (rate == 0) rate = 1;
}

void SimProgram::Act() {
  switch (luck_.Between(0, 17)) {
    case 0:
    case 1:
    case 2:
      return Compute(luck_.Long(kUs / 5, 5 * kMs));
    case 3:
    case 4:
    case 5:
      return UseLock();
    case 6:
    case 7:
    case 8:
      return Sleep();
    case 9:
      if (rules_.has_kernel_waits) Kernel::This().BlockFor(luck_.Long(10 * kUs, 10 * kMs));
      return;
    case 10:
      if (rules_.has_signals && MustHold()) SendSignal();
      return;
    case 11:
      if (rules_.is_hostile) Scribble();
      return;
    case 12:
    case 13:
      if (MustHold()) WriteToFile();
      return;
    case 14:
    case 15:
      if (MustHold()) ReadFile();
      return;
    case 16:
      if (rules_.has_timers && MustHold()) UseTimer();
      return;
    default:
      LookAtClock();
  }
}

void SimProgram::Run(preload::GuestThread guest) {
  Attach(guest);
  HandleSignals();
  for (;;) {
    Act();
    shown_.push_back(LookAtClock());
  }
}

}  // namespace tcs::simulate
