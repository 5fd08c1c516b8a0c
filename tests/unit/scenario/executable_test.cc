#include "coordinator/scenario/executable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <variant>

#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string WhyNot(const std::string& path) {
  const auto error = CheckExecutable(path);
  return error ? error->message : "";
}

std::string Found(const LoadResult<std::string>& result) {
  const auto* path = std::get_if<std::string>(&result);
  return path != nullptr ? *path : "not found: " + std::get<LoadError>(result).message;
}

// Sets PATH for one test.
class PathVariable {
 public:
  explicit PathVariable(const std::string& value) : before_(std::getenv("PATH")) {
    setenv("PATH", value.c_str(), 1);
  }
  ~PathVariable() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

class ExecutableTest : public testing::Test {
 protected:
  ScenarioFolder folder_;
};

TEST_F(ExecutableTest, DynamicallyLinkedProgramsAreFine) {
  EXPECT_EQ(WhyNot(TCS_DYNAMIC_PROGRAM), "");
  EXPECT_EQ(WhyNot("/bin/sh"), "");
}

TEST_F(ExecutableTest, ScriptsOfDynamicallyLinkedInterpretersAreFine) {
  EXPECT_EQ(WhyNot(folder_.WriteExecutable("script", "#!/bin/sh\ntrue\n")), "");
  EXPECT_EQ(WhyNot(folder_.WriteExecutable("spaced", "#! \t/usr/bin/env -S sh -e\n")), "");
  EXPECT_EQ(WhyNot(folder_.WriteExecutable("no_line_end", "#!/bin/sh")), "");
  const std::string nested = "#!" + folder_.Path("script") + "\n";
  EXPECT_EQ(WhyNot(folder_.WriteExecutable("nested", nested)), "");
}

TEST_F(ExecutableTest, StaticProgramsAreToBeLinkedDynamically) {
  EXPECT_THAT(WhyNot(TCS_STATIC_PROGRAM),
              AllOf(HasSubstr("tcs_static_program' is statically linked"),
                    HasSubstr("link it dynamically (without -static or -static-pie)")));
  EXPECT_THAT(WhyNot(TCS_STATIC_PIE_PROGRAM), HasSubstr("is statically linked"));
}

TEST_F(ExecutableTest, ScriptsOfStaticInterpretersAreRefused) {
  const std::string text = "#!" + folder_.Copy(TCS_STATIC_PROGRAM, "static") + "\n";
  EXPECT_THAT(WhyNot(folder_.WriteExecutable("script", text)),
              AllOf(HasSubstr("the interpreter of the script '" + folder_.Path("script") + "'"),
                    HasSubstr("is statically linked")));
}

TEST_F(ExecutableTest, ScriptsWithoutAUsableInterpreterAreRefused) {
  EXPECT_THAT(WhyNot(folder_.WriteExecutable("a", "#!/no/such/shell\n")),
              AllOf(HasSubstr("the interpreter of the script"), HasSubstr("No such file")));
  EXPECT_THAT(WhyNot(folder_.WriteExecutable("b", "#!\n")), HasSubstr("without an interpreter"));
  EXPECT_THAT(WhyNot(folder_.WriteExecutable("c", "#!/bin/sh\r\ntrue\r\n")),
              HasSubstr("Windows line ends"));
  EXPECT_THAT(WhyNot(folder_.WriteExecutable("d", "echo hello\n")),
              HasSubstr("begin a script with a '#!' line"));
  EXPECT_THAT(WhyNot(folder_.WriteExecutable("e", "")), HasSubstr("neither an ELF program"));
  EXPECT_THAT(WhyNot(folder_.WriteExecutable("f", "#!" + folder_.Path("f") + "\n")),
              HasSubstr("and so on"));
}

TEST_F(ExecutableTest, ProgramsOfOtherMachinesAreRefused) {
  constexpr std::size_t kClass = 4, kMachine = 18, kType = 16;
  EXPECT_THAT(WhyNot(folder_.Patch("i386", kClass, "\1")), HasSubstr("is a 32-bit program"));
  EXPECT_THAT(WhyNot(folder_.Patch("aarch64", kMachine, "\xb7")),
              HasSubstr("another kind of processor"));
  EXPECT_THAT(WhyNot(folder_.Patch("object", kType, "\1")), HasSubstr("not a program"));
}

TEST_F(ExecutableTest, DamagedElfFilesAreRefused) {
  EXPECT_NE(WhyNot(folder_.WriteExecutable("cut", "\177ELF\2\1\1")), "");
  EXPECT_NE(WhyNot(folder_.Patch("far_headers", 32, "\xff\xff\xff\xff\xff\xff\xff\x7f")), "");
  EXPECT_NE(WhyNot(folder_.Patch("odd_headers", 54, "\1")), "");
}

TEST_F(ExecutableTest, PrivilegedProgramsAreRefused) {
  const std::string program = folder_.Path("controller");
  ASSERT_EQ(chmod(program.c_str(), 04755), 0);
  EXPECT_THAT(WhyNot(program), AllOf(HasSubstr("is set-uid"), HasSubstr("preloads nothing")));
  ASSERT_EQ(chmod(program.c_str(), 02755), 0);
  EXPECT_THAT(WhyNot(program), HasSubstr("is set-gid"));
}

TEST_F(ExecutableTest, WhatCannotBeExecutedIsRefused) {
  EXPECT_THAT(WhyNot(folder_.Write("plain", "#!/bin/sh\n")), HasSubstr("chmod +x"));
  EXPECT_THAT(WhyNot(folder_.path()), HasSubstr("is a folder"));
  EXPECT_THAT(WhyNot(folder_.Path("none")), HasSubstr("No such file"));
  EXPECT_THAT(WhyNot("/dev/null"), HasSubstr("not executable"));
}

TEST_F(ExecutableTest, UnreadableProgramsAreRefused) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything";
  const std::string program = folder_.Path("controller");
  ASSERT_EQ(chmod(program.c_str(), 0111), 0);
  EXPECT_THAT(WhyNot(program), HasSubstr("chmod +r"));
}

