#include "shm/machine_code/stand_in.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstring>
#include <vector>

#include "shm/machine_code/replacement_plan.h"

namespace tcs::shm {
namespace {

constexpr std::size_t kPage = 4096;

// A page for a function, and one for what stands in for its reads.
class Pages {
 public:
  Pages()
      : memory_(
            static_cast<std::uint8_t*>(mmap(nullptr, 2 * kPage, PROT_READ | PROT_WRITE | PROT_EXEC,
                                            MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))) {}
  ~Pages() { munmap(memory_, 2 * kPage); }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  bool are_there() const { return memory_ != MAP_FAILED; }
  std::uint8_t* function() { return memory_; }
  std::uint8_t* stand_ins() { return memory_ + kPage; }

 private:
  std::uint8_t* const memory_;
};

// What the function returns once its read gives 7 in eax and 9 in edx.
long Replaced(const std::vector<std::uint8_t>& bytes, std::size_t function_size, long argument) {
  Pages pages;
  if (!pages.are_there()) return -2;
  memcpy(pages.function(), bytes.data(), bytes.size());
  const CodeRange function{pages.function(), pages.function() + function_size};
  Code read = nullptr;
  ForEachLookingLikeARead(function, {}, [&](Code at) { read = read == nullptr ? at : read; });
  const UnwindTable none;
  Replacement replacement;
  ReplacementPlan plan(function, none);
  if (plan.NextIn(function, read, nullptr, 0, &replacement) != NotReplaced::kNo) return -1;
  CodeWriter writer(pages.stand_ins(), pages.stand_ins(), kPage);
  WriteStandIn(writer, replacement, {}, [](CodeWriter& code, Code) {
    code.Bytes({0xb8, 7, 0, 0, 0, 0xba, 9, 0, 0, 0});
  });
  EXPECT_TRUE(writer.is_sound());
  EXPECT_TRUE(LeadToStandIn(replacement, pages.stand_ins(),
                            [](Code at, const std::uint8_t* what, std::size_t size) {
                              memcpy(const_cast<std::uint8_t*>(at), what, size);
                            }));
  return reinterpret_cast<long (*)(long)>(pages.function())(argument);
}

constexpr long kRead = 9L << 32 | 7;

TEST(StandIn, DoesWhatTheFunctionDid) {
  // rdtsc; shl $32, %rdx; or %rdx, %rax; ret
  EXPECT_EQ(Replaced({0x0f, 0x31, 0x48, 0xc1, 0xe2, 0x20, 0x48, 0x09, 0xd0, 0xc3}, 10, 0), kRead);
}

TEST(StandIn, HasAllReadsThatGoTogether) {
  // rdtsc; mov %eax, %ecx; rdtsc; add %ecx, %eax; ret
  EXPECT_EQ(Replaced({0x0f, 0x31, 0x89, 0xc1, 0x0f, 0x31, 0x01, 0xc8, 0xc3}, 9, 0), 14);
}

TEST(StandIn, ReturnsWhereTheFunctionDid) {
  // rdtsc; lea 1(%rax), %eax; ret: all of it is moved.
  EXPECT_EQ(Replaced({0x0f, 0x31, 0x8d, 0x40, 0x01, 0xc3}, 6, 0), 8);
  // rdtsc; nop; nop; ret, with what follows left alone
  EXPECT_EQ(Replaced({0x0f, 0x31, 0x90, 0x90, 0xc3}, 5, 0), 7);
}

TEST(StandIn, ReadsWhatTheFunctionReadRelativeToItself) {
  // rdtsc; mov 5(%rip), %eax; ret; 4 bytes; the number
  EXPECT_EQ(
      Replaced({0x0f, 0x31, 0x8b, 0x05, 5, 0, 0, 0, 0xc3, 0x90, 0x90, 0x90, 0x90, 42, 0, 0, 0}, 9,
               0),
      42);
}

TEST(StandIn, BranchesToWhereTheFunctionDid) {
  // test %edi, %edi; jne 9; rdtscp; 7: nop; ret; 9: mov $1, %eax; jmp 7. What leads to 7 keeps the
  // read from going with what is behind it.
  const std::vector<std::uint8_t> function{0x85, 0xff, 0x75, 0x05, 0x0f, 0x01, 0xf9, 0x90,
                                           0xc3, 0xb8, 1,    0,    0,    0,    0xeb, 0xf7};
  EXPECT_EQ(Replaced(function, function.size(), 0), 7);
  EXPECT_EQ(Replaced(function, function.size(), 5), 1);
}

TEST(StandIn, IsNotMadeTooFarAway) {
  std::uint8_t out[16];
  CodeWriter writer(out, out, sizeof out);
  writer.Jump(out + (std::int64_t{1} << 32));
  EXPECT_FALSE(writer.is_sound());
  CodeWriter full(out, out, 4);
  full.Jump(out);
  EXPECT_FALSE(full.is_sound());
}

}  // namespace
}  // namespace tcs::shm
