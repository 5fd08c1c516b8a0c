#include "coordinator/queues/process_timers.h"

#include <signal.h>
#include <sys/time.h>

#include <algorithm>
#include <climits>
#include <iterator>
#include <utility>

#include "shm/check.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

using shm::TimerClock;

constexpr VirtualDuration kLeastCpu = VirtualDuration::Microseconds(1);
// So often, at most, a running thread is stopped for a timer of a short interval.
constexpr std::int64_t kLookNs = shm::kShortIntervalNs;

bool IsItimer(std::int64_t id) { return id >= ITIMER_REAL && id <= ITIMER_PROF; }

// Timers that are there from the beginning, and not deleted.
bool IsOfProcess(std::int64_t id) {
  return IsItimer(id) || id == ProcessTimers::kCpuLimit || id == ProcessTimers::kMostCpu;
}

shm::TimerKind KindOfOwn(std::int64_t which) {
  shm::TimerKind kind;
  if (!IsItimer(which)) {
    kind.signal = which == ProcessTimers::kCpuLimit ? SIGXCPU : SIGKILL;
    kind.clock = TimerClock::kProcessCpu;
    return kind;
  }
  kind.signal = which == ITIMER_REAL ? SIGALRM : which == ITIMER_VIRTUAL ? SIGVTALRM : SIGPROF;
  kind.clock = which == ITIMER_REAL ? TimerClock::kTime : TimerClock::kProcessCpu;
  return kind;
}

}  // namespace

// How often the timer has run out by `clock_ns`, on its clock; sets the timer to its next time.
std::int64_t ProcessTimers::Timer::TakeExpirations(std::int64_t clock_ns) {
  std::int64_t& next_ns = setting.next_ns;
  const std::int64_t interval_ns = setting.interval_ns;
  if (next_ns == 0 || next_ns > clock_ns) return 0;
  if (interval_ns == 0) {
    next_ns = 0;
    return 1;
  }
  const std::int64_t count = 1 + (clock_ns - next_ns) / interval_ns;
  const std::int64_t last_ns = next_ns + (count - 1) * interval_ns;
  next_ns = shm::AddSaturated(last_ns, interval_ns);
  return count;
}

bool ProcessTimers::Timer::IsShort() const {
  return setting.interval_ns > 0 && setting.interval_ns < shm::kShortIntervalNs;
}

VirtualTime ProcessTimers::Timer::NextOnVirtualCpu() const {
  return RobotTimeOf(OwnTime(setting.next_ns), lead);
}

std::int64_t ProcessTimers::Timer::CpuTimeLeft(std::int64_t used_ns) const {
  const bool is_looked_at = IsShort() && seen_ns != 0;
  const std::int64_t due_ns =
      is_looked_at ? std::max(setting.next_ns, seen_ns + kLookNs) : setting.next_ns;
  return due_ns - used_ns;
}

void ProcessTimers::Timer::AddOverruns(std::int64_t count) {
  overruns += std::min<std::int64_t>(INT_MAX - overruns, count);
}

void ProcessTimers::Timer::Accept() {
  is_signal_underway = false;
  accepted_overruns = std::exchange(overruns, 0);
}

const ProcessTimers::Timer* ProcessTimers::Find(Id id) const {
  const auto found = timers_.find(id);
  return found == timers_.end() ? nullptr : &found->second;
}

ProcessTimers::Timer* ProcessTimers::Find(Id id) {
  if (IsOfProcess(id)) timers_.try_emplace(id, Timer{.kind = KindOfOwn(id)});
  const auto found = timers_.find(id);
  return found == timers_.end() ? nullptr : &found->second;
}

bool ProcessTimers::IsFull() const {
  const auto itimers = std::distance(timers_.begin(), timers_.lower_bound(shm::kFirstTimerId));
  return timers_.size() - static_cast<std::size_t>(itimers) >= kMost;
}

ProcessTimers::Id ProcessTimers::Create(const shm::TimerKind& kind) {
  TCS_CHECK(!IsFull());
  timers_[next_id_].kind = kind;
  return next_id_++;
}

void ProcessTimers::Delete(Id id) {
  if (IsOfProcess(id) || timers_.erase(id) == 0) return;
  std::erase_if(signals_, [id](const TimerSignal& signal) { return signal.timer_id == id; });
  FindNext();
}

void ProcessTimers::DeletePosix() {
  std::vector<Id> ended;
  for (const auto& [id, timer] : timers_) {
    if (timer.kind.is_posix != 0) ended.push_back(id);
  }
  for (const Id id : ended) Delete(id);
}

