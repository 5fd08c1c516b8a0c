#include "shm/machine_code/unlisted_functions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace tcs::shm {
namespace {

class UnlistedFunction : public testing::Test {
 protected:
  UnlistedFunction() : bytes_(128, 0xcc) {
    begin_ = bytes_.data() + 32 - reinterpret_cast<std::uintptr_t>(bytes_.data()) % 16;
    // nop; rdtsc; je to the end; nop; ret; nop; ret
    const std::uint8_t function[] = {0x90, 0x0f, 0x31, 0x74, 0x02, 0x90, 0xc3, 0x90, 0xc3};
    std::copy(std::begin(function), std::end(function), begin_);
  }
  CodeRange code() const { return {bytes_.data(), bytes_.data() + bytes_.size()}; }

  std::vector<std::uint8_t> bytes_;
  std::uint8_t* begin_;
};

TEST_F(UnlistedFunction, EndsWhereAFillerFollowsAndNothingGoesOn) {
  const CodeRange function = FunctionWithoutEntry(code(), UnwindTable(), begin_ + 1);
  EXPECT_EQ(function.begin, begin_);
  EXPECT_EQ(function.end, begin_ + 9);
}

TEST_F(UnlistedFunction, IsNoneWithoutFillers) {
  for (std::uint8_t& byte : bytes_) byte = byte == 0xcc ? 0x90 : byte;
  EXPECT_TRUE(FunctionWithoutEntry(code(), UnwindTable(), begin_ + 1).IsEmpty());
}

TEST_F(UnlistedFunction, IsNoneWhereItIsNoCode) {
  begin_[7] = 0x06;
  EXPECT_TRUE(FunctionWithoutEntry(code(), UnwindTable(), begin_ + 8).IsEmpty());
}

}  // namespace
}  // namespace tcs::shm
