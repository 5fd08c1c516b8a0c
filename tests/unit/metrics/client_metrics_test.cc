// Metrics of clients are read from their logs, and whoever prints what is none hears of it once.
#include "coordinator/metrics/client_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace tcs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ClientMetricsTest : public ::testing::Test {
 protected:
  ClientMetricsTest() {
    std::filesystem::create_directory(folder_);
    book_.OpenIn(folder_);
    metrics_.Begin({.monotonic_ns = 1000'000'000'000,
                    .realtime_ns = 1'704'067'200'000'000'000,
                    .duration_ns = 10'000'000'000});
    metrics_.Add("r/a", folder_ + "/r-a.out.log");
  }
  ~ClientMetricsTest() override { std::filesystem::remove_all(folder_); }
  // The client prints it by then.
  void Print(const std::string& text, std::int64_t now_ns) {
    std::ofstream(folder_ + "/r-a.out.log", std::ios::app) << text;
    printed_ += static_cast<std::int64_t>(text.size());
    metrics_.Grew("r/a", printed_, now_ns);
  }
  std::string Written() {
    metrics_.CatchUp();
    EXPECT_EQ(book_.Close(), "");
    std::stringstream text;
    text << std::ifstream(folder_ + "/metrics.csv").rdbuf();
    return text.str();
  }

  const std::string folder_ = ::testing::TempDir() + "client_metrics_test_" +
                              ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::vector<std::string> warnings_;
  MetricBook book_;
  ClientMetrics metrics_{book_, [this](const std::string& text) { warnings_.push_back(text); }};
  std::int64_t printed_ = 0;
};

TEST_F(ClientMetricsTest, HaveTheTimeOfTheWriteOrTheirOwn) {
  Print("hello\ntcs-metric error 0.5\ntcs-me", 100);
  Print("tric error 0.25 1002.5\n", 3'000'000'000);
  metrics_.Finish(9);
  EXPECT_EQ(Written(),
            "name,time_ns,value,from\n"
            "error,100,0.5,r/a\n"
            "error,2500000000,0.25,r/a\n");
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(ClientMetricsTest, WhatIsLeftCountsAtTheEnd) {
  Print("tcs-metric error 1\n", 100);
  std::ofstream(folder_ + "/r-a.out.log", std::ios::app)
      << "tcs-metric error 2\ntcs-metric error 3";
  metrics_.Finish(200);
  EXPECT_EQ(Written(),
            "name,time_ns,value,from\nerror,100,1,r/a\nerror,200,2,r/a\nerror,200,3,r/a\n");
}

TEST_F(ClientMetricsTest, WhatIsNoneIsSaidOnceWithItsLine) {
  Print("first\ntcs-metric error much\ntcs-metric error\ntcs-metric error 1\n", 100);
  Print("tcs-metric error 1 5000\n", 200);
  metrics_.CatchUp();
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("r/a: "), HasSubstr("'much'"),
                                           HasSubstr("r-a.out.log:2"))));
  EXPECT_EQ(book_.Figures().at("error").count, 1);
}

TEST_F(ClientMetricsTest, AreNotReadFromWhatIsNoFile) {
  std::filesystem::create_symlink("/dev/zero", folder_ + "/r-a.out.log");
  metrics_.Finish(1);
  EXPECT_THAT(book_.Figures(), IsEmpty());
}

TEST_F(ClientMetricsTest, AreNotLookedForInWhatNobodyCanHavePrinted) {
  Print("tcs-metric error 1\n", 100);
  std::filesystem::resize_file(folder_ + "/r-a.out.log", std::uintmax_t{1} << 40);
  metrics_.Grew("r/a", std::int64_t{1} << 40, 200);
  metrics_.Finish(300);
  EXPECT_EQ(book_.Figures().at("error").count, 1);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("1024 MiB")));
}

TEST_F(ClientMetricsTest, AreTakenOfManyValues) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += "tcs-metric step " + std::to_string(i) + "\n";
  Print(text, 1);
  metrics_.CatchUp();
  EXPECT_EQ(book_.Figures().at("step").count, 100'000);
  EXPECT_EQ(book_.Figures().at("step").max, 99'999);
}

}  // namespace
}  // namespace tcs
