#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <string>
#include <variant>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LoadLivesTest : public testing::Test {
 protected:
  // With three clients a, b (of the robot r) and c (of q), whose further keys are given.
  std::string Text(const std::string& a, const std::string& b = "", const std::string& c = "") {
    return "duration: 10s\nrobots:\n  r:\n    clients:\n      a: {command: [sh]" + a +
           "}\n      b: {command: [sh]" + b + "}\n  q:\n    clients:\n      c: {command: [sh]" + c +
           "}\n";
  }
  Scenario Load(const std::string& text) {
    return ScenarioOf(LoadScenario(folder_.Write("s.yaml", text), {.result_directory = Result()}));
  }
  ClientSpec First(const std::string& keys) { return Load(Text(keys)).robots.at(0).clients.at(0); }
  std::string Wrong(const std::string& a, const std::string& b = "", const std::string& c = "") {
    return Complaint(folder_, Text(a, b, c));
  }
  std::string Result() const { return folder_.Path("out"); }

  ScenarioFolder folder_;
};

TEST_F(LoadLivesTest, WhatIsLeftOutHasDefaults) {
  const ClientSpec client = First("");
  EXPECT_EQ(client.start, VirtualDuration{});
  EXPECT_EQ(client.after, "");
  EXPECT_EQ(client.stop_signal, SIGTERM);
  EXPECT_EQ(client.stop_grace, VirtualDuration::Milliseconds(500));
  EXPECT_EQ(client.folder, ClientFolder::kThere);
  EXPECT_EQ(client.working_directory, folder_.path());
}

TEST_F(LoadLivesTest, SignalsHaveTheirNames) {
  EXPECT_EQ(First(", stop_signal: SIGINT").stop_signal, SIGINT);
  EXPECT_EQ(First(", stop_signal: USR1").stop_signal, SIGUSR1);
  EXPECT_EQ(First(", stop_signal: SIGKILL, stop_grace: 0").stop_signal, SIGKILL);
  EXPECT_EQ(Wrong(", stop_signal: SIGTREM"),
            "s.yaml:5: robots.r.clients.a.stop_signal is the unknown 'SIGTREM'; did you mean "
            "'SIGTERM'?");
  EXPECT_THAT(
      Wrong(", stop_signal: SIGSTOP"),
      HasSubstr("s.yaml:5: robots.r.clients.a.stop_signal is SIGSTOP, which ends no program"));
}

TEST_F(LoadLivesTest, TimesAreNotNegative) {
  EXPECT_EQ(First(", start: 1.5s, stop_grace: 20ms").start, VirtualDuration::Milliseconds(1500));
  EXPECT_THAT(
      Wrong(", start: -1s"),
      HasSubstr(
          "s.yaml:5: robots.r.clients.a.start: '-1s' is not a duration: it must not be negative"));
  EXPECT_THAT(Wrong(", stop_grace: -1s"), HasSubstr("stop_grace: '-1s' is not a duration"));
}

TEST_F(LoadLivesTest, AStartBehindTheEndIsAWarning) {
  EXPECT_THAT(
      Load(Text(", start: 10s")).warnings,
      ElementsAre(HasSubstr("s.yaml:5: robots.r.clients.a.start is 10s, when the run is over")));
  EXPECT_THAT(Load(Text(", start: 9.9s")).warnings, IsEmpty());
}

TEST_F(LoadLivesTest, AClientIsNamedWithItsRobotOrAlone) {
  const Scenario scenario = Load(Text(", after: c", ", after: r/a"));
  EXPECT_EQ(scenario.robots[0].clients[0].after, "q/c");
  EXPECT_EQ(scenario.robots[0].clients[1].after, "r/a");
  EXPECT_EQ(Wrong("", "", ", after: aa"),
            "s.yaml:9: robots.q.clients.c.after is the unknown client 'aa'; the clients here are "
            "r/a, r/b and q/c");
  EXPECT_THAT(Wrong("", "", ", after: r/x"), HasSubstr("did you mean 'r/a'?"));
}