std::optional<shm::TimerKind> ProcessTimers::KindOf(Id id) const {
  if (IsOfProcess(id)) return KindOfOwn(id);
  const Timer* timer = Find(id);
  return timer == nullptr ? std::nullopt : std::optional(timer->kind);
}

ProcessTimers::Setting ProcessTimers::Get(Id id) const {
  const Timer* timer = Find(id);
  return timer == nullptr ? Setting{} : timer->setting;
}

std::vector<ProcessTimers::Armed> ProcessTimers::AllArmed() const {
  std::vector<Armed> armed;
  for (const auto& [id, timer] : timers_) {
    if (timer.IsArmed()) armed.push_back({id, timer.setting, timer.kind});
  }
  return armed;
}

void ProcessTimers::Set(Id id, Setting setting, VirtualDuration lead) {
  Timer* timer = Find(id);
  if (timer == nullptr) return;
  timer->setting.next_ns = std::max<std::int64_t>(0, setting.next_ns);
  // The kernel forgets the interval of a timer that is disarmed, but for the timers of descriptors
  // and those of setitimer on processor time.
  const bool forgets = setting.next_ns <= 0 && (timer->kind.is_posix != 0 || id == ITIMER_REAL);
  timer->setting.interval_ns = forgets ? 0 : std::max<std::int64_t>(0, setting.interval_ns);
  timer->setting.is_date = setting.is_date;
  timer->lead = lead;
  timer->is_signal_underway = timer->was_seen_accepted = timer->rests = false;
  timer->overruns = timer->accepted_overruns = 0;
  FindNext();
}

void ProcessTimers::MoveDates(std::int64_t forward_ns, VirtualTime now) {
  bool moves = false;
  for (auto& [id, timer] : timers_) {
    if (!timer.IsArmed() || !timer.setting.is_date) continue;
    std::int64_t& next_ns = timer.setting.next_ns;
    // How long next_ns is over tells how often the timer has run out.
    next_ns = std::max(shm::AddSaturated(next_ns, -forward_ns), -shm::kFarNs);
    if (next_ns == 0) next_ns = 1;  // 0 would say that the timer is not armed
    timer.rests = false;
    moves = true;
  }
  if (moves) FindNext(now);
}

void ProcessTimers::FindNext(VirtualTime earliest) {
  const VirtualTime before = std::exchange(next_expiry_, VirtualTime::Never());
  has_cpu_timers_ = false;
  for (const auto& [id, timer] : timers_) {
    if (!timer.IsArmed()) continue;
    if (timer.IsOnCpuTime()) {
      has_cpu_timers_ = true;
    } else if (!timer.rests) {
      next_expiry_ = std::min(next_expiry_, timer.NextOnVirtualCpu());
    }
  }
  next_expiry_ = std::max(next_expiry_, earliest);
  if (next_expiry_ != before && listener_) listener_();
}

std::vector<ProcessTimers::RanOut> ProcessTimers::Expire(VirtualTime now) {
  std::vector<RanOut> ran_out;
  for (auto& [id, timer] : timers_) {
    if (timer.IsOnCpuTime()) continue;
    const ProgramTime shown = OwnTimeOf(now, timer.lead);
    const std::int64_t count = timer.TakeExpirations(shown.ns());
    if (count == 0) continue;
    if (timer.IsShort()) {
      timer.rests = has_resting_timers_ = true;
      timer.seen_ns = shown.ns();
    }
    Signal(id, timer, count);
    ran_out.push_back({id, count, shown, timer.setting.interval_ns > 0});
  }
  FindNext();
  return ran_out;
}

bool ProcessTimers::IsBehind(Id id, VirtualTime now) const {
  const Timer* timer = Find(id);
  return timer != nullptr && timer->IsShort() && !timer->IsOnCpuTime() && timer->IsArmed() &&
         timer->NextOnVirtualCpu() <= now;
}

std::optional<VirtualDuration> ProcessTimers::CpuClockOf(const Timer& timer, const CpuUsed& used) {
  if (timer.kind.clock == TimerClock::kProcessCpu) return used.process;
  return timer.kind.clock_tid == used.tid ? std::optional(used.thread) : std::nullopt;
}

std::optional<VirtualDuration> ProcessTimers::CpuTimeToExpiry(const CpuUsed& used) const {
  std::optional<VirtualDuration> left;
  for (const auto& [id, timer] : timers_) {
    if (!timer.IsArmed() || !timer.IsOnCpuTime()) continue;
    const auto clock = CpuClockOf(timer, used);
    if (!clock.has_value()) continue;
    const VirtualDuration its = std::max(kLeastCpu, VirtualNs(timer.CpuTimeLeft(clock->ns())));
    left = std::min(left.value_or(its), its);
  }
  return left;
}

