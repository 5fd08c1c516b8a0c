// Where the first thread's stack begins. The kernel puts the environment and the arguments above
// it, so it would be elsewhere with another PATH, home directory or process number in a variable:
// and programs that order things by their addresses would do other things. Under set costs main
// begins at the same address.
#include <alloca.h>
#include <dlfcn.h>
#include <stdint.h>
#include <sys/resource.h>

#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"

namespace {

using Main = int (*)(int, char**, char**);
using StartMain = int(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);

// More than environments and arguments take, and little of the 8 MiB that a stack may have.
constexpr uintptr_t kRoom = 128 * 1024;

Main g_main = nullptr;

bool HasRoom() {
  rlimit64 limit{};
  tcs::preload::RawSyscall(SYS_prlimit64, 0, RLIMIT_STACK, 0, tcs::preload::Arg(&limit));
  return limit.rlim_cur >= 8 * kRoom;
}

__attribute__((noinline)) int MainAtFixedAddress(int argc, char** argv, char** environment) {
  const auto here = reinterpret_cast<uintptr_t>(__builtin_frame_address(0));
  void* const room = alloca(here % kRoom);
  __asm__ volatile("" : : "r"(room) : "memory");  // the room stays, although nothing is in it
  const int status = g_main(argc, argv, environment);
  __asm__ volatile("" : : "r"(room) : "memory");  // no tail call
  return status;
}

}  // namespace

// The C library begins the program here. Programs from before its version 2.34 have it call `init`,
// which that version's does not.
extern "C" __attribute__((visibility("default"))) int __libc_start_main(Main main, int argc,
                                                                        char** argv, void (*init)(),
                                                                        void (*fini)(),
                                                                        void (*end_loader)(),
                                                                        void* stack_end) {
  void* const found = init != nullptr ? dlvsym(RTLD_NEXT, "__libc_start_main", "GLIBC_2.2.5")
                                      : dlsym(RTLD_NEXT, "__libc_start_main");
  const auto real = reinterpret_cast<StartMain*>(found);
  const tcs::shm::RunHeader* const header = tcs::preload::g_header;
  if (header != nullptr && header->accounting == tcs::shm::Accounting::kFixed && HasRoom()) {
    g_main = main;
    main = MainAtFixedAddress;
  }
  return real(main, argc, argv, init, fini, end_loader, stack_end);
}
