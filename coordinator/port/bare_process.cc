#include "coordinator/port/bare_process.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/rseq.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>

namespace tcs {

namespace {

// The one page is code, the other what it reads and writes.
constexpr std::size_t kPage = 4096;
struct Data {
  std::uint64_t read = 0, written = 1;
  sched_param parameters{};
};
static_assert(offsetof(Data, written) == 8 && offsetof(Data, parameters) == 16);

// The code uses no stack, for the stack is unmapped, too. rdi: the first page; esi: the policy.
asm(R"(
  .pushsection .rodata
tcs_bare_relay_begin:
  mov %rdi, %rbx
  mov %esi, %r12d
  xor %edi, %edi              # munmap what is before the pages
  mov %rbx, %rsi
  mov $11, %eax
  syscall
  lea 8192(%rbx), %rdi        # and what is behind them
  movabs $0x7ffffffff000, %rsi
  sub %rdi, %rsi
  mov $11, %eax
  syscall
  xor %edi, %edi              # sched_setscheduler
  mov %r12d, %esi
  lea 4096+16(%rbx), %rdx
  mov $144, %eax
  syscall
1:
  xor %edi, %edi              # read
  lea 4096(%rbx), %rsi
  mov $8, %edx
  xor %eax, %eax
  syscall
  cmp $8, %rax
  jne 2f
  mov $1, %edi                # write
  lea 4096+8(%rbx), %rsi
  mov $8, %edx
  mov $1, %eax
  syscall
  cmp $8, %rax
  je 1b
2:
  xor %edi, %edi              # exit_group
  mov $231, %eax
  syscall
  hlt
tcs_bare_relay_end:
  .popsection
)");
extern "C" const char tcs_bare_relay_begin[], tcs_bare_relay_end[];

// The C library has told the kernel of memory into which the kernel is to write where the thread
// runs.
bool TakeBackRseq() {
  if (__rseq_size == 0) return true;
  char* area = static_cast<char*>(__builtin_thread_pointer()) + __rseq_offset;
  constexpr unsigned kUnregister = 1;
  for (const unsigned size : {32u, 64u, 96u, 128u, __rseq_size}) {
    if (syscall(SYS_rseq, area, size, kUnregister, RSEQ_SIG) == 0) return true;
  }
  return false;
}

}  // namespace

void RelayInBareProcess(int policy, int priority) {
  void* pages =
      mmap(nullptr, 2 * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) return;
  char* code = static_cast<char*>(pages);
  std::memcpy(code, tcs_bare_relay_begin,
              static_cast<std::size_t>(tcs_bare_relay_end - tcs_bare_relay_begin));
  const Data data{.parameters = {priority}};
  std::memcpy(code + kPage, &data, sizeof data);
  if (mprotect(code, kPage, PROT_READ | PROT_EXEC) != 0 || !TakeBackRseq()) {
    munmap(pages, 2 * kPage);
    return;
  }
  // No handler of this program's will be there any more.
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  reinterpret_cast<void (*)(char*, int)>(code)(code, policy);
}

}  // namespace tcs