std::vector<ProcessTimers::RanOut> ProcessTimers::ExpireCpu(const CpuUsed& used) {
  std::vector<RanOut> ran_out;
  for (auto& [id, timer] : timers_) {
    if (!timer.IsOnCpuTime()) continue;
    const auto clock = CpuClockOf(timer, used);
    const std::int64_t count = clock.has_value() ? timer.TakeExpirations(clock->ns()) : 0;
    if (count == 0) continue;
    timer.seen_ns = clock->ns();
    Signal(id, timer, count, used.tid);
    ran_out.push_back({id, count, std::nullopt, timer.setting.interval_ns > 0});
  }
  FindNext();
  return ran_out;
}

void ProcessTimers::EndRests(VirtualTime now) {
  if (!std::exchange(has_resting_timers_, false)) return;
  for (auto& [id, timer] : timers_) timer.rests = false;
  // Expirations in the meantime are made up now, and not on a core that is still behind.
  FindNext(now);
}

VirtualTime ProcessTimers::NextLook() const {
  VirtualTime next = VirtualTime::Never();
  if (!has_resting_timers_) return next;
  for (const auto& [id, timer] : timers_) {
    if (!timer.rests) continue;
    next = std::min(next, RobotTimeOf(OwnTime(timer.seen_ns + kLookNs), timer.lead));
  }
  return next;
}

void ProcessTimers::Signal(Id id, Timer& timer, std::int64_t count, pid_t computed) {
  if (timer.kind.signal == 0) return;
  if (timer.kind.is_posix == 0) {
    // Signals of timers other than timer_create's are not counted.
    const bool is_underway = std::ranges::any_of(signals_, [&](const TimerSignal& signal) {
      return signal.timer_id == 0 && signal.number == timer.kind.signal;
    });
    if (!is_underway) signals_.push_back({.number = timer.kind.signal, .computed = computed});
    return;
  }
  if (timer.is_signal_underway) return timer.AddOverruns(count);
  timer.is_signal_underway = true;
  timer.overruns = 0;
  timer.AddOverruns(count - 1);
  signals_.push_back({.number = timer.kind.signal,
                      .tid = timer.kind.signal_tid,
                      .timer_id = id,
                      .value = timer.kind.value,
                      .overruns = timer.overruns,
                      .computed = computed});
}

std::vector<TimerSignal> ProcessTimers::TakeSignals() { return std::exchange(signals_, {}); }

void ProcessTimers::NoteSent(const TimerSignal& signal, pid_t to) {
  if (signal.timer_id == 0) return;
  if (Timer* timer = Find(signal.timer_id); timer != nullptr) timer->sent_to = to;
}

bool ProcessTimers::IsUnsent(Id id) const {
  return std::ranges::any_of(signals_, [id](const TimerSignal& s) { return s.timer_id == id; });
}

std::vector<ProcessTimers::SentSignal> ProcessTimers::SentSignals() const {
  std::vector<SentSignal> sent;
  for (const auto& [id, timer] : timers_) {
    if (!timer.is_signal_underway || IsUnsent(id)) continue;
    sent.push_back({id, timer.kind.signal, timer.sent_to});
  }
  return sent;
}

void ProcessTimers::Accept(Id id, VirtualTime now) {
  Timer* timer = Find(id);
  if (timer == nullptr || !timer->is_signal_underway) return;
  if (timer->IsShort() && !timer->IsOnCpuTime()) {
    // An expiration at this instant has a signal of its own.
    timer->AddOverruns(timer->TakeExpirations(OwnTimeOf(now, timer->lead).ns() - 1));
    FindNext();
  }
  timer->Accept();
  timer->was_seen_accepted = true;
}

void ProcessTimers::Lost(Id id) {
  Timer* timer = Find(id);
  if (timer == nullptr) return;
  timer->is_signal_underway = false;
  timer->overruns = 0;
}

void ProcessTimers::AcceptAt(Id id, VirtualTime now, bool is_pending) {
  Timer* timer = Find(id);
  if (timer == nullptr) return;
  const bool is_told_late = std::exchange(timer->was_seen_accepted, false) && is_pending;
  if (is_told_late || !timer->is_signal_underway) return;
  if (!timer->IsOnCpuTime()) {
    timer->AddOverruns(timer->TakeExpirations(OwnTimeOf(now, timer->lead).ns()));
  }
  timer->Accept();
  FindNext();
}

std::int64_t ProcessTimers::Overruns(Id id) const {
  const Timer* timer = Find(id);
  return timer == nullptr ? 0 : timer->accepted_overruns;
}

}  // namespace tcs
