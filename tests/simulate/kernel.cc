#include "tests/simulate/kernel.h"

#include <errno.h>
#include <signal.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "shm/check.h"
#include "shm/layout.h"

namespace tcs::simulate {

namespace {

constexpr std::int64_t kUs = 1'000, kMs = 1'000'000;

constexpr std::uint64_t BitOf(int signal) { return std::uint64_t{1} << (signal - 1); }

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
    if (thread.state != SimThread::State::kRuns) due_ns = std::min(due_ns, thread.wakes_at_ns);
  }
  return due_ns;
}

void Kernel::WakeDue() {
  for (SimThread& thread : threads_) {
    if (thread.state == SimThread::State::kRuns || thread.wakes_at_ns > now_ns_) continue;
    Wake(thread, thread.state == SimThread::State::kAtWord ? -ETIMEDOUT : 0);
  }
}

void Kernel::Wake(SimThread& thread, long result) {
  thread.state = SimThread::State::kRuns;
  thread.result = result;
  thread.word = nullptr;
  thread.wakes_at_ns = INT64_MAX;
}

// Who has the processor while the coordinator does not want it.
SimThread* Kernel::Next() {
  SimThread* next = nullptr;
  std::uint64_t rivals = 0;
  for (SimThread& thread : threads_) {
    if (thread.state != SimThread::State::kRuns) continue;
    const int level = has_levels_ ? thread.level : 0;
    if (next != nullptr && level < next->level && has_levels_) continue;
    const bool is_above = next == nullptr || (has_levels_ && level > next->level);
    rivals = is_above ? 1 : rivals + 1;
    if (is_above || luck_.OnceIn(rivals)) next = &thread;
  }
  return next;
}

void Kernel::Run(SimThread& thread, std::int64_t until_ns) {
  TCS_CHECK(running_ == nullptr);
  running_ = &thread;
  until_ns_ = until_ns;
  std::swap(preload::t_thread, thread.guest);
  preload::g_process = &thread.process.state;
  preload::g_notify_fd = thread.process.notify_fd;
  thread.fiber.Enter();
  std::swap(preload::t_thread, thread.guest);
  running_ = nullptr;
}

void Kernel::Stop() {
  SimThread& thread = *running_;
  thread.fiber.Leave();
  Deliver(thread);
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
      const std::uint64_t one = 1;
      TCS_CHECK(write(std::exchange(detector_fd_, -1), &one, sizeof one) == sizeof one);
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

void Kernel::Compute(std::int64_t ns, bool of_program) {
  SimThread& thread = *running_;
  while (ns > 0) {
    const std::int64_t step_ns = std::min(ns, std::max<std::int64_t>(0, until_ns_ - now_ns_));
    now_ns_ += step_ns;
    thread.cpu_ns += step_ns;
    if (of_program && step_ns > 0) {
      if (watch_) watch_(thread);
      thread.program_ns += step_ns;
    }
    ns -= step_ns;
    if (ns > 0) Stop();
  }
  Deliver(thread);
}

void Kernel::Notified() {
  has_said_ = true;
  if (has_levels_) Stop();
}

long Kernel::WaitAt(const std::atomic<std::uint32_t>& word, std::uint32_t value,
                    std::int64_t timeout_ns) {
  if (word.load() != value) return -EAGAIN;
  if (luck_.OnceIn(1'000)) return 0;  // for nothing
  SimThread& thread = *running_;
  if (thread.preemption.has_value() &&
      (thread.blocked_signals & BitOf(shm::kPreemptionSignal)) == 0)
    return -EINTR;
  thread.state = SimThread::State::kAtWord;
  thread.word = &word;
  thread.wakes_at_ns = now_ns_ + timeout_ns;
  Stop();
  return thread.result;
}

long Kernel::Trap(long number, const long (&args)[6]) {
  SimThread& thread = *running_;
  thread.call = TrappedCall{.listener = thread.process.trap_listener,
                            .id = ++last_call_,
                            .tid = thread.tid,
                            .number = static_cast<int>(number)};
  std::copy(std::begin(args), std::end(args), std::begin(thread.call.args));
  thread.call_is_taken = false;
  thread.state = SimThread::State::kInTrap;
  const std::uint64_t one = 1;
  TCS_CHECK(write(thread.process.trap_listener, &one, sizeof one) == sizeof one);
  has_said_ = true;
  Stop();
  return thread.result;
}

void Kernel::BlockFor(std::int64_t ns) {
  SimThread& thread = *running_;
  thread.state = SimThread::State::kInKernel;
  thread.wakes_at_ns = now_ns_ + ns;
  Stop();
}

void Kernel::SetBlocked(std::uint64_t signals) {
  running_->blocked_signals = signals;
  Deliver(*running_);
}

// As the kernel does before a thread goes back to its program.
void Kernel::Deliver(SimThread& thread) {
  if (!thread.preemption.has_value() ||
      (thread.blocked_signals & BitOf(shm::kPreemptionSignal)) != 0)
    return;
  siginfo_t info{};
  info.si_signo = shm::kPreemptionSignal;
  info.si_code = SI_QUEUE;
  info.si_value.sival_ptr =
      reinterpret_cast<void*>(*std::exchange(thread.preemption, std::nullopt));
  ucontext_t context{};
  const std::uint64_t before = std::exchange(thread.blocked_signals, ~std::uint64_t{0});
  __builtin_memcpy(&context.uc_sigmask, &before, sizeof before);
  reinterpret_cast<void (*)(int, siginfo_t*, void*)>(handler_)(shm::kPreemptionSignal, &info,
                                                               &context);
  thread.blocked_signals = before;
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
  thread->preemption = dispatch;
  const bool reaches = (thread->blocked_signals & BitOf(shm::kPreemptionSignal)) == 0;
  if (reaches && thread->state == SimThread::State::kAtWord) Wake(*thread, -EINTR);
}

std::optional<TrappedCall> Kernel::ReceiveTrapped(int listener) {
  for (SimThread& thread : threads_) {
    if (thread.state != SimThread::State::kInTrap || thread.call_is_taken ||
        thread.call.listener != listener)
      continue;
    thread.call_is_taken = true;
    std::uint64_t one;
    TCS_CHECK(read(listener, &one, sizeof one) == sizeof one);
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
    return true;
  }
  return false;
}

}  // namespace tcs::simulate
