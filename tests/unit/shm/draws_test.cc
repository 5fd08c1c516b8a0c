#include "shm/draws.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tcs::shm {
namespace {

constexpr char kUuid[] = "a81bf8bb-1faa-4a62-93ba-32add10b3500\n";

TEST(Draws, SeedsRepeat) {
  Draws a, b;
  a.Seed(7);
  b.Seed(7);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.Next(), b.Next());
}

// A program draws some hundred numbers, and the seeds of processes and of trials are neighbours.
TEST(Draws, NeighboursShareNothing) {
  constexpr std::uint64_t kBetweenRuns = 0x9e3779b97f4a7c15;
  std::set<std::uint64_t> seen;
  for (std::uint64_t run = 0; run < 10; ++run) {
    for (std::uint64_t process = 0; process < 10; ++process) {
      Draws draws;
      draws.Seed(run * kBetweenRuns + process);
      for (int i = 0; i < 100; ++i) EXPECT_TRUE(seen.insert(draws.Next()).second);
    }
  }
}

TEST(Draws, FillEveryByte) {
  Draws draws;
  char bytes[13] = {};
  bool changed[13] = {};
  for (int i = 0; i < 10; ++i) {
    draws.Fill(bytes, 12);
    for (int k = 0; k < 13; ++k) changed[k] = changed[k] || bytes[k] != 0;
  }
  for (int k = 0; k < 13; ++k) EXPECT_EQ(changed[k], k < 12);
}

TEST(Draws, IdentifiersKeepTheirForm) {
  Draws draws;
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    std::string text = kUuid;
    DrawUuid(draws, text.data(), 10);
    DrawUuid(draws, text.data() + 10, text.size() - 10, 10);
    EXPECT_TRUE(seen.insert(text).second);
    for (const std::size_t dash : {8, 13, 18, 23}) EXPECT_EQ(text[dash], '-');
    EXPECT_EQ(text[14], '4');
    EXPECT_NE(std::string("89ab").find(text[19]), std::string::npos);
    EXPECT_EQ(text.find_first_not_of("0123456789abcdef-\n"), std::string::npos);
    EXPECT_EQ(text.back(), '\n');
  }
}

}  // namespace
}  // namespace tcs::shm
