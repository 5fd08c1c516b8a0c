#include "coordinator/explain/told.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <variant>

namespace tcs::explain {
namespace {

constexpr const char* kHeader =
    "client,thread,cause,release_ns,start_ns,end_ns,deadline_ns,queued_ns,away_ns,wakeup_ns,"
    "executed_ns,cores_ns,locks_ns,room_ns,rest_ns,whose\n";

class ToldTest : public testing::Test {
 protected:
  ToldTest() {
    char name[] = "/tmp/tcs-told-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~ToldTest() override { std::filesystem::remove_all(folder_); }
  void Write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ + "/" + file) << text;
  }

  std::string folder_;
};

TEST_F(ToldTest, StartsAndDeadlinesThatNobodyExpectsAreLeftOut) {
  Write("responses.csv", std::string(kHeader) +
                             "r/a,0,time,0,0,5,10,0,0,0,5,0,0,0,0,\n"
                             "r/a,2,input,10,12,25,10,1,0,0,9,2,3,0,0,lock:r/b=3 core:r/b=2\n"
                             "r/b,0,time,0,0,50,10,0,0,0,50,0,0,0,0,\n");
  Write("summary.json", R"({"clients": {
      "r/a": {"priority": 3, "deadline": {"deadline_ns": 10}, "counted_after_ns": 5},
      "r/b": {"priority": 1, "deadline": null, "counted_after_ns": -1}}})");
  const auto read = ReadTold(folder_);
  ASSERT_TRUE(std::holds_alternative<Told>(read)) << std::get<LoadError>(read).message;
  const auto& told = std::get<Told>(read);
  ASSERT_EQ(told.activations.size(), 2u);
  const Activation& first = told.activations[0];
  EXPECT_EQ(first.thread, 2);
  EXPECT_EQ(first.LateNs(), 5);
  ASSERT_EQ(first.locks.size(), 1u);
  EXPECT_EQ(first.locks[0].client, "r/b");
  EXPECT_EQ(first.locks[0].ns, 3);
  ASSERT_EQ(first.cores.size(), 1u);
  EXPECT_EQ(first.cores[0].ns, 2);
  EXPECT_EQ(told.activations[1].LateNs(), 0);
  EXPECT_EQ(told.clients.at("r/a").priority, 3);
}

TEST_F(ToldTest, WithoutTheTableOneSentenceSaysSo) {
  const auto read = ReadTold(folder_);
  ASSERT_TRUE(std::holds_alternative<LoadError>(read));
  EXPECT_NE(std::get<LoadError>(read).message.find("responses.csv"), std::string::npos);
}

TEST_F(ToldTest, ARunThatWasCutOffHasNoSummary) {
  Write("responses.csv", std::string(kHeader) + "r/a,0,time,0,0,25,10,0,0,0,25,0,0,0,0,\nr/a,0,ti");
  const auto read = ReadTold(folder_);
  ASSERT_TRUE(std::holds_alternative<Told>(read));
  ASSERT_EQ(std::get<Told>(read).activations.size(), 1u);
  EXPECT_EQ(std::get<Told>(read).activations[0].LateNs(), 15);
}

}  // namespace
}  // namespace tcs::explain
