#include "shm/machine_code/spin_loop.h"

#include <gtest/gtest.h>

#include <vector>

namespace tcs::shm {
namespace {

// A function, and where in it a thread is.
bool Spins(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::vector<std::uint8_t> code = bytes;
  code.resize(bytes.size() + 16, 0xcc);
  return IsInSpinLoop(code.data() + at, [&](Code from, std::size_t size) {
    return code.data() <= from && from + size <= code.data() + code.size();
  });
}

TEST(SpinLoop, LooksAtOnePlace) {
  // 0: mov (%rdi), %eax; test %eax, %eax; je 0; ret
  const std::vector<std::uint8_t> loop{0x8b, 0x07, 0x85, 0xc0, 0x74, 0xfa, 0xc3};
  EXPECT_TRUE(Spins(loop, 0));
  EXPECT_TRUE(Spins(loop, 2));
  EXPECT_TRUE(Spins(loop, 4));
  EXPECT_FALSE(Spins(loop, 6));
}

TEST(SpinLoop, MayCountAndPause) {
  // 0: cmpb $0, (%rsi); jne 10; pause; dec %ecx; jne 0; 11: ret
  EXPECT_TRUE(Spins({0x80, 0x3e, 0x00, 0x75, 0x06, 0xf3, 0x90, 0xff, 0xc9, 0x75, 0xf5, 0xc3}, 5));
}

TEST(SpinLoop, MayFollowAPointerThatIsReadEachTime) {
  // 0: mov (%rdi), %rax; mov (%rax), %eax; test %eax, %eax; je 0
  EXPECT_TRUE(Spins({0x48, 0x8b, 0x07, 0x8b, 0x00, 0x85, 0xc0, 0x74, 0xf7}, 0));
}

TEST(SpinLoop, MayTryALock) {
  // 0: mov %edx, %eax; xchg %eax, (%rdi); test %eax, %eax; jne 0
  EXPECT_TRUE(Spins({0x89, 0xd0, 0x87, 0x07, 0x85, 0xc0, 0x75, 0xf8}, 4));
  // 0: xor %eax, %eax; lock cmpxchg %edx, (%rdi); jne 0
  EXPECT_TRUE(Spins({0x31, 0xc0, 0xf0, 0x0f, 0xb1, 0x17, 0x75, 0xf8}, 0));
}

TEST(SpinLoop, IsNoneThatGoesThroughMemory) {
  // 0: add (%rdi), %eax; add $4, %rdi; cmp %rsi, %rdi; jne 0
  EXPECT_FALSE(Spins({0x03, 0x07, 0x48, 0x83, 0xc7, 0x04, 0x48, 0x39, 0xf7, 0x75, 0xf5}, 0));
  // A list: 0: mov (%rax), %rax; test %rax, %rax; jne 0
  const std::vector<std::uint8_t> list{0x48, 0x8b, 0x00, 0x48, 0x85, 0xc0, 0x75, 0xf8};
  EXPECT_FALSE(Spins(list, 0));
  EXPECT_FALSE(Spins(list, 3));
}

TEST(SpinLoop, IsNoneThatStoresOrCalls) {
  // 0: mov (%rdi), %eax; mov %eax, (%rsi); test %eax, %eax; je 0
  EXPECT_FALSE(Spins({0x8b, 0x07, 0x89, 0x06, 0x85, 0xc0, 0x74, 0xf8}, 0));
  // 0: call 5; 5: cmpl $0, (%rdi); je 0
  EXPECT_FALSE(Spins({0xe8, 0, 0, 0, 0, 0x83, 0x3f, 0x00, 0x74, 0xf6}, 5));
}

TEST(SpinLoop, IsNoneThatLooksAtNothing) {
  // 0: dec %ecx; jne 0
  EXPECT_FALSE(Spins({0xff, 0xc9, 0x75, 0xfc}, 0));
  // 0: jmp 0
  EXPECT_FALSE(Spins({0xeb, 0xfe}, 0));
}

TEST(SpinLoop, EndsWhereCodeCannotBeRead) {
  // 0: cmpl $0, (%rdi); jmp far away
  EXPECT_FALSE(Spins({0x83, 0x3f, 0x00, 0xe9, 0, 0, 0x10, 0}, 0));
}

}  // namespace
}  // namespace tcs::shm
