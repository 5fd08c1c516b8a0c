// The processor's cycle counter, by each instruction that reads it: it goes on at one rate with
// CLOCK_MONOTONIC, in every thread, library and child, and reading it changes nothing else.
#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/wait.h>
#include <x86intrin.h>

#include "tests/conformance/conformance.h"
#include "tests/conformance/cycle_counter_library.h"

using namespace conformance;

namespace {

std::uint64_t Plain() { return __rdtsc(); }

std::uint64_t Serialized() {
  unsigned processor;
  return __rdtscp(&processor);
}

std::uint64_t Fenced() {
  _mm_lfence();
  return __rdtsc();
}

// As GCC writes it where only the lower half is wanted.
std::uint64_t LowerHalf() {
  std::uint32_t low;
  __asm__ volatile("lfence\n\trdtsc" : "=a"(low) : : "rdx");
  return low;
}

// Two instructions beside each other, of which each is in the other's way.
std::uint64_t Twice() {
  std::uint32_t low, high;
  __asm__ volatile("rdtsc\n\trdtsc" : "=a"(low), "=d"(high));
  return std::uint64_t{high} << 32 | low;
}

// A loop whose jump leads right behind the instruction, as Go's runtime has it.
std::uint64_t JumpedTo() {
  std::uint64_t result;
  std::uint32_t high;
  __asm__ volatile(
      "testb $1, %%spl\n\tjnz 2f\n\t"
      "rdtscp\n"
      "1:\tshlq $32, %%rdx\n\taddq %%rdx, %%rax\n\tjmp 3f\n"
      "2:\tmfence\n\tlfence\n\trdtsc\n\tjmp 1b\n3:"
      : "=a"(result), "=d"(high)
      :
      : "rcx", "cc");
  return result;
}

using Read = std::uint64_t();
struct Form {
  Read* read;
  const char* name;
  bool is_whole = true;
};
constexpr Form kForms[] = {{Plain, "rdtsc"},          {Serialized, "rdtscp"},
                           {Fenced, "lfence; rdtsc"}, {LowerHalf, "the lower half", false},
                           {Twice, "two of them"},    {JumpedTo, "behind a label"},
                           {Plain, "rdtsc once more"}};

// In ticks per ns, which is GHz. The counter is read between two readings of the clock, at both
// ends: others may have the processor in between, and then the rate is one of these.
struct Rate {
  double least, most;
  double Middle() const { return (least + most) / 2; }
};
Rate g_rate{};

Rate MeasureRate(Read* read) {
  const std::int64_t start = Now();
  const std::uint64_t first = read();
  const std::int64_t begun = Now();
  usleep(100'000);
  const std::int64_t end = Now();
  const std::uint64_t last = read();
  const std::int64_t ended = Now();
  const auto ticks = static_cast<double>(last - first);
  return {ticks / static_cast<double>(ended - start), ticks / static_cast<double>(end - begun)};
}

// Half a percent apart is much: each is measured over 100 ms.
void ExpectRate(const Rate& rate, const char* what) {
  const double most = g_mode == Mode::kNative ? 0.05 : 0.002;
  EXPECT(rate.most > g_rate.least * (1 - most) && rate.least < g_rate.most * (1 + most),
         "%s: %.4f to %.4f GHz instead of %.4f to %.4f", what, rate.least, rate.most, g_rate.least,
         g_rate.most);
}

void SpinsEndInTime(const Form& form) {
  const double wanted = 20 * kMs * g_rate.Middle();
  const auto ticks = static_cast<std::uint64_t>(wanted);
  const std::int64_t start = Now();
  const std::uint64_t first = form.read();
  const std::int64_t begun = Now();
  if (form.is_whole) {
    while (form.read() - first < ticks) continue;
  } else {
    while (static_cast<std::uint32_t>(form.read() - first) < ticks) continue;
  }
  const std::int64_t end = Now();
  // Natively others may have the processor when it ends; where it is measured, the host.
  const std::int64_t late = g_mode == Mode::kNative     ? kSecond
                            : g_mode == Mode::kMeasured ? 5 * kMs
                                                        : 0;
  EXPECT(static_cast<double>(end - start) > wanted / g_rate.most * 0.99 &&
             static_cast<double>(end - begun - late) < wanted / g_rate.least * 1.01,
         "%s: a spin of 20 ms took %lld ns", form.name, (long long)(end - start));
}

void AllFormsAgree() {
  for (const Form& form : kForms) {
    if (form.is_whole) {
      const std::uint64_t before = Plain(), now = form.read(), after = Plain();
      EXPECT(before <= now && now <= after, "%s: %llu is not from %llu to %llu", form.name,
             (unsigned long long)now, (unsigned long long)before, (unsigned long long)after);
      ExpectRate(MeasureRate(form.read), form.name);
    }
    SpinsEndInTime(form);
  }
  unsigned processor = ~0u;
  __rdtscp(&processor);
  if (g_mode != Mode::kNative) EXPECT(processor < 64, "processor %u", processor);
}

// Sets each register, the flags and what is below the stack pointer, reads the counter, and says
// what has changed: 0 for nothing.
extern "C" unsigned ReadAndLookWhatChanges();
#define VALUE(i) "0x0102030405060700+" #i
__asm__(
    ".text\n\t.p2align 4\n\t.type ReadAndLookWhatChanges, @function\n"
    "ReadAndLookWhatChanges:\n\t.cfi_startproc\n\t"
    "pushq %rbx\n\t.cfi_adjust_cfa_offset 8\n\tpushq %rbp\n\t.cfi_adjust_cfa_offset 8\n\t"
    "pushq %r12\n\t.cfi_adjust_cfa_offset 8\n\tpushq %r13\n\t.cfi_adjust_cfa_offset 8\n\t"
    "pushq %r14\n\t.cfi_adjust_cfa_offset 8\n\tpushq %r15\n\t.cfi_adjust_cfa_offset 8\n\t"
#define SET(reg, i) "movabsq $" VALUE(i) ", %" #reg "\n\t"
#define VECTOR(reg, x) "movq %" #reg ", %xmm" #x "\n\tmovddup %xmm" #x ", %xmm" #x "\n\t"
    SET(rbx, 1) SET(rcx, 2) SET(rsi, 3) SET(rdi, 4) SET(rbp, 5) SET(r8, 6) SET(r9, 7) SET(r10, 8)
        SET(r11, 9) SET(r12, 10) SET(r13, 11) SET(r14, 12) SET(r15, 13)
            VECTOR(rbx, 0) VECTOR(rcx, 1) VECTOR(rsi, 2) VECTOR(rdi, 3) VECTOR(rbp, 4)
                VECTOR(r8, 5) VECTOR(r9, 6) VECTOR(r10, 7) VECTOR(r11, 8) VECTOR(r12, 9)
                    VECTOR(r13, 10) VECTOR(r14, 11) VECTOR(r15, 12) VECTOR(rbx, 13)
                        VECTOR(rcx, 14) VECTOR(rsi, 15)
    "movq %rbx, -8(%rsp)\n\tmovq %rcx, -64(%rsp)\n\tmovq %rsi, -128(%rsp)\n\t"
    "movb $0x7f, %al\n\taddb $1, %al\n\tstc\n\t"  // the flags of overflow, sign and carry
    "rdtsc\n\t"
    "movl $1, %eax\n\tjno 9f\n\tjns 9f\n\tjnc 9f\n\t"
    "movl $2, %eax\n\tcmpq %rbx, -8(%rsp)\n\tjne 9f\n\tcmpq %rcx, -64(%rsp)\n\tjne 9f\n\t"
    "cmpq %rsi, -128(%rsp)\n\tjne 9f\n\t"
#define SAME(reg, i) \
  "movabsq $" VALUE(i) ", %rdx\n\tincl %eax\n\tcmpq %rdx, %" #reg "\n\tjne 9f\n\t"
#define SAME_VECTOR(reg, x)                                 \
  "incl %eax\n\tmovq %xmm" #x ", %rdx\n\tcmpq %rdx, %" #reg \
  "\n\tjne 9f\n\t"                                          \
  "movhlps %xmm" #x ", %xmm" #x "\n\tmovq %xmm" #x ", %rdx\n\tcmpq %rdx, %" #reg "\n\tjne 9f\n\t"
    SAME(rbx, 1) SAME(rcx, 2) SAME(rsi, 3) SAME(rdi, 4) SAME(rbp, 5) SAME(r8, 6) SAME(r9, 7)
        SAME(r10, 8) SAME(r11, 9) SAME(r12, 10) SAME(r13, 11) SAME(r14, 12) SAME(r15, 13)
            SAME_VECTOR(rbx, 0) SAME_VECTOR(rcx, 1) SAME_VECTOR(rsi, 2) SAME_VECTOR(rdi, 3)
                SAME_VECTOR(rbp, 4) SAME_VECTOR(r8, 5) SAME_VECTOR(r9, 6) SAME_VECTOR(r10, 7)
                    SAME_VECTOR(r11, 8) SAME_VECTOR(r12, 9) SAME_VECTOR(r13, 10)
                        SAME_VECTOR(r14, 11) SAME_VECTOR(r15, 12) SAME_VECTOR(rbx, 13)
                            SAME_VECTOR(rcx, 14) SAME_VECTOR(rsi, 15)
    "xorl %eax, %eax\n"
    "9:\n\tpopq %r15\n\t.cfi_adjust_cfa_offset -8\n\tpopq %r14\n\t.cfi_adjust_cfa_offset -8\n\t"
    "popq %r13\n\t.cfi_adjust_cfa_offset -8\n\tpopq %r12\n\t.cfi_adjust_cfa_offset -8\n\t"
    "popq %rbp\n\t.cfi_adjust_cfa_offset -8\n\tpopq %rbx\n\t.cfi_adjust_cfa_offset -8\n\t"
    "ret\n\t.cfi_endproc\n\t.size ReadAndLookWhatChanges, .-ReadAndLookWhatChanges\n\t");

// The upper halves of wide vectors, which other instructions use.
__attribute__((target("avx"))) bool KeepsWideVectors() {
  alignas(32) const std::uint64_t set[4] = {1, 2, 3, 4};
  alignas(32) std::uint64_t kept[4];
  std::uint32_t low, high;
  __asm__ volatile("vmovdqa %3, %%ymm9\n\tlfence\n\trdtsc\n\tvmovdqa %%ymm9, %2\n\tvzeroupper"
                   : "=a"(low), "=d"(high), "=m"(kept)
                   : "m"(set)
                   : "xmm9");
  return memcmp(set, kept, sizeof set) == 0;
}

// Long enough for turns to end in it.
void NothingElseChanges() {
  const bool has_wide = __builtin_cpu_supports("avx") != 0;
  const std::int64_t start = Now();
  while (Now() - start < 30 * kMs) {
    for (int i = 0; i < 100; ++i) {
      const unsigned what = ReadAndLookWhatChanges();
      EXPECT(what == 0, "number %u of what is looked at has changed", what);
      EXPECT(!has_wide || KeepsWideVectors(), "a wide vector has changed");
    }
  }
}

std::uint64_t g_said = 0;
sem_t g_turns[2];

// What another thread has read is never later than what is read after it has said so.
void* SayAndHear(void* own) {
  sem_t* const turns = static_cast<sem_t*>(own);
  for (int i = 0; i < 200; ++i) {
    while (sem_wait(turns) != 0) continue;
    const std::uint64_t now = Plain();
    EXPECT(now >= g_said, "%llu after %llu", (unsigned long long)now, (unsigned long long)g_said);
    g_said = now;
    sem_post(turns == g_turns ? g_turns + 1 : g_turns);
  }
  return nullptr;
}

void ThreadsAgree() {
  sem_init(g_turns, 0, 1);
  sem_init(g_turns + 1, 0, 0);
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, SayAndHear, g_turns + 1) == 0, "pthread_create");
  SayAndHear(g_turns);
  pthread_join(thread, nullptr);
}

