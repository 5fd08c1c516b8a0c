// Signals to others. The kernel carries and delivers them. The coordinator learns from the sender
// that a waiting thread has to run a handler now.
#include <errno.h>
#include <pthread.h>
#include <signal.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/own_work.h"
#include "libtcs_preload/pthread_id.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;
using tcs::shm::kSendsByLibrary;
using tcs::shm::kSendsItself;

namespace {

// The receiver of a signal: as for kill(2), and the thread, if it is known.
struct Receiver {
  pid_t process;
  pid_t thread = 0;
};

Receiver ReceiverOf(pthread_t thread) {
  const pid_t tid = TidOf(thread);
  return {static_cast<pid_t>(RawSyscall(SYS_getpid)), tid > 0 ? tid : 0};
}

// Sending is a write: no handler may run at an earlier time. A `call` that returns 0 has sent
// something. A signal of 0 only asks whether somebody is there. Should the thread be stopped
// between the signal and word of it, the coordinator sees from the thread's slot that there may be
// a signal: before the coordinator has seen to the receiver no other thread may run.
template <class Call>
auto SendSignal(Receiver receiver, int signal, std::uint32_t by, Call call) {
  const Entered t;
  if (t == nullptr || signal == 0) return call();
  const OwnWork own(t);
  HoldForWrite(*t);
  const pid_t process = receiver.process;
  if (g_header->turns_beside != 0 && process != 0 && process != RawSyscall(SYS_getpid)) {
    Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kSignals, .args = {process}});
  }
  std::atomic<std::uint32_t>& signals = t->slot->signals;
  signals.fetch_add(by, std::memory_order_relaxed);
  const auto result = AsProgram(*t, call);
  if (result == 0) {
    Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kSignalled,
                         .args = {process > 0 ? process : 0, receiver.thread, signal}});
  }
  signals.fetch_sub(by, std::memory_order_relaxed);
  return result;
}

// Sends a signal as SendSignal's call. Where only gates keep threads apart the signal must come to
// no thread that is about to make a call which the kernel hands over: once more it is the turn of
// the coordinator, which sees to that (engine/gate_keeper.h). The C library's calls are handed over
// themselves.
template <class... Args>
long SendRaw(long number, Args... args) {
  GuestThread* t = IfAttached();
  if (t != nullptr && g_header->is_unprivileged != 0 && t->slot->signals.load() != 0) AwaitTurn(*t);
  return RawSyscall(number, args...);
}

}  // namespace

TCS_EXPORT int kill(pid_t pid, int signal) noexcept {
  return static_cast<int>(ToErrno(
      SendSignal({pid}, signal, kSendsItself, [&] { return SendRaw(SYS_kill, pid, signal); })));
}

TCS_EXPORT int killpg(pid_t group, int signal) noexcept {
  if (group < 0) return Fail(EINVAL);
  return kill(-group, signal);
}

TCS_EXPORT int tgkill(pid_t pid, pid_t tid, int signal) {
  return static_cast<int>(ToErrno(SendSignal(
      {pid, tid}, signal, kSendsItself, [&] { return SendRaw(SYS_tgkill, pid, tid, signal); })));
}

// The C library's own would be handed over to the coordinator.
TCS_EXPORT int raise(int signal) noexcept {
  const auto pid = static_cast<pid_t>(RawSyscall(SYS_getpid));
  const auto tid = static_cast<pid_t>(RawSyscall(SYS_gettid));
  return tgkill(pid, tid, signal);
}

TCS_EXPORT int sigqueue(pid_t pid, int signal, const sigval value) noexcept {
  return SendSignal({pid}, signal, kSendsByLibrary,
                    [&] { return TCS_REAL(sigqueue)(pid, signal, value); });
}

TCS_EXPORT int pthread_kill(pthread_t thread, int signal) noexcept {
  return SendSignal(ReceiverOf(thread), signal, kSendsByLibrary,
                    [&] { return TCS_REAL(pthread_kill)(thread, signal); });
}

TCS_EXPORT int pthread_sigqueue(pthread_t thread, int signal, const sigval value) noexcept {
  return SendSignal(ReceiverOf(thread), signal, kSendsByLibrary,
                    [&] { return TCS_REAL(pthread_sigqueue)(thread, signal, value); });
}

// The C library sends its own signal for this only to threads in system calls of its making. The
// shim's waits are to end by that signal, too.
TCS_EXPORT int pthread_cancel(pthread_t thread) {
  constexpr int kCancelSignal = 32;
  const bool own = pthread_equal(thread, pthread_self()) != 0;
  const Receiver receiver = ReceiverOf(thread);
  return SendSignal(receiver, kCancelSignal, kSendsItself, [&] {
    const int error = TCS_REAL(pthread_cancel)(thread);
    if (error == 0 && !own && receiver.thread > 0) {
      SendRaw(SYS_tgkill, receiver.process, receiver.thread, kCancelSignal);
    }
    return error;
  });
}
