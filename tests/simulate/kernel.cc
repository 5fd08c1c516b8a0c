#include "tests/simulate/kernel.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <ucontext.h>

#include <algorithm>
#include <utility>

#include "coordinator/os/signal_bits.h"
#include "coordinator/port/levels.h"
#include "shm/check.h"
#include "shm/layout.h"
#include "tests/simulate/broken.h"

namespace tcs::simulate {

namespace {

constexpr std::int64_t kUs = 1'000, kMs = 1'000'000;

// The instruction at which the kernel has a thread make its call again.
constexpr unsigned char kSyscall[] = {0x0f, 0x05};

ucontext_t AtCall(const TrappedCall& call) {
  ucontext_t context{};
  greg_t* const registers = context.uc_mcontext.gregs;
  registers[REG_RIP] = reinterpret_cast<greg_t>(kSyscall);
  registers[REG_RCX] = registers[REG_RIP] + static_cast<greg_t>(sizeof kSyscall);
  registers[REG_RAX] = call.number;
  registers[REG_RSI] = static_cast<greg_t>(call.args[1]);
  registers[REG_R10] = static_cast<greg_t>(call.args[3]);
  registers[REG_R9] = static_cast<greg_t>(call.args[5]);
  return context;
}

bool IsToBeMadeAgain(const ucontext_t& context) {
  return context.uc_mcontext.gregs[REG_RIP] == reinterpret_cast<greg_t>(kSyscall);
}

}  // namespace

Kernel* Kernel::this_ = nullptr;

// It has been on for a while.
Kernel::Kernel(std::uint64_t seed, bool has_levels)
    : has_levels_(has_levels), luck_(seed), now_ns_(luck_.Between(kMs, 1'000'000 * kMs)) {
  TCS_CHECK(this_ == nullptr);
  this_ = this;
}

Kernel::~Kernel() { this_ = nullptr; }

Kernel& Kernel::This() {
  TCS_CHECK(this_ != nullptr);
  return *this_;
}

SimThread& Kernel::AddThread(SimProcess& process, pid_t tid, std::function<void()> body) {
  SimThread& thread = threads_.emplace_back(tid, process, std::move(body));
  thread.level = static_cast<int>(Level::kWaiting);
  thread.ready_since = ++queued_;
  return thread;
}

SimThread* Kernel::Find(pid_t tid) {
  const auto found = std::find_if(threads_.begin(), threads_.end(),
                                  [tid](const SimThread& thread) { return thread.tid == tid; });
  return found == threads_.end() ? nullptr : &*found;
}

std::vector<pid_t> Kernel::ThreadsOf(pid_t pid) const {
  std::vector<pid_t> tids;
  for (const SimThread& thread : threads_) {
    if (thread.process.pid == pid) tids.push_back(thread.tid);
  }
  return tids;
}

// Of a timer.
std::int64_t Kernel::Lateness() {
  return luck_.OnceIn(20) ? luck_.Long(kUs, 200 * kUs) : luck_.Between(500, 3'000);
}

void Kernel::WriteNote(const SimThread& thread, const char* what, std::int64_t value) const {
  fprintf(stderr, "%11.3f us  %d (level %d, computed %ld) %s %ld\n",
          static_cast<double>(now_ns_) / 1e3, thread.tid, thread.level, thread.program_ns, what,
          value);
}

void Kernel::Spend(std::int64_t ns) {
  TCS_CHECK(running_ == nullptr);
  now_ns_ += luck_.Between(ns / 2, 2 * ns);
  if (luck_.OnceIn(20'000)) now_ns_ += luck_.Long(10 * kUs, 20 * kMs);
  WakeDue();
  if (has_levels_ || !luck_.OnceIn(50)) return;
  // The processor is taken from the coordinator.
  for (std::int64_t slices = luck_.Between(1, 3); slices > 0; --slices) {
    SimThread* const thread = Next();
    if (thread == nullptr) return;
    Run(*thread, now_ns_ + luck_.Long(kUs, 3 * kMs));
  }
}

std::int64_t Kernel::NextDue() const {
  std::int64_t due_ns = INT64_MAX;
  for (const SimThread& thread : threads_) {
    if (thread.Waits()) due_ns = std::min(due_ns, thread.wakes_at_ns);
  }
  return due_ns;
}

void Kernel::WakeDue() {
  if (now_ns_ < none_due_before_ns_) return;
  for (SimThread& thread : threads_) {
    if (!thread.Waits() || thread.wakes_at_ns > now_ns_) continue;
    Wake(thread, thread.state == SimThread::State::kAtWord ? -ETIMEDOUT : 0);
  }
  none_due_before_ns_ = NextDue();
}

void Kernel::WaitUntil(SimThread& thread, SimThread::State state, std::int64_t until_ns) {
  thread.state = state;
  thread.wakes_at_ns = until_ns;
  none_due_before_ns_ = std::min(none_due_before_ns_, until_ns);
}

void Kernel::Wake(SimThread& thread, long result) {
  thread.state = SimThread::State::kRuns;
  thread.ready_since = ++queued_;
  thread.is_interrupted = false;
  thread.result = result;
  thread.word = nullptr;
  thread.wakes_at_ns = INT64_MAX;
}

// Who has the processor while the coordinator does not want it: of the highest level who has been
// ready for longest (SCHED_FIFO), or anybody.
SimThread* Kernel::Next() {
  SimThread* next = nullptr;
  std::uint64_t rivals = 0;
  for (SimThread& thread : threads_) {
    if (thread.state != SimThread::State::kRuns) continue;
    const bool is_before =
        next == nullptr ||
        (has_levels_ ? thread.level > next->level ||
                           (thread.level == next->level && thread.ready_since < next->ready_since)
                     : luck_.OnceIn(rivals + 1));
    ++rivals;
    if (is_before) next = &thread;
  }
  return next;
}

// It comes to the end of its new level's queue, or to the beginning if that is lower (sched(7)).
void Kernel::SetLevel(SimThread& thread, int level) {
  if (level == thread.level) return;
  thread.ready_since = level < thread.level ? -++queued_ : ++queued_;
  thread.level = level;
}

void Kernel::Run(SimThread& thread, std::int64_t until_ns) {
  TCS_CHECK(running_ == nullptr);
  if (thread.is_dying) return Die(thread);
  running_ = &thread;
  until_ns_ = until_ns;
  Note(thread, "has the processor for", until_ns - now_ns_);
  std::swap(preload::t_thread, thread.guest);
  preload::g_process = &thread.process.state;
  preload::g_notify_fd = thread.process.notify_fd;
  thread.fiber.Enter();
  std::swap(preload::t_thread, thread.guest);
  running_ = nullptr;
}

void Kernel::Die(SimThread& thread) {
  now_ns_ += luck_.Between(10 * kUs, 60 * kUs);
  thread.state = SimThread::State::kDead;
  Note(thread, "is dead");
  has_said_ = true;
  if (!HasEnded(thread.process.pid)) return;
  for (const auto& [fd, pid] : watched_) {
    if (pid == thread.process.pid) descriptors_.Raise(fd);
  }
}

bool Kernel::HasEnded(pid_t pid) const {
  return std::all_of(threads_.begin(), threads_.end(), [pid](const SimThread& thread) {
    return thread.process.pid != pid || thread.state == SimThread::State::kDead;
  });
}

void Kernel::Kill(pid_t pid) {
  for (SimThread& thread : threads_) {
    if (thread.process.pid != pid || thread.state == SimThread::State::kDead) continue;
    thread.is_dying = true;
    if (thread.state != SimThread::State::kRuns) Interrupt(thread);
  }
}

void Kernel::Stop() {
  Note(*running_, "stops, in state", static_cast<int>(running_->state));
  running_->fiber.Leave();
}

void Kernel::Sleep(const std::function<bool()>& has_events, std::int64_t timeout_ns) {
  TCS_CHECK(running_ == nullptr);
  Spend(300);
  if (timeout_ns == 0) return;
  const std::int64_t until_ns = timeout_ns < 0 ? INT64_MAX : now_ns_ + timeout_ns + Lateness();
  has_said_ = false;
  std::int64_t woken_at_ns = has_events() ? now_ns_ : INT64_MAX;
  for (;;) {
    WakeDue();
    if (std::min(until_ns, woken_at_ns) <= now_ns_) return;
    SimThread* const thread = Next();
    const int level = thread == nullptr ? 0 : has_levels_ ? thread->level : 1;
    // Whoever shares the processor by rank only gets hardly any of it.
    const bool detects =
        has_levels_ ? level < static_cast<int>(Level::kDetector) : level == 0 || luck_.OnceIn(200);
    if (detector_fd_ >= 0 && detects) {
      now_ns_ += luck_.Between(500, 2'000);
      descriptors_.Raise(std::exchange(detector_fd_, -1));
      has_said_ = true;
    } else if (thread != nullptr) {
      const std::int64_t slice_ns = has_levels_ ? INT64_MAX / 2 : luck_.Long(20 * kUs, 4 * kMs);
      Run(*thread, std::min({until_ns, woken_at_ns, NextDue(), now_ns_ + slice_ns}));
      if (luck_.OnceIn(500)) now_ns_ += luck_.Long(10 * kUs, 50 * kMs);  // somebody else's
    } else {
      const std::int64_t due_ns = std::min({until_ns, woken_at_ns, NextDue()});
      TCS_CHECK(due_ns != INT64_MAX);  // nobody would ever run again
      now_ns_ = std::max(now_ns_, due_ns);
    }
    if (!has_said_ || woken_at_ns != INT64_MAX) continue;
    has_said_ = false;
    if (!has_events()) continue;
    // Without levels those go on for a while that have the processor.
    const bool at_once = has_levels_ || !luck_.OnceIn(4);
    woken_at_ns = now_ns_ + (at_once ? luck_.Between(200, 2'000) : luck_.Long(2 * kUs, 6 * kMs));
    if (has_levels_) now_ns_ = woken_at_ns;
  }
}

void Kernel::ArmDetector(int fired_fd) { detector_fd_ = fired_fd; }

void Kernel::ComputeInShim(std::int64_t ns) {
  constexpr int kMostCalls = 2'000;
  SimThread& thread = *running_;
  const bool spins = ++thread.idle_calls > kMostCalls;
  // Where there are no levels it may lose the processor at each of them.
  if (!has_levels_ && luck_.OnceIn(200)) until_ns_ = now_ns_;
  Compute(spins ? std::max(ns, until_ns_ - now_ns_ + 1) : ns, false);
}

void Kernel::Compute(std::int64_t ns, bool of_program) {
  SimThread& thread = *running_;
  if (of_program) thread.idle_calls = 0;
  while (ns > 0) {
    const std::int64_t step_ns = std::min(ns, std::max<std::int64_t>(0, until_ns_ - now_ns_));
    now_ns_ += step_ns;
    thread.cpu_ns += step_ns;
    if (of_program && step_ns > 0) {
      if (watch_) watch_(thread);
      thread.program_ns += step_ns;
    }
    ns -= step_ns;
    if (ns > 0) {
      Stop();
      Deliver(thread);
    }
  }
}

void Kernel::Notified() {
  has_said_ = true;
  if (has_levels_) Stop();
  Deliver(*running_);
}

long Kernel::WaitAt(const std::atomic<std::uint32_t>& word, std::uint32_t value,
                    std::int64_t timeout_ns) {
  SimThread& thread = *running_;
  if (word.load() != value) return -EAGAIN;
  if (luck_.OnceIn(1'000)) return 0;  // for nothing
  ++thread.waits;
  const std::int64_t until_ns = now_ns_ + timeout_ns;
  while (Deliverable(thread) == 0) {
    WaitUntil(thread, SimThread::State::kAtWord, until_ns);
    thread.word = &word;
    Stop();
    if (!thread.is_interrupted) {
      Note(thread, "is woken, with the result", thread.result);
      const long result = thread.result;
      Deliver(thread);
      return result;
    }
    // Another thread may have taken the signal. Then the kernel makes the call again.
    if (Deliverable(thread) == 0 && word.load() != value) return -EAGAIN;
  }
  Note(thread, "its wait is interrupted; it blocks",
       static_cast<std::int64_t>(thread.blocked_signals));
  Deliver(thread);
  return -EINTR;
}

long Kernel::Trap(long number, const long (&args)[6]) {
  SimThread& thread = *running_;
  for (;;) {
    thread.call = TrappedCall{.listener = thread.process.trap_listener,
                              .id = ++last_call_,
                              .tid = thread.tid,
                              .number = static_cast<int>(number)};
    std::copy(std::begin(args), std::end(args), std::begin(thread.call.args));
    thread.call_is_taken = false;
    thread.state = SimThread::State::kInTrap;
    descriptors_.Raise(thread.process.trap_listener);
    Note(thread, "makes the call", number);
    has_said_ = true;
    if (Deliverable(thread) != 0) Interrupt(thread);
    Stop();
    if (!thread.is_interrupted) {
      const long result = thread.result;
      Deliver(thread);
      return result;
    }
    ucontext_t call = AtCall(thread.call);
    Deliver(thread, &call);
    if (!IsToBeMadeAgain(call)) return static_cast<long>(call.uc_mcontext.gregs[REG_RAX]);
  }
}

void Kernel::BlockFor(std::int64_t ns) {
  SimThread& thread = *running_;
  WaitUntil(thread, SimThread::State::kInKernel, now_ns_ + ns);
  Stop();
  Deliver(thread);
}

void Kernel::SetBlocked(std::uint64_t signals) {
  running_->blocked_signals = signals;
  Deliver(*running_);
}

void Kernel::SetHandler(int signal, unsigned long handler) {
  handlers_[static_cast<std::size_t>(signal)] = handler;
}

std::uint64_t Kernel::Caught() const {
  std::uint64_t caught = 0;
  for (int signal = 1; signal < static_cast<int>(handlers_.size()); ++signal) {
    if (HandlerOf(signal) != 0) caught |= SignalBit(signal);
  }
  return caught;
}

std::uint64_t Kernel::Deliverable(const SimThread& thread) const {
  return (thread.pending | thread.process.pending) & ~thread.blocked_signals;
}

// As the kernel does it. Frames are built from the lowest signal on, so the highest one's handler
// runs first; and it is the lowest one's that finds the interrupted call.
void Kernel::Deliver(SimThread& thread, ucontext_t* call) {
  while (const std::uint64_t now = Deliverable(thread)) {
    const std::uint64_t own = thread.pending & now & ~SignalBit(shm::kPreemptionSignal);
    thread.pending &= ~now;
    // Of one that is there for both the thread's own comes first.
    thread.process.pending &= ~(now & ~own);
    const std::uint64_t before = thread.blocked_signals;
    const std::int64_t sent_ns = own != 0 ? thread.sent_ns : thread.process.sent_ns;
    for (int signal = 64; signal > 0; --signal) {
      if ((now & SignalBit(signal)) == 0) continue;
      const std::uint64_t lower = now & (SignalBit(signal) - 1), saved = before | lower;
      siginfo_t info{};
      info.si_signo = signal;
      const bool is_ours = signal == shm::kPreemptionSignal;
      info.si_code = is_ours ? SI_QUEUE : SI_TKILL;
      info.si_value.sival_ptr =
          reinterpret_cast<void*>(is_ours ? thread.dispatch : static_cast<std::uint64_t>(sent_ns));
      if (signal == thread.timer.number) {
        info.si_code = SI_TIMER;
        info.si_timerid = thread.timer.timer_id;
        info.si_overrun = thread.timer.overruns;
      }
      ucontext_t context{};
      if (call != nullptr && lower == 0) context = *call;
      __builtin_memcpy(&context.uc_sigmask, &saved, sizeof saved);
      Note(thread, "begins the handler of signal", signal);
      thread.blocked_signals = is_ours ? ~std::uint64_t{0} : saved | SignalBit(signal);
      reinterpret_cast<void (*)(int, siginfo_t*, void*)>(HandlerOf(signal))(signal, &info,
                                                                            &context);
      if (call != nullptr && lower == 0) *std::exchange(call, nullptr) = context;
    }
    thread.blocked_signals = before;
  }
}

// Its wait ends, as a signal is there for it, or its death.
void Kernel::Interrupt(SimThread& thread) {
  if (thread.state == SimThread::State::kInTrap && !thread.call_is_taken)
    descriptors_.Lower(thread.call.listener);
  Wake(thread, -EINTR);
  thread.is_interrupted = true;
}

void Kernel::WakeAt(const std::atomic<std::uint32_t>& word) {
  for (SimThread& thread : threads_) {
    if (thread.state != SimThread::State::kAtWord || thread.word != &word) continue;
    Wake(thread, 0);
    return;
  }
}

void Kernel::SendToGate(pid_t tid, std::uint64_t dispatch) {
  SimThread* const thread = Find(tid);
  if (thread == nullptr) return;
  thread->dispatch = dispatch;
  Send(*thread, shm::kPreemptionSignal);
}

// Without levels the kernel keeps signals from threads whose calls have been received
// (coordinator/os/trap.cc).
void Kernel::Send(SimThread& thread, int signal) {
  if (thread.state == SimThread::State::kDead || thread.is_dying) return;
  if (running_ != nullptr && (thread.pending & SignalBit(signal)) == 0)
    thread.sent_ns = running_->sends_ns;
  thread.pending |= SignalBit(signal);
  Note(thread, "is sent signal", signal);
  if ((thread.blocked_signals & SignalBit(signal)) == 0) InterruptWait(thread);
}

// One that is pending already stays what it is.
void Kernel::SendTimer(const TimerSignalRequest& request) {
  SimThread* const thread = Find(request.tid);
  if (thread == nullptr) return;
  if ((thread->pending & SignalBit(request.number)) == 0) thread->timer = request;
  Send(*thread, request.number);
}

void Kernel::InterruptWait(SimThread& thread) {
  const bool waits =
      thread.state == SimThread::State::kAtWord ||
      (thread.state == SimThread::State::kInTrap && (has_levels_ || !thread.call_is_taken));
  if (waits) Interrupt(thread);
}

// The first thread that does not block it is to take it; so may any other that comes before.
void Kernel::SendToProcess(SimProcess& process, int signal) {
  if (running_ != nullptr && (process.pending & SignalBit(signal)) == 0)
    process.sent_ns = running_->sends_ns;
  process.pending |= SignalBit(signal);
  for (SimThread& thread : threads_) {
    if (&thread.process != &process || thread.is_dying ||
        (thread.blocked_signals & SignalBit(signal)) != 0)
      continue;
    return InterruptWait(thread);
  }
}

std::optional<TrappedCall> Kernel::ReceiveTrapped(int listener) {
  for (SimThread& thread : threads_) {
    if (thread.state != SimThread::State::kInTrap || thread.call_is_taken ||
        thread.call.listener != listener)
      continue;
    thread.call_is_taken = true;
    descriptors_.Lower(listener);
    return thread.call;
  }
  return std::nullopt;
}

bool Kernel::HasAnswerToTake(std::uint64_t id) {
  return std::any_of(threads_.begin(), threads_.end(), [id](const SimThread& thread) {
    return thread.state == SimThread::State::kInTrap && thread.call.id == id;
  });
}

bool Kernel::Answer(std::uint64_t id, long result) {
  for (SimThread& thread : threads_) {
    if (thread.state != SimThread::State::kInTrap || thread.call.id != id) continue;
    Wake(thread, result);
    Note(thread, "has the answer", result);
    if (EndsBySignal(result)) {
      if (Deliverable(thread) == 0)
        Broken("a call is to return %ld, though no signal is there for its thread", result);
      thread.is_interrupted = true;
    }
    return true;
  }
  return false;
}

}  // namespace tcs::simulate
