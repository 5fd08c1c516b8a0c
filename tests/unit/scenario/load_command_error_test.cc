// Mistakes in a client's command: found before anything is started.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class CommandTest : public testing::Test {
 protected:
  // kGoodScenario with the controller's command (line 22) replaced.
  std::string ComplaintAboutCommand(std::string_view command) {
    return Complaint(folder_, WithReplaced("[./controller, --seed, \"${seed}\"]", command));
  }

  static constexpr std::string_view kPlace = "s.yaml:22: robots.hunter.clients.controller.command";
  ScenarioFolder folder_;
};

TEST_F(CommandTest, MissingPrograms) {
  EXPECT_THAT(ComplaintAboutCommand("[./none]"),
              AllOf(StartsWith(kPlace), HasSubstr("there is no program '" + folder_.path())));
  EXPECT_THAT(ComplaintAboutCommand("[tcs_none]"),
              AllOf(StartsWith(kPlace), HasSubstr("'tcs_none' was not found in PATH")));
}

TEST_F(CommandTest, ProgramsThatCannotBeRun) {
  folder_.Write("plain", "text");
  EXPECT_THAT(ComplaintAboutCommand("[./plain]"),
              AllOf(StartsWith(kPlace), HasSubstr("is not executable; make it so with chmod +x")));
  EXPECT_THAT(ComplaintAboutCommand("[/tmp]"), AllOf(StartsWith(kPlace), HasSubstr("a folder")));
}

TEST_F(CommandTest, ProgramsThatTcsCannotCarry) {
  folder_.Copy(TCS_STATIC_PROGRAM, "static");
  folder_.Copy(TCS_STATIC_PIE_PROGRAM, "static_pie");
  folder_.WriteExecutable("script", "#!" + folder_.Path("static") + "\n");
  for (const char* name : {"[./static]", "[./static_pie]", "[./script]"}) {
    EXPECT_THAT(ComplaintAboutCommand(name),
                AllOf(StartsWith(kPlace), HasSubstr("is statically linked"),
                      HasSubstr("link it dynamically")));
  }
  folder_.Patch("i386", 4, "\1");
  EXPECT_THAT(ComplaintAboutCommand("[./i386]"), AllOf(StartsWith(kPlace), HasSubstr("32-bit")));
  ASSERT_EQ(chmod(folder_.Copy(TCS_DYNAMIC_PROGRAM, "privileged").c_str(), 04755), 0);
  EXPECT_THAT(ComplaintAboutCommand("[./privileged]"),
              AllOf(StartsWith(kPlace), HasSubstr("is set-uid")));
}

TEST_F(CommandTest, ThatAreNoList) {
  EXPECT_THAT(ComplaintAboutCommand("./controller --seed 3"),
              AllOf(StartsWith(kPlace), HasSubstr("is not a list; write it like [")));
  EXPECT_THAT(ComplaintAboutCommand("[]"), AllOf(StartsWith(kPlace), HasSubstr("an empty list")));
  EXPECT_THAT(ComplaintAboutCommand("[./controller, ~]"),
              AllOf(StartsWith(kPlace), HasSubstr("command[1] has no value")));
  EXPECT_THAT(ComplaintAboutCommand("[\"\"]"), HasSubstr("the command is empty"));
}

TEST_F(CommandTest, OnSeveralLinesHaveEachTheirOwnLine) {
  EXPECT_THAT(ComplaintAboutCommand("\n          - ./none\n          - --fast"),
              StartsWith("s.yaml:23: "));
  EXPECT_THAT(ComplaintAboutCommand("[./controller, --fast,\n          \"${TCS_UNSET}\"]"),
              StartsWith("s.yaml:23: "));
}

TEST_F(CommandTest, WithVariablesThatCannotBeReplaced) {
  unsetenv("TCS_UNSET");
  EXPECT_THAT(ComplaintAboutCommand("[./controller, \"-${TCS_UNSET}-\"]"),
              AllOf(StartsWith(kPlace), HasSubstr("uses ${TCS_UNSET}, which is not set")));
  EXPECT_THAT(ComplaintAboutCommand("[./controller, \"${seed\"]"),
              AllOf(StartsWith(kPlace), HasSubstr("'${' without '}'")));
  EXPECT_THAT(ComplaintAboutCommand("[./controller, \"${a-b}\"]"),
              AllOf(StartsWith(kPlace), HasSubstr("'${a-b}', which names no variable")));
  EXPECT_THAT(Complaint(folder_, WithReplaced("MODE: fast", "MODE: \"${TCS_UNSET}\"")),
              AllOf(StartsWith("s.yaml:26: "), HasSubstr("environment.MODE uses ${TCS_UNSET}")));
}

}  // namespace
}  // namespace tcs