void ALateLibraryAgrees() {
  for (int i = 0; i < 3; ++i) {  // it may come to another place
    const std::uint64_t before = Plain();
    void* library = dlopen(TCS_COUNTER_LIBRARY, RTLD_NOW);
    EXPECT(library != nullptr, "%s", dlerror());
    const std::uint64_t after = Plain();
    auto* loaded = reinterpret_cast<ReadWhenLoaded*>(dlsym(library, "ReadAsItWasLoaded"));
    EXPECT(before <= loaded() && loaded() <= after,
           "as it was loaded: %llu is not from %llu to %llu", (unsigned long long)loaded(),
           (unsigned long long)before, (unsigned long long)after);
    auto* read = reinterpret_cast<Read*>(dlsym(library, "ReadInLibrary"));
    ExpectRate(MeasureRate(read), "in a library");
    SpinsEndInTime({read, "in a library"});
    dlclose(library);
  }
}

void ChildrenAgree(char** argv) {
  const std::uint64_t before = Plain();
  const pid_t pid = fork();
  if (pid == 0) {
    EXPECT(Plain() >= before, "a child's counter went back");
    ExpectRate(MeasureRate(Plain), "in a child");
    char said[32], mode[16];
    snprintf(said, sizeof said, "%llu", (unsigned long long)Plain());
    snprintf(mode, sizeof mode, "%s", argv[1] == nullptr ? "native" : argv[1]);
    char* const arguments[] = {argv[0], mode, said, nullptr};
    execv("/proc/self/exe", arguments);
    _exit(1);
  }
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "the child: %#x", status);
  EXPECT(Plain() >= before, "the counter went back");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2) {
    g_mode = strcmp(argv[1], "native") == 0  ? Mode::kNative
             : strcmp(argv[1], "fixed") == 0 ? Mode::kFixed
                                             : Mode::kMeasured;
    g_rate = MeasureRate(Plain);
    EXPECT(Plain() >= strtoull(argv[2], nullptr, 10), "the counter went back at execve");
    SpinsEndInTime(kForms[0]);
    return 0;
  }
  Begin(argc, argv);
  g_rate = MeasureRate(Plain);
  if (g_mode == Mode::kFixed) {
    EXPECT(g_rate.least > 0.9999 && g_rate.most < 1.0001, "%.6f GHz", g_rate.Middle());
  }
  AllFormsAgree();
  NothingElseChanges();
  ThreadsAgree();
  ALateLibraryAgrees();
  ChildrenAgree(argv);
}
