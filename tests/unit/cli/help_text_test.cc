// One description of a command line, and what is made of it.
#include "coordinator/cli/manual/help_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "coordinator/cli/manual/completion.h"
#include "coordinator/cli/manual/manual_page.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// What the options set is of no matter here.
struct Fly {
  CLI::App app{"fly things", "fly"};
  std::string file, mode, out = "out";
  bool fast = false;

  Fly() {
    CLI::App* up = app.add_subcommand("up", "go up");
    up->add_option("plan", file, "FILE: where to go")->required();
    up->add_option("--mode", mode, "how to go up")->check(CLI::IsMember({"straight", "round"}));
    up->add_option("--out", out, "FOLDER: for what was seen")->capture_default_str();
    up->add_flag("--fast", fast, "as it can");
    up->add_flag("--hidden", fast, "nobody knows")->group("");
    up->footer(
        "fly up plan.txt\nas planned\nfly up --mode round --out a_folder_of_its_own "
        "plan.txt\nround");
    app.add_subcommand("make", "for the build")->group("");
  }
  DescribedCommand All() const { return Describe(app); }
  DescribedCommand Up() const { return All().commands.at(0); }
};

TEST(Description, HasWhatPeopleAreToSee) {
  const Fly fly;
  ASSERT_EQ(fly.All().commands.size(), 1u);
  const DescribedCommand up = fly.Up();
  ASSERT_EQ(up.options.size(), 4u);  // and --help
  EXPECT_EQ(Heading(up.options[1]), "--mode straight|round");
  EXPECT_THAT(up.options[1].choices, ElementsAre("straight", "round"));
  EXPECT_EQ(Heading(up.options[2]), "--out FOLDER");
  EXPECT_EQ(FullText(up.options[2]), "for what was seen (default: out)");
  EXPECT_EQ(Heading(up.options[3]), "--fast");
  EXPECT_EQ(UsageOf(up, "fly"), "fly up [OPTIONS] plan");
}

TEST(HelpText, IsNotWiderThanTheTerminal) {
  const Fly fly;
  for (const std::size_t columns : {40u, 60u, 90u}) {
    std::istringstream lines(HelpText(fly.Up(), "fly", {columns, false}));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), columns) << line;
  }
}

TEST(HelpText, IsColouredOnlyWhereThatIsSeen) {
  const Fly fly;
  EXPECT_THAT(HelpText(fly.Up(), "fly", {80, false}), Not(HasSubstr("\033[")));
  EXPECT_THAT(HelpText(fly.Up(), "fly", {80, true}), HasSubstr("\033[1m--fast\033[0m"));
}

TEST(ManualPage, SaysTheSameAsHelp) {
  const Fly fly;
  const std::string page = ManualPage(fly.Up(), "fly", fly.All(), "1.2");
  EXPECT_THAT(page, HasSubstr(".SH NAME\nfly\\-up \\- go up\n"));
  EXPECT_THAT(page,
              HasSubstr("\\fB\\-\\-out\\fR \\fIFOLDER\\fR\nFor what was seen (default: out).\n"));
  EXPECT_THAT(page, HasSubstr(".SH EXAMPLES\n.TP\n\\fBfly up plan.txt\\fR\nAs planned.\n"));
  EXPECT_THAT(page, Not(HasSubstr("hidden")));
}

TEST(Completion, KnowsOptionsAndTheirValues) {
  const Fly fly;
  const std::string bash = BashCompletion(fly.All());
  EXPECT_THAT(bash, HasSubstr("--mode) COMPREPLY=($(compgen -W 'straight round' -- \"$word\"))"));
  EXPECT_THAT(bash, HasSubstr("--out) _tcsim_files -d"));
  EXPECT_THAT(ZshCompletion(fly.All()),
              HasSubstr("'*--mode=[how to go up]:straight|round:(straight round)'"));
}

}  // namespace
}  // namespace tcs
