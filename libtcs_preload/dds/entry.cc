// The shim's doors into Cyclone DDS: each name of calls.h jumps to wherever its slot says, so that
// nothing here knows the arguments of a call.
//
// A slot first leads to tcs_dds_resolve, which decides: where DDS is to use sockets, or endpoints
// cannot be had, to libddsc; else to the hooks of libtcs_dds.so, which is loaded when the program
// makes its first participant or domain. Nothing here refers to a symbol of libddsc: the shim is in
// programs that do not have it, too.
#include <dlfcn.h>
#include <link.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "libtcs_preload/dds/calls.h"
#include "libtcs_preload/dds/link.h"
#include "libtcs_preload/dds/shim_link.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"

using tcs::dds::kCalls;

extern "C" {
__attribute__((visibility("hidden"))) void* tcs_dds_slots[kCalls];
__attribute__((visibility("hidden"), used)) void* tcs_dds_resolve(unsigned call);
void tcs_dds_first();
}

// Keeps the arguments of a call while its slot is resolved; %r11 has the call's number.
__asm__(
    ".pushsection .text\n"
    ".hidden tcs_dds_first\n"
    ".type tcs_dds_first, @function\n"
    "tcs_dds_first:\n"
    "  .cfi_startproc\n"
    "  pushq %rbp\n"
    "  .cfi_def_cfa_offset 16\n"
    "  .cfi_offset %rbp, -16\n"
    "  movq %rsp, %rbp\n"
    "  .cfi_def_cfa_register %rbp\n"
    "  pushq %rdi\n  pushq %rsi\n  pushq %rdx\n  pushq %rcx\n  pushq %r8\n  pushq %r9\n"
    "  movl %r11d, %edi\n"
    "  call tcs_dds_resolve\n"
    "  movq %rax, %r11\n"
    "  popq %r9\n  popq %r8\n  popq %rcx\n  popq %rdx\n  popq %rsi\n  popq %rdi\n"
    "  popq %rbp\n"
    "  .cfi_def_cfa %rsp, 8\n"
    "  jmp *%r11\n"
    "  .cfi_endproc\n"
    ".size tcs_dds_first, . - tcs_dds_first\n"
    ".popsection\n");

