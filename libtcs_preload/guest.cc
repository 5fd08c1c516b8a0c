#include "libtcs_preload/guest.h"

#include <errno.h>
#include <signal.h>
#include <sys/mman.h>

#include <utility>

#include "libtcs_preload/attach.h"
#include "libtcs_preload/cycle_counter/lead_reads.h"
#include "libtcs_preload/environment.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/porter.h"
#include "libtcs_preload/random.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/vdso.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/clock_page.h"

namespace tcs::preload {

namespace {

// Stands in until the constructor has run, and where the page cannot be had.
ProcessState g_unprotected_state{};

void ProtectProcessState() {
  const long page =
      RawSyscall(SYS_mmap, 0, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (page < 0 && page > -4096) return;
  if (RawSyscall(SYS_madvise, page, 4096, MADV_WIPEONFORK) != 0) return;
  g_process = reinterpret_cast<ProcessState*>(page);
}

// Runs before the constructors of every other library (-z initfirst).
__attribute__((constructor)) void Start(int, char**, char** envp) {
  RememberEnvironment(envp);
  ProtectProcessState();
  Current();
}

}  // namespace

ProcessState* g_process = &g_unprotected_state;
__thread GuestThread t_thread __attribute__((tls_model("initial-exec")));
const shm::RunMemory* g_run = nullptr;
const shm::RunHeader* g_header = nullptr;
int g_notify_fd = -1;
int g_porter_fd = -1;

GuestThread* CurrentSlow() {
  GuestThread& thread = OwnState();
  if (g_process->mode == ProcessState::kPassThrough || thread.attaching) return nullptr;
  if (SocketName() == nullptr) {
    if (EnvironmentRemembered()) g_process->mode = ProcessState::kPassThrough;
    return nullptr;
  }
  if (g_process->mode == ProcessState::kFresh) ForgetSharers();
  thread = GuestThread{};
  thread.attaching = true;
  Attach(thread);
  thread.attaching = false;
  g_process->mode = ProcessState::kAttached;
  SeedProcess(*thread.slot);
  if (thread.slot->patch_vdso != 0) PatchVdso();
  LeadReads({.counter = thread.slot->leads_counter != 0, .pauses = thread.slot->spin_gap_ns != 0});
  return &thread;
}

void Charge(shm::ClockPage& page, std::int64_t cost_ns) {
  std::uint64_t word = page.executed_adjust.load(std::memory_order_relaxed);
  while (!page.executed_adjust.compare_exchange_weak(
      word, shm::PackAdjust(word, shm::AdjustValue(word) + cost_ns))) {
  }
}

namespace {

// True once in a dispatch.
bool BeganInUnseenCall(GuestThread& thread) {
  const shm::ClockPage& page = thread.slot->clock;
  if ((page.counts_work & shm::kBeginsInCall) == 0) return false;
  const std::uint64_t dispatch = shm::DispatchNumber(page.executed_adjust.load());
  return std::exchange(thread.told_dispatch, dispatch) != dispatch;
}

}  // namespace

void CountCall(GuestThread& thread, Concern concern) {
  if (g_header->gates_only != 0) {
    KeepPorter();
    const bool is_fixed = g_header->accounting == shm::Accounting::kFixed;
    const bool has_to_wait = is_fixed && (concern == Concern::kOthers || !IsDispatched(thread));
    if (has_to_wait || thread.in_call || IsAtGate(thread) || BeganInUnseenCall(thread)) {
      AwaitTurn(thread);
    }
    thread.in_call = is_fixed && concern == Concern::kOthers;
  } else if ((thread.slot->clock.counts_work & shm::kIsAhead) != 0 && !IsAtGate(thread)) {
    AwaitTurn(thread);
  }
  ++thread.slot->work.calls;
  shm::ClockPage& page = thread.slot->clock;
  if (page.call_cost_ns == 0) return;
  Charge(page, page.call_cost_ns);
  // Not at the next look at a clock: that may be at the same place of a loop each time.
  NowNs(thread);
}

void DieWithoutCoordinator(const char* what) {
  static const char kPrefix[] = "tcs: this program runs under tcsim, but ";
  static const char kSuffix[] = "; it ends here\n";
  auto put = [](const char* text) {
    long n = 0;
    while (text[n] != '\0') ++n;
    RawSyscall(SYS_write, 2, Arg(text), n);
  };
  put(kPrefix);
  put(what);
  put(kSuffix);
  // A trapped end fails where nobody is there to be told of it.
  for (;;) {
    RawSyscall(SYS_exit_group, kNoCoordinatorExit);
    RawSyscall(SYS_kill, RawSyscall(SYS_getpid), SIGKILL);
  }
}

}  // namespace tcs::preload