TEST_F(LoadLivesTest, OfTwoWithOneNameTheOneBesideItIsMeant) {
  const std::string text =
      "duration: 1s\nrobots:\n  r: {clients: {a: {command: [sh]}}}\n"
      "  s: {clients: {a: {command: [sh]}, b: {command: [sh], after: a}}}\n";
  EXPECT_EQ(Load(text).robots[1].clients[1].after, "s/a");
  EXPECT_EQ(
      Complaint(folder_, text + "  t: {clients: {b: {command: [sh], after: a}}}\n"),
      "s.yaml:5: robots.t.clients.b.after is 'a', which can mean r/a or s/a; write ROBOT/CLIENT");
}

TEST_F(LoadLivesTest, ACycleIsAMistake) {
  EXPECT_EQ(Wrong(", after: b", ", after: c", ", after: a"),
            "s.yaml:9: robots.q.clients.c.after makes a cycle, so none of them would start: q/c "
            "after r/a after r/b after q/c; let one of them start without another");
  EXPECT_THAT(Wrong(", after: a"), HasSubstr("r/a after r/a; let"));
  EXPECT_EQ(Wrong(", after: b", "", ", after: a"), "");
}

TEST_F(LoadLivesTest, AFolderIsSeenFromTheScenario) {
  fs::create_directory(folder_.Path("maps"));
  EXPECT_EQ(First(", working_directory: ./maps/").working_directory, folder_.Path("maps"));
  EXPECT_EQ(First(", working_directory: /tmp").working_directory, "/tmp");
  EXPECT_EQ(Wrong(", working_directory: map"),
            "s.yaml:5: robots.r.clients.a.working_directory is '" + folder_.Path("map") +
                "', and there is no such folder; make it, or name one that exists");
}

TEST_F(LoadLivesTest, AFolderInTheResultsIsMade) {
  const ClientSpec client = First(", working_directory: \"${result_dir}/both\"");
  EXPECT_EQ(client.folder, ClientFolder::kMade);
  EXPECT_EQ(client.working_directory, Result() + "/both");
}

TEST_F(LoadLivesTest, AFolderOfItsOwnIsFresh) {
  fs::create_directory(folder_.Path("maps"));
  ClientSpec client = First(", working_directory: {fresh: true}");
  EXPECT_EQ(client.folder, ClientFolder::kFresh);
  EXPECT_EQ(client.working_directory, Result() + "/r-a");
  EXPECT_EQ(client.copied_folder, "");
  client = First(", working_directory: {copy_of: maps}");
  EXPECT_EQ(client.folder, ClientFolder::kFresh);
  EXPECT_EQ(client.copied_folder, folder_.Path("maps"));
  EXPECT_THAT(Wrong(", working_directory: {copy_of: map}"), HasSubstr("copy_of is '"));
  EXPECT_THAT(Wrong(", working_directory: {}"),
              HasSubstr("has neither fresh: true nor copy_of: FOLDER"));
  EXPECT_THAT(Wrong(", working_directory: {copy: maps}"), HasSubstr("unknown key 'copy'"));
  const auto holding =
      LoadScenario(folder_.Write("s.yaml", Text(", working_directory: {copy_of: .}")),
                   {.result_directory = Result()});
  EXPECT_THAT(std::get<LoadError>(holding).message, HasSubstr("which holds the results"));
}

TEST_F(LoadLivesTest, ArgumentsKnowTheFolders) {
  const Scenario scenario = Load(
      "duration: 1s\nrobots: {r: {clients: {a: {command: [sh, \"${scenario_dir}/x\", "
      "\"${result_dir}\"],"
      " environment: {OUT: \"${result_dir}/y\"}}}}}\n");
  const ClientSpec& client = scenario.robots[0].clients[0];
  EXPECT_EQ(client.command[1], folder_.Path("x"));
  EXPECT_EQ(client.command[2], Result());
  EXPECT_EQ(client.environment.at("OUT"), Result() + "/y");
}

}  // namespace
}  // namespace tcs