TEST_F(ExecutableTest, AFolderInPathThatMayNotBeSearchedHasNoPrograms) {
  if (geteuid() == 0) GTEST_SKIP() << "root searches everything";
  const ScenarioFolder shut;
  ASSERT_EQ(chmod(shut.path().c_str(), 0), 0);
  {
    const PathVariable path(shut.path());
    EXPECT_THAT(Found(FindExecutable("tcs_no_such_tool", "/")), HasSubstr("was not found in PATH"));
  }
  ASSERT_EQ(chmod(shut.path().c_str(), 0700), 0);
}

TEST_F(ExecutableTest, NamesWithASlashAreRelativeToTheFolder) {
  EXPECT_EQ(Found(FindExecutable("./controller", folder_.path())), folder_.Path("controller"));
  EXPECT_EQ(Found(FindExecutable("sub/../controller", folder_.path())), folder_.Path("controller"));
  EXPECT_EQ(Found(FindExecutable("/bin/sh", folder_.path())), "/bin/sh");
  EXPECT_THAT(Found(FindExecutable("./contoller", folder_.path())),
              AllOf(HasSubstr("there is no program '" + folder_.Path("contoller") + "'"),
                    HasSubstr("relative to '" + folder_.path() + "'")));
}

TEST_F(ExecutableTest, NamesWithoutASlashAreSearchedAlongPath) {
  folder_.Write("tool", "not executable");
  const ScenarioFolder other;
  other.WriteExecutable("tool", "#!/bin/sh\n");
  {
    const PathVariable path(folder_.path() + ":/no/such/folder:" + other.path());
    EXPECT_EQ(Found(FindExecutable("tool", "/")), other.Path("tool"));
    EXPECT_THAT(Found(FindExecutable("tcs_no_such_tool", "/")),
                AllOf(HasSubstr("'tcs_no_such_tool' was not found in PATH"),
                      HasSubstr("./tcs_no_such_tool")));
  }
  {
    const PathVariable path(folder_.path());
    EXPECT_THAT(Found(FindExecutable("tool", "/")), HasSubstr("chmod +x"));
  }
  {
    const PathVariable path("");  // one empty folder: the current one
    EXPECT_EQ(Found(FindExecutable("controller", folder_.path())), folder_.Path("controller"));
  }
  EXPECT_THAT(Found(FindExecutable("", "/")), HasSubstr("the command is empty"));
}

}  // namespace
}  // namespace tcs
