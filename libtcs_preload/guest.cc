#include "libtcs_preload/guest.h"

#include <errno.h>
#include <signal.h>
#include <sys/mman.h>

#include "libtcs_preload/attach.h"
#include "libtcs_preload/cycle_counter/lead_reads.h"
#include "libtcs_preload/environment.h"
#include "libtcs_preload/random.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/vdso.h"
#include "libtcs_preload/without_handlers.h"

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
int g_broker_fd = -1;

GuestThread* CurrentSlow() {
  GuestThread& thread = OwnState();
  if (g_process->mode == ProcessState::kPassThrough || thread.attaching) return nullptr;
  if (SocketName() == nullptr) {
    if (EnvironmentRemembered()) g_process->mode = ProcessState::kPassThrough;
    return nullptr;
  }
  if (g_process->mode == ProcessState::kFresh) ForgetSharers();
  const WithoutHandlers none;
  // A handler that came before may have done it.
  if (GuestThread* attached = IfAttached(); attached != nullptr) return attached;
  thread = GuestThread{};
  thread.attaching = true;
  Attach(thread, none.before());
  thread.attaching = false;
  g_process->mode = ProcessState::kAttached;
  SeedProcess(*thread.slot);
  if (thread.slot->patch_vdso != 0) PatchVdso();
  LeadReads({.counter = thread.slot->leads_counter != 0, .pauses = thread.slot->spin_gap_ns != 0});
  return &thread;
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
