#include "coordinator/scenario/load_outside.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LoadOutsideTest : public testing::Test {
 protected:
  static std::string Text(const std::string& cpu, const std::string& outside) {
    return "duration: 1s\nrobots:\n  r:\n    cpu: " + cpu +
           "\n    clients:\n      a: {command: [sh], outside: " + outside + "}\n";
  }
  RobotSpec Load(const std::string& cpu, const std::string& outside) {
    const std::string text = Text(cpu, outside);
    return ScenarioOf(LoadScenario(folder_.Write("s.yaml", text), {.result_directory = "out"}))
        .robots.at(0);
  }
  OutsideSpec Load(const std::string& outside) { return Load("{}", outside).clients.at(0).outside; }

  ScenarioFolder folder_;
};

TEST_F(LoadOutsideTest, NamesArePathsAbstractNamesAndPeers) {
  EXPECT_THAT(Load("[a.fifo, /dev/pts/../null, '@sim', '127.0.0.1:80', '[::1]:81', a:b]").names,
              ElementsAre(folder_.Path("a.fifo"), "/dev/null", "@sim", "127.0.0.1:80", "[::1]:81",
                          folder_.Path("a:b")));
}

TEST_F(LoadOutsideTest, WhatIsLeftOutHasDefaults) {
  const OutsideSpec outside = Load("{}");
  EXPECT_THAT(outside.names, IsEmpty());
  EXPECT_EQ(outside.takes, VirtualDuration::Milliseconds(5));
  EXPECT_EQ(outside.patience, HostDuration::Seconds(10));
  EXPECT_EQ(Load("{}", "[x]").outside_speed, 1.0);
}

TEST_F(LoadOutsideTest, AMapSetsTimes) {
  const OutsideSpec outside = Load("{names: [x], takes: 20ms, patience: 1min}");
  EXPECT_THAT(outside.names, ElementsAre(folder_.Path("x")));
  EXPECT_EQ(outside.takes, VirtualDuration::Milliseconds(20));
  EXPECT_EQ(outside.patience, HostDuration::Seconds(60));
  EXPECT_EQ(Load("{outside_speed: 0.5}", "[x]").outside_speed, 0.5);
}

TEST_F(LoadOutsideTest, MistakesAreNamed) {
  EXPECT_THAT(Complaint(folder_, Text("{}", "['@']")), HasSubstr("is empty; name a file"));
  EXPECT_THAT(Complaint(folder_, Text("{}", "{takes: 0s}")), HasSubstr("takes"));
  EXPECT_THAT(Complaint(folder_, Text("{outside_speed: 0}", "[x]")), HasSubstr("outside_speed"));
  EXPECT_THAT(Complaint(folder_, Text("{outside_speed: 5000}", "[x]")),
              HasSubstr("it must be between 0.001 and 1000"));
}

}  // namespace
}  // namespace tcs