// None of these functions has a floating-point argument: tcs_dds_first does not keep any.
#define TCS_DDS_DOOR(name)                                                            \
  TCS_EXPORT __attribute__((naked)) void name();                                      \
  TCS_EXPORT __attribute__((naked)) void name() {                                     \
    __asm__(                                                                          \
        "endbr64\n\tmovq tcs_dds_slots+%c0(%%rip), %%r11\n\t"                         \
        "testq %%r11, %%r11\n\tjz 1f\n\tjmp *%%r11\n"                                 \
        "1:\tmovl %1, %%r11d\n\tjmp tcs_dds_first" ::"i"(8 * tcs::dds::kCall_##name), \
        "i"(tcs::dds::kCall_##name));                                                 \
  }
TCS_DDS_CALLS(TCS_DDS_DOOR)

// A program that looks a function up in libddsc itself, as Python's ctypes does, is led to the door
// as well. Where that is not so, the C library's own dlsym goes on in this function's place:
// RTLD_NEXT depends on who has called.
extern "C" {
__attribute__((visibility("hidden"))) void* (*tcs_dds_real_dlsym)(void* library, const char* name);
__attribute__((visibility("hidden"), used)) void* tcs_dds_looked_up(void* library,
                                                                    const char* name);
}
TCS_EXPORT __attribute__((naked)) void* dlsym(void*, const char*) noexcept {
  __asm__(
      "endbr64\n\tpushq %rdi\n\tpushq %rsi\n\tsubq $8, %rsp\n\t"
      "call tcs_dds_looked_up\n\t"
      "addq $8, %rsp\n\tpopq %rsi\n\tpopq %rdi\n\t"
      "testq %rax, %rax\n\tjz 1f\n\tret\n"
      "1:\tmovq tcs_dds_real_dlsym(%rip), %r11\n\tjmp *%r11\n");
}

namespace tcs::preload {
namespace {

#define TCS_DDS_ADDRESS(name) reinterpret_cast<void*>(name),
void* const kDoors[kCalls] = {TCS_DDS_CALLS(TCS_DDS_ADDRESS)};

#define TCS_DDS_NAME(name) #name,
constexpr const char* kNames[kCalls] = {TCS_DDS_CALLS(TCS_DDS_NAME)};

constexpr char kLibrary[] = "libddsc.so.0debian";

#define TCS_DDS_COUNT(name) +1
constexpr unsigned kStartingCalls = 0 TCS_DDS_STARTING_CALLS(TCS_DDS_COUNT);

// Null: not started yet. The hooks of libtcs_dds.so, or kNoHooks where DDS uses sockets.
constexpr dds::Hook kNoHooks[] = {{nullptr, nullptr}};
const dds::Hook* g_hooks;
pthread_once_t g_start = PTHREAD_ONCE_INIT;

void Say(const char* text) {
  RawSyscall(SYS_write, STDERR_FILENO, reinterpret_cast<long>(text),
             static_cast<long>(strlen(text)));
}

[[noreturn]] void DieWithout(const char* name) {
  Say("tcs: a program calls ");
  Say(name);
  Say(" but libddsc cannot be found in it: link it with Debian's libddsc.so.0debian.\n");
  abort();
}

// Whatever library calls itself libddsc, as Python packages that bring their own do.
void* AnyLibrary() {
  static char path[4096];
  const auto is_it = [](dl_phdr_info* info, std::size_t, void*) {
    const char* slash = strrchr(info->dlpi_name, '/');
    if (slash == nullptr || strncmp(slash + 1, "libddsc", 7) != 0) return 0;
    if (strlen(info->dlpi_name) >= sizeof path) return 0;
    strcpy(path, info->dlpi_name);
    return 1;
  };
  return dl_iterate_phdr(is_it, nullptr) != 0 ? dlopen(path, RTLD_LAZY | RTLD_NOLOAD) : nullptr;
}

}  // namespace

void* LookUp(void* library, const char* name) {
  if (tcs_dds_real_dlsym == nullptr) {
    tcs_dds_real_dlsym =
        reinterpret_cast<decltype(tcs_dds_real_dlsym)>(dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5"));
  }
  return name != nullptr ? tcs_dds_real_dlsym(library, name) : nullptr;
}

namespace {

// True for a function of a library under the package's name, whichever of its links has led to it;
// copies that others bring are not meant.
bool IsInDebians(void* function) {
  Dl_info info{};
  if (function == nullptr || dladdr(function, &info) == 0) return false;
  const char* slash = strrchr(info.dli_fname, '/');
  return slash != nullptr && strncmp(slash, "/libddsc.so", 11) == 0;
}

// libddsc's own function.
void* Real(unsigned call) {
  if (void* found = dlsym(RTLD_NEXT, kNames[call]); found != nullptr) return found;
  // libddsc is there, but not for all: some library's, which was loaded later.
  void* library = dlopen(kLibrary, RTLD_LAZY | RTLD_NOLOAD);
  if (library == nullptr) library = AnyLibrary();
  void* found = library != nullptr ? LookUp(library, kNames[call]) : nullptr;
  if (found == nullptr) DieWithout(kNames[call]);
  return found;
}

const dds::Hook* Load(const char* path) {
  // libtcs_dds.so depends on this library, and must not bring in a second one.
  void* library = dlopen(kLibrary, RTLD_LAZY | RTLD_NOLOAD);
  if (library == nullptr) {
    Say("tcs: this program's Cyclone DDS is not Debian's libddsc.so.0debian, so its DDS uses "
        "sockets.\n");
    TellOfSockets(shm::WhySockets::kOtherLibrary);
    return kNoHooks;
  }
  void* hooks = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (hooks == nullptr) {
    Say("tcs: cannot load libtcs_dds.so, so this program's DDS uses sockets: ");
    Say(dlerror());
    Say("\n");
    TellOfSockets(shm::WhySockets::kNoLibraryOfOurs);
    return kNoHooks;
  }
  auto start = reinterpret_cast<dds::Start>(dlsym(hooks, dds::kStartSymbol));
  const dds::Hook* table = start != nullptr ? start(kDdsLink) : nullptr;
  if (table != nullptr) return table;
  TellOfSockets(shm::WhySockets::kOtherLibrary);
  return kNoHooks;
}

void Start() {
  char buffer[kDdsPathSize];
  const char* path = DdsLibrary(buffer);
  const dds::Hook* hooks = path != nullptr ? Load(path) : kNoHooks;
  __atomic_store_n(&g_hooks, hooks, __ATOMIC_RELEASE);
}

// A domain begins, and none of the starting calls came by: the program has looked them up in the
// library itself, as Python's ctypes does. Then other calls do not come by either.
void StartPastUs() {
  char buffer[kDdsPathSize];
  if (DdsLibrary(buffer) != nullptr) {
    Say("tcs: this program looks up Cyclone DDS's functions by itself, so its DDS uses sockets.\n");
    TellOfSockets(shm::WhySockets::kLooksUpItself);
  }
  __atomic_store_n(&g_hooks, &kNoHooks[0], __ATOMIC_RELEASE);
}

void* HookOf(const dds::Hook* hooks, const char* name) {
  for (const dds::Hook* hook = hooks; hook->name != nullptr; ++hook) {
    if (strcmp(hook->name, name) == 0) return hook->function;
  }
  return nullptr;
}

}  // namespace
}  // namespace tcs::preload

// Null: dlsym itself is to answer.
void* tcs_dds_looked_up(void* library, const char* name) {
  using namespace tcs::preload;
  if (tcs_dds_real_dlsym == nullptr) LookUp(nullptr, nullptr);
  if (library == RTLD_DEFAULT || library == RTLD_NEXT || name == nullptr) return nullptr;
  if (strncmp(name, "dds", 3) != 0) return nullptr;
  for (unsigned call = 0; call < kCalls; ++call) {
    if (strcmp(kNames[call], name) != 0) continue;
    return IsInDebians(LookUp(library, name)) ? kDoors[call] : nullptr;
  }
  return nullptr;
}

void* tcs_dds_resolve(unsigned call) {
  using namespace tcs::preload;
  if (call < kStartingCalls) pthread_once(&g_start, Start);
  if (call == tcs::dds::kCall_rtps_config_prep) pthread_once(&g_start, StartPastUs);
  const tcs::dds::Hook* hooks = __atomic_load_n(&g_hooks, __ATOMIC_ACQUIRE);
  // Before the start: libddsc's own function, for this once.
  if (hooks == nullptr) return Real(call);
  void* function = HookOf(hooks, kNames[call]);
  if (function == nullptr) function = Real(call);
  __atomic_store_n(&tcs_dds_slots[call], function, __ATOMIC_RELEASE);
  return function;
}
