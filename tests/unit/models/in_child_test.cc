#include "coordinator/models/in_child.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <vector>

namespace tcs {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;

TEST(InChild, ReturnsWhatTheWorkReturned) {
  const std::string text(300'000, 'x');
  const ChildWork done = DoInChild([&text] { return text; }, 5, kMostBytes);
  EXPECT_EQ(done.failure, "");
  EXPECT_EQ(done.result, text);
}

TEST(InChild, SaysHowItEnded) {
  EXPECT_EQ(DoInChild([]() -> std::string { abort(); }, 5, kMostBytes).failure,
            "the library that reads it crashes (Aborted)");
  EXPECT_EQ(
      DoInChild([]() -> std::string { throw std::runtime_error("no"); }, 5, kMostBytes).failure,
      "the library that reads it fails");
}

TEST(InChild, EndsWhatComputesForEver) {
  const ChildWork done = DoInChild(
      []() -> std::string {
        volatile int i = 0;
        while (i == 0) {
        }
        return "";
      },
      1, kMostBytes);
  EXPECT_EQ(done.failure, "reading it takes more than 1 s of processor time");
}

#ifndef __SANITIZE_ADDRESS__
TEST(InChild, EndsWhatTakesMemoryForEver) {
  const ChildWork done = DoInChild(
      []() -> std::string {
        std::vector<std::string> all;
        while (true) all.emplace_back(1 << 24, 'x');
      },
      20, kMostBytes);
  EXPECT_EQ(done.failure, "reading it takes more than 1 GiB of memory");
}
#endif

TEST(InChild, EndsWhatSaysTooMuch) {
  const ChildWork done = DoInChild([] { return std::string(1 << 24, 'x'); }, 5, kMostBytes);
  EXPECT_NE(done.failure, "");
}

TEST(InChild, LeavesNoProcessBehind) {
  static_cast<void>(DoInChild([] { return std::string(); }, 5, kMostBytes));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace tcs
