#include "libtcs_preload/posix_timers.h"

#include <pthread.h>
#include <stdlib.h>
#include <sys/mman.h>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

namespace {

constexpr int kRoom = 1024;
constexpr std::size_t kHelperStack = 256 * 1024;

struct Table {
  PosixTimer timers[kRoom];
};
Table* g_table = nullptr;

Table* GetTable() {
  Table* table = __atomic_load_n(&g_table, __ATOMIC_ACQUIRE);
  if (table != nullptr) return table;
  const long made = RawSyscall(SYS_mmap, 0, sizeof(Table), PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (made < 0 && made > -4096) return nullptr;
  RawSyscall(SYS_madvise, made, sizeof(Table), MADV_WIPEONFORK);
  Table* mine = reinterpret_cast<Table*>(made);
  if (__atomic_compare_exchange_n(&g_table, &table, mine, false, __ATOMIC_ACQ_REL,
                                  __ATOMIC_ACQUIRE)) {
    return mine;
  }
  RawSyscall(SYS_munmap, made, sizeof(Table));
  return table;
}

PosixTimer::State StateOf(const PosixTimer& timer) {
  return __atomic_load_n(&timer.state, __ATOMIC_ACQUIRE);
}

struct Call {
  void (*function)(sigval);
  sigval value;
};

void* RunFunction(void* raw) {
  const Call call = *static_cast<Call*>(raw);
  free(raw);
  call.function(call.value);
  return nullptr;
}

void StartFunction(PosixTimer& timer) {
  // Allocates as thread.cc does, where a thread is made.
  auto* call = static_cast<Call*>(malloc(sizeof(Call)));
  if (call == nullptr) return;
  *call = Call{timer.function, timer.value};
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  pthread_attr_setstacksize(&attributes, timer.stack_size);
  pthread_attr_setguardsize(&attributes, timer.guard_size);
  pthread_t thread;
  if (pthread_create(&thread, &attributes, RunFunction, call) != 0) free(call);
  pthread_attr_destroy(&attributes);
}

void* RunHelper(void* raw) {
  PosixTimer& timer = *static_cast<PosixTimer*>(raw);
  while (StateOf(timer) == PosixTimer::kLive) {
    GuestThread* t = Current();
    if (t == nullptr || IsShutDown()) break;
    CallFile file(*t, timer.timer_fd);
    AwaitFd(file, POLLIN, shm::kNeverNs);
    std::uint64_t count = 0;
    if (RawSyscall(SYS_read, timer.timer_fd, Arg(&count), sizeof count) != sizeof count) break;
    if (StateOf(timer) != PosixTimer::kLive) break;
    __atomic_store_n(&timer.overruns, static_cast<int>(count - 1), __ATOMIC_RELAXED);
    StartFunction(timer);
  }
  RawSyscall(SYS_close, timer.timer_fd);
  FreePosixTimer(&timer);
  return nullptr;
}

}  // namespace

PosixTimer* ClaimPosixTimer() {
  Table* table = GetTable();
  if (table == nullptr) return nullptr;
  for (PosixTimer& timer : table->timers) {
    PosixTimer::State expected = PosixTimer::kFree;
    if (__atomic_compare_exchange_n(&timer.state, &expected, PosixTimer::kTaken, false,
                                    __ATOMIC_ACQ_REL, __ATOMIC_RELAXED)) {
      return &timer;
    }
  }
  return nullptr;
}

PosixTimer* FindPosixTimer(timer_t name) {
  Table* table = __atomic_load_n(&g_table, __ATOMIC_ACQUIRE);
  if (table == nullptr) return nullptr;
  const auto id = reinterpret_cast<std::int64_t>(name);
  for (PosixTimer& timer : table->timers) {
    if (timer.id == id && StateOf(timer) == PosixTimer::kLive) return &timer;
  }
  return nullptr;
}

void FreePosixTimer(PosixTimer* timer) {
  timer->id = 0;
  __atomic_store_n(&timer->state, PosixTimer::kFree, __ATOMIC_RELEASE);
}

bool StartTimerThread(PosixTimer* timer) {
  // The helper takes no signal of the program's, nor do the threads that it starts, as in the C
  // library, which needs two itself: SIGCANCEL and SIGSETXID.
  const unsigned long all = ~(3ul << 31);
  unsigned long before = 0;
  RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&all), Arg(&before), sizeof all);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  pthread_attr_setstacksize(&attributes, kHelperStack);
  pthread_t thread;
  const int error = pthread_create(&thread, &attributes, RunHelper, timer);
  pthread_attr_destroy(&attributes);
  RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&before), 0, sizeof before);
  return error == 0;
}

}  // namespace tcs::preload
