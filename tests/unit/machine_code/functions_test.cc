#include "shm/machine_code/functions.h"

#include <gtest/gtest.h>
#include <link.h>

#include <cstring>
#include <vector>

#include "shm/machine_code/image.h"

// A function of a known size, with a known one behind it.
__asm__(
    ".text\n\t.p2align 4\n"
    "tcs_test_sized:\n\t.cfi_startproc\n\tnop\n\tnop\n\tret\n\t.cfi_endproc\n\t.p2align 4\n"
    "tcs_test_next:\n\t.cfi_startproc\n\tret\n\t.cfi_endproc\n\t");
extern "C" {
void tcs_test_sized();
void tcs_test_next();
}

namespace tcs::shm {
namespace {

const std::uint8_t* At(void (*function)()) {
  return reinterpret_cast<const std::uint8_t*>(function);
}

Image OfThisTest() {
  Image image;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* found) {
        *static_cast<Image*>(found) =
            Image{reinterpret_cast<Code>(info->dlpi_addr), info->dlpi_phdr, info->dlpi_phnum};
        return 1;
      },
      &image);
  return image;
}

TEST(UnwindTable, KnowsWhereAFunctionBeginsAndEnds) {
  const UnwindTable table = OfThisTest().Functions();
  for (int i = 0; i < 3; ++i) {
    const CodeRange function = table.FunctionAt(At(tcs_test_sized) + i);
    EXPECT_EQ(function.begin, At(tcs_test_sized));
    EXPECT_EQ(function.end, At(tcs_test_sized) + 3);
  }
  EXPECT_TRUE(table.FunctionAt(At(tcs_test_sized) + 3).IsEmpty()) << "it is none's";
  EXPECT_EQ(table.GapAfter(table.FunctionAt(At(tcs_test_sized))).end, At(tcs_test_next));
  EXPECT_EQ(table.GapBefore(table.FunctionAt(At(tcs_test_next))).begin, At(tcs_test_sized) + 3);
}

TEST(UnwindTable, KnowsNothingOfWhatIsNotThere) {
  EXPECT_TRUE(UnwindTable().FunctionAt(At(tcs_test_sized)).IsEmpty());
  std::uint8_t other = 0;
  EXPECT_TRUE(OfThisTest().Functions().FunctionAt(&other).IsEmpty());
}

// Whatever a table says, nothing outside is read; a sanitizer or the end of the memory would tell.
TEST(UnwindTable, IsNotBelievedWhereItIsWrong) {
  for (std::uint32_t seed = 1; seed < 20000; ++seed) {
    std::vector<std::uint8_t> bytes(200);
    std::uint32_t state = seed;
    for (std::uint8_t& byte : bytes) {
      state = state * 1664525 + 1013904223;
      byte = static_cast<std::uint8_t>(state >> 24);
    }
    const std::uint8_t head[] = {
        1, 0x1b, 0x03, 0x3b, 0, 0, 0, 0, static_cast<std::uint8_t>(seed % 12), 0, 0, 0};
    memcpy(bytes.data(), head, sizeof head);
    for (std::size_t at = sizeof head; at < 100; at += 4) {
      const std::int32_t near = static_cast<std::int8_t>(bytes[at]);
      memcpy(&bytes[at], &near, sizeof near);
    }
    const CodeRange all{bytes.data(), bytes.data() + bytes.size()};
    const UnwindTable table(bytes.data(), all, all);
    for (std::size_t i = 0; i < bytes.size(); i += 20) {
      const CodeRange function = table.FunctionAt(bytes.data() + i);
      EXPECT_TRUE(function.IsEmpty() || function.end <= all.end);
    }
  }
}

}  // namespace
}  // namespace tcs::shm
