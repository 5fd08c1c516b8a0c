#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "coordinator/trace/activation_log.h"
#include "coordinator/trace/dispatch_log.h"
#include "coordinator/trace/output_log.h"

namespace tcs {
namespace {

class LogsTest : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  std::string Written() const {
    std::stringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
  const std::string path_ = ::testing::TempDir() + "logs_test_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                            ".csv";
};

TEST_F(LogsTest, AnActivationIsALine) {
  ActivationLog log;
  ASSERT_EQ(log.Open(path_, false), "");
  log.Write("r/planner", 0, {ReleaseCause::kInput, 10, 0, 12, 500}, 1010, {.charged_ns = 1400});
  log.Write("r/planner", 7, {ReleaseCause::kThread, -1, 0, 0, 0}, 0, {});
  ASSERT_EQ(log.Close(), "");
  EXPECT_EQ(Written(),
            "client,thread,cause,release_ns,start_ns,end_ns,charged_ns\n"
            "r/planner,0,input,10,12,1010,900\n"
            "r/planner,7,thread,-1,0,0,0\n");
}

TEST_F(LogsTest, ALineTellsOfCallsAndAllocationsWhereTheyAreCounted) {
  ActivationLog log;
  ASSERT_EQ(log.Open(path_, true), "");
  log.Write("r/planner", 0, {ReleaseCause::kInput, 10, 0, 12, 500, 20, {7, 250}}, 1010,
            {1400, 50, {9, 1300}});
  ASSERT_EQ(log.Close(), "");
  EXPECT_EQ(
      Written(),
      "client,thread,cause,release_ns,start_ns,end_ns,charged_ns,calls,allocations,priced_ns\n"
      "r/planner,0,input,10,12,1010,900,2,11,30\n");
}

TEST_F(LogsTest, SlicesThatFollowEachOtherAreOne) {
  DispatchLog log;
  ASSERT_EQ(log.Open(path_, true), "");
  log.AddRow("dynamics");
  log.AddRow("r/planner");
  log.Slice(1, {0, 100}, {0, 100});
  log.Slice(1, {100, 200}, {105, 205});
  log.Slice(0, {0, 200}, {210, 220});            // somebody else
  log.Slice(1, {200, 300}, {230, 330});          // after somebody else
  log.Slice(1, {350, 400}, {335, 385});          // a gap in virtual time
  log.Slice(1, {400, 500}, {900'000, 900'100});  // a long one in real time
  ASSERT_EQ(log.Close(), "");
  EXPECT_EQ(Written(),
            "row,virtual_start_ns,virtual_end_ns,real_start_ns,real_end_ns\n"
            "r/planner,0,200,0,205\n"
            "dynamics,0,200,210,220\n"
            "r/planner,200,300,230,330\n"
            "r/planner,350,400,335,385\n"
            "r/planner,400,500,900000,900100\n");
}

TEST_F(LogsTest, WithoutRealTimesNothingOfThemIsWritten) {
  DispatchLog log;
  ASSERT_EQ(log.Open(path_, false), "");
  log.AddRow("dynamics");
  log.Slice(0, {0, 5}, {1, 2});
  log.Slice(0, {5, 9}, {900'000'000, 900'000'001});
  ASSERT_EQ(log.Close(), "");
  EXPECT_EQ(Written(), "row,virtual_start_ns,virtual_end_ns\ndynamics,0,9\n");
}

TEST_F(LogsTest, ManyLinesArriveWhole) {
  CsvFile file;
  ASSERT_EQ(file.Open(path_, "number,text"), "");
  std::string wanted = "number,text\n";
  for (int i = 0; i < 20'000; ++i) {
    file.Line(i, "text");
    wanted += std::to_string(i) + ",text\n";
  }
  ASSERT_EQ(file.Close(), "");
  EXPECT_EQ(Written(), wanted);
}

TEST_F(LogsTest, NumbersHaveTheDigitsThatTellThemApart) {
  CsvFile file;
  ASSERT_EQ(file.Open(path_, "number"), "");
  for (const double number : {0.1, -0.0, 1e300, -2.2250738585072014e-308, 1.0 / 3}) {
    file.Line(number);
  }
  ASSERT_EQ(file.Close(), "");
  EXPECT_EQ(Written(), "number\n0.1\n-0\n1e+300\n-2.2250738585072014e-308\n0.3333333333333333\n");
}

class OutputLogTest : public ::testing::Test {
 protected:
  OutputLogTest() { std::filesystem::create_directory(folder_); }
  ~OutputLogTest() override { std::filesystem::remove_all(folder_); }
  void Append(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ + "/" + file, std::ios::app) << text;
  }
  std::string Written() const {
    std::stringstream text;
    text << std::ifstream(folder_ + "/output.csv").rdbuf();
    return text.str();
  }
  const std::string folder_ = ::testing::TempDir() + "output_log_test_" +
                              ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(OutputLogTest, HasALineForEachPieceThatAClientWrote) {
  OutputLog log;
  ASSERT_EQ(log.Open(folder_), "");
  log.Add("r/planner", "r-planner");
  log.LookAt(1);
  Append("r-planner.out.log", "hello\n");
  log.LookAt(2);
  log.LookAt(3);
  Append("r-planner.out.log", "a");
  Append("r-planner.out.log", "b");
  Append("r-planner.err.log", "oh");
  Append("others.log", "what nobody asked for");
  log.LookAt(4);
  ASSERT_EQ(log.Close(), "");
  EXPECT_EQ(Written(),
            "time_ns,client,stream,begin,end\n"
            "2,r/planner,out,0,6\n"
            "4,r/planner,out,6,8\n"
            "4,r/planner,err,0,2\n");
}

TEST_F(OutputLogTest, WhatIsWrittenInATurnBesideOthersIsOfTheTimeAtWhichThatEnds) {
  OutputLog log;
  ASSERT_EQ(log.Open(folder_), "");
  log.Add("r/loop", "r-loop");
  log.Add("r/planner", "r-planner");
  log.Hold("r/loop");
  log.Hold("r/nobody");
  Append("r-loop.out.log", "tick\n");
  Append("r-planner.out.log", "hello\n");
  log.LookAt(2);
  log.LetGo("r/loop");
  log.LetGo("r/nobody");
  log.LookAt(3);
  Append("r-loop.out.log", "on\n");
  log.LookAt(4);
  ASSERT_EQ(log.Close(), "");
  EXPECT_EQ(Written(),
            "time_ns,client,stream,begin,end\n"
            "2,r/planner,out,0,6\n"
            "3,r/loop,out,0,5\n"
            "4,r/loop,out,5,8\n");
}

TEST_F(OutputLogTest, WhatAnEarlierRunLeftIsNotIts) {
  Append("r-planner.out.log", "of an earlier run\n");
  OutputLog log;
  ASSERT_EQ(log.Open(folder_), "");
  log.Add("r/planner", "r-planner");
  { std::ofstream truncated(folder_ + "/r-planner.out.log"); }
  log.LookAt(1);
  Append("r-planner.out.log", "new");
  log.LookAt(2);
  ASSERT_EQ(log.Close(), "");
  EXPECT_EQ(Written(), "time_ns,client,stream,begin,end\n2,r/planner,out,0,3\n");
}

TEST_F(LogsTest, AFullDiskIsSaid) {
  CsvFile file;
  ASSERT_EQ(file.Open("/dev/full", "number"), "");
  file.Line(1);
  EXPECT_NE(file.Close().find("/dev/full was not written completely"), std::string::npos);
}

TEST_F(LogsTest, AFolderThatIsNotThereIsSaid) {
  ActivationLog log;
  EXPECT_NE(log.Open("/nonexistent/a.csv", false).find("/nonexistent/a.csv cannot be written"),
            std::string::npos);
  log.Write("nobody", 0, {}, 0, {});
  EXPECT_EQ(log.Close(), "");
}

}  // namespace
}  // namespace tcs
