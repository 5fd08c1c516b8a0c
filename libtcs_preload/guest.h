// The shim's state inside a client process. The rules of this folder, because we are guests:
//
//   * no allocation, and no lock that the program could hold when it forks or is interrupted;
//   * the kernel is entered through RawSyscall (raw_syscall.h), the C library's own functions
//     through real.h;
//   * errno changes only where POSIX says so;
//   * everything is safe in a signal handler and in the child of a fork;
//   * mechanism only: who runs when is the coordinator's business.
//
// A process finds its coordinator through the environment (shm/attach_protocol.h). Without the
// variable the shim lets every call through. With the variable, but with no coordinator behind it,
// the process ends: one line on stderr, exit status 127.
#pragma once

#include <atomic>
#include <cstdint>

#include "shm/layout.h"

#define TCS_EXPORT extern "C" __attribute__((visibility("default")))

namespace tcs::preload {

inline constexpr int kNoCoordinatorExit = 127;

struct GuestThread {
  shm::ThreadSlot* slot = nullptr;
  std::uint32_t index = 0;
  std::int32_t pid = 0, tid = 0;  // of the attached thread, as it finds them itself
  int depth = 0;                  // exchanges under way; above 1 in a handler that interrupted one
  bool attaching = false;
  std::uint32_t handlers = 0;  // handlers of the program's that have begun in the thread
  // The thread has begun a call since it last waited for its turn (exchange.h); where the thread's
  // own clock keeps it from going on, a call whose end others may see.
  bool in_call = false;
  std::uint64_t told_dispatch = ~std::uint64_t{0};  // began in an unseen call, which was told
  bool passes_on = false;                           // others wait for what is left (fd_wait.h)
  bool keeps_files = false;  // the coordinator keeps them, for the thread's call (call_file.h)
  bool posts = false;        // the thread puts something into its command ring
  // Sockets, by their cookies, from which the thread may post (posting.cc); the next socket goes to
  // this place.
  std::uint64_t posting_sockets[4] = {};
  std::uint32_t posting_socket = 0;
  std::uint64_t own_work_tsc =
      0;  // since then the shim works for a call (own_work.h); 0: it does not
  std::uint64_t look_ticks = 0;      // what the shim's last look has taken
  std::uint64_t own_work_ticks = 0;  // in all
  std::int64_t cpu_shown_ns = 0;     // the thread's charged processor time as it was last shown
  // Locks taken in a row, since the value by which allocation_cost.cc tells a row was `locks_at`.
  int locks = 0;
  std::int64_t locks_at = 0;
};

// Kept in a page that a fork leaves zeroed in the child, so that the child knows it has no slot
// yet.
struct ProcessState {
  enum Mode : std::uint32_t { kFresh = 0, kAttached = 1, kPassThrough = 2 };
  Mode mode;
  bool has_timer_fds;  // the timers that timer_fds.h remembers are of this process
  // The process's broker (descriptor_broker.h): the broker's number, which the kernel clears at its
  // end; how far the broker is; and that a thread is making one.
  std::atomic<int> broker;
  std::atomic<std::uint32_t> broker_state, makes_broker;
};

extern ProcessState* g_process;
extern __thread GuestThread t_thread __attribute__((tls_model("initial-exec")));
extern const shm::RunMemory* g_run;     // mapped once per process image; forks inherit the mapping,
extern const shm::RunHeader* g_header;  // which begins with this
extern int
    g_notify_fd;  // write end of the process's notification pipe, close-on-exec, at a high number
extern int g_broker_fd;  // the broker's connection, likewise; -1: there are none

// Attaches the process or thread if it is not yet; null: let the call through.
GuestThread* CurrentSlow();

// The calling thread's state where other threads find the same `t_thread`: threads that were made
// by the system call without CLONE_SETTLS have their maker's thread-local storage
// (shared_storage.cc).
GuestThread& StateInSharedStorage();
// For the child of a fork: the sharers are not its threads.
void ForgetSharers();

// The calling thread's own state. A child by fork or by a bare clone still has its parent's slot in
// `t_thread`, but not that slot's memory.
inline GuestThread& OwnState() {
  const bool is_shared = g_process->mode == ProcessState::kAttached && t_thread.slot != nullptr &&
                         t_thread.slot->clock.shares_storage.load(std::memory_order_relaxed) != 0;
  return __builtin_expect(is_shared, 0) ? StateInSharedStorage() : t_thread;
}

// The calling thread if it is attached, else null; attaches nobody.
inline GuestThread* IfAttached() {
  GuestThread& thread = OwnState();
  const bool is_attached = g_process->mode == ProcessState::kAttached && thread.slot != nullptr;
  return __builtin_expect(is_attached, 1) ? &thread : nullptr;
}

// The calling thread, attached; null where calls are to be let through.
inline GuestThread* Current() {
  GuestThread* t = IfAttached();
  return t != nullptr ? t : CurrentSlow();
}

// Charges a set cost: of a call, or of an allocation.
void Charge(shm::ClockPage& page, std::int64_t cost_ns);

// Where only its gate holds the thread: false if the thread runs on though others have their turn.
inline bool IsDispatched(const GuestThread& thread) { return thread.slot->clock.horizon_ns != 0; }

// Whether an interposed call concerns others. A call that concerns nobody but its thread neither
// does anything that others could see nor looks at what they do: it reads a clock.
enum class Concern { kOthers, kNobody };

// Counts an interposed call, and charges it where it has a set cost. Where nothing but its gate
// keeps the thread from running on, the thread first waits at the gate until it may; for a call
// that concerns nobody, only if the thread has not come back from there, or if its last call
// concerned others.
void CountCall(GuestThread& thread, Concern concern);

// The thread is about to do something that others may see, as a descriptor that becomes ready.
inline void BeginChange(GuestThread& thread) { thread.in_call = true; }

// As Current, for an interposed call, which is counted where calls are counted.
inline GuestThread* Enter(Concern concern = Concern::kOthers) {
  GuestThread* t = Current();
  if (t != nullptr && __builtin_expect(t->slot->clock.counts_work != 0, 0)) CountCall(*t, concern);
  return t;
}

// An interposed call, from here to the end of the scope. The object is used as a pointer to the
// thread, null where the call is to be let through. Meanwhile the coordinator sees that the thread
// may be about to look at what others do, or to do something to them.
class Entered {
 public:
  // `is_sound`: false for a call that the kernel will refuse, which is let through.
  explicit Entered(bool is_sound = true) : thread_(is_sound ? Enter() : nullptr) {
    if (thread_ != nullptr) Count(1);
  }
  // A child by fork has a slot that knows nothing of its parent's calls.
  ~Entered() {
    const bool counts = thread_ != nullptr && thread_->slot != nullptr;
    if (counts && thread_->slot->open_calls.load(std::memory_order_relaxed) != 0) Count(-1u);
  }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;

  GuestThread* thread() const { return thread_; }
  operator GuestThread*() const { return thread_; }
  GuestThread* operator->() const { return thread_; }

 private:
  // No other thread writes the count.
  void Count(std::uint32_t more) const {
    std::atomic<std::uint32_t>& calls = thread_->slot->open_calls;
    calls.store(calls.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
  }

  GuestThread* const thread_;
};

// True once the run is over: waits are no longer the coordinator's.
inline bool IsShutDown() { return g_header->shutdown.load(std::memory_order_relaxed) != 0; }

// Ends the process because its coordinator is gone.
[[noreturn]] void DieWithoutCoordinator(const char* what);

// True for a descriptor of the shim's own, which the program must not close or replace.
inline bool IsOwnDescriptor(int fd) { return fd >= 0 && (fd == g_notify_fd || fd == g_broker_fd); }

}  // namespace tcs::preload
