#include "shm/machine_code/instruction.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace tcs::shm {
namespace {

Instruction Of(std::vector<std::uint8_t> bytes) {
  return Decode(bytes.data(), bytes.data() + bytes.size());
}

TEST(Instruction, EndsWhereItsOperandsDo) {
  EXPECT_EQ(Of({0x0f, 0x31}).size, 2);
  EXPECT_EQ(Of({0x0f, 0x01, 0xf9}).size, 3);
  EXPECT_EQ(Of({0x48, 0xc1, 0xe2, 0x20}).size, 4);                        // shl $32, %rdx
  EXPECT_EQ(Of({0x48, 0xb8, 1, 2, 3, 4, 5, 6, 7, 8}).size, 10);           // movabs
  EXPECT_EQ(Of({0x66, 0x81, 0x04, 0x25, 0, 0, 0, 0, 1, 2}).size, 10);     // addw, absolute
  EXPECT_EQ(Of({0xf6, 0x05, 0, 0, 0, 0, 1}).size, 7);                     // testb, rip
  EXPECT_EQ(Of({0xf7, 0xd8}).size, 2);                                    // neg
  EXPECT_EQ(Of({0xc4, 0xe3, 0x79, 0x0f, 0xc1, 4}).size, 6);               // vpalignr
  EXPECT_EQ(Of({0x62, 0xf1, 0x7c, 0x48, 0x10, 0x44, 0x24, 1}).size, 8);   // vmovups, zmm
  EXPECT_EQ(Of({0x66, 0x2e, 0x0f, 0x1f, 0x84, 0, 0, 0, 0, 0}).size, 10);  // a long nop
}

TEST(Instruction, IsNoneWhereItIsCutOffOrUnknown) {
  EXPECT_EQ(Of({0x48, 0xb8, 1, 2, 3}).size, 0);
  EXPECT_EQ(Of({0xe8, 0, 0}).size, 0);
  EXPECT_EQ(Of({0x06}).size, 0);
  EXPECT_EQ(Of({0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66, 0x66,
                0x66, 0x90})
                .size,
            0);
}

TEST(Instruction, SaysWhereItLeads) {
  const std::vector<std::uint8_t> branch{0x75, 0xfe};
  const Instruction back = Of(branch);
  EXPECT_EQ(back.flow, Flow::kBranch);
  EXPECT_EQ(back.Target(branch.data()), branch.data());
  EXPECT_TRUE(back.is_movable);
  EXPECT_EQ(Of({0xe9, 1, 0, 0, 0}).flow, Flow::kJump);
  EXPECT_EQ(Of({0xe9, 1, 0, 0, 0}).relative, 1);
  EXPECT_FALSE(Of({0xe8, 1, 0, 0, 0}).is_movable) << "what it calls would return elsewhere";
  EXPECT_FALSE(Of({0xe3, 0}).is_movable) << "jrcxz has no long form";
  EXPECT_EQ(Of({0xff, 0xe0}).flow, Flow::kJumpAnywhere);
  EXPECT_EQ(Of({0xc3}).flow, Flow::kEnd);
  EXPECT_EQ(Of({0x48, 0x8d, 0x05, 4, 0, 0, 0}).relative_at, 3);  // lea 4(%rip), %rax
}

// Real code of this machine, against what binutils say of it.
class RealCode : public testing::TestWithParam<const char*> {};

TEST_P(RealCode, EndsWhereObjdumpSays) {
  if (std::system("objdump --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no objdump here";
  const std::string command =
      "objdump -d -w -j .text '" + std::string(GetParam()) + "' 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  ASSERT_NE(pipe, nullptr);
  char line[512];
  int count = 0, wrong = 0;
  while (std::fgets(line, sizeof line, pipe.get()) != nullptr) {
    const std::string text = line;
    const std::size_t bytes_at = text.find(":\t"), name_at = text.find('\t', bytes_at + 2);
    if (bytes_at == std::string::npos || name_at == std::string::npos) continue;
    std::vector<std::uint8_t> bytes;
    for (std::size_t at = bytes_at + 2; at + 1 < name_at && text[at] != ' '; at += 3) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16)));
    }
    const std::size_t size = bytes.size();
    const std::string name = text.substr(name_at + 1);
    // Data between functions, and a wait of the floating-point unit that is shown as one with what
    // follows.
    if (name.find("(bad)") != std::string::npos || name.starts_with("rex") || bytes[0] == 0x9b) {
      continue;
    }
    bytes.resize(size + 15, 0x90);
    ++count;
    if (Of(bytes).size == size) continue;
    if (++wrong < 10)
      ADD_FAILURE() << text << " is said to have " << int{Of(bytes).size} << " bytes";
  }
  EXPECT_EQ(wrong, 0);
  if (count == 0) GTEST_SKIP() << "it is not here";
  std::printf("%d instructions of %s\n", count, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Libraries, RealCode,
                         testing::Values("/lib/x86_64-linux-gnu/libc.so.6",
                                         "/lib/x86_64-linux-gnu/libm.so.6",
                                         "/lib/x86_64-linux-gnu/libgmp.so.10",
                                         "/lib/x86_64-linux-gnu/libstdc++.so.6"));

}  // namespace
}  // namespace tcs::shm
