#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "coordinator/trials/outcome.h"
#include "coordinator/trials/slurm/environment.h"
#include "coordinator/trials/slurm_folder.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SlurmWorkFolderTest : public ::testing::Test {
 protected:
  SlurmWorkFolderTest() {
    std::string made = ::testing::TempDir() + "slurm.XXXXXX";
    results_ = mkdtemp(made.data());
    work_.version = "1.2.3";
    work_.directory = "/home/me";
    work_.results = results_;
    work_.environment = {{"HOME", {}}, {"PWD", "/home/me"}, {"TMPDIR", ""}};
    work_.trials = {{1, "seed-0001", "out/seed-0001", {"run", "s.yaml"}},
                    {2, "a/seed-0002", "out/a/seed-0002", {"run", "s.yaml", "--set", "a=b"}}};
  }
  ~SlurmWorkFolderTest() override { fs::remove_all(results_); }

  static void Put(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  fs::path results_;
  SlurmWork work_;
};

TEST_F(SlurmWorkFolderTest, HandsTheWorkOver) {
  const SlurmWorkFolder folder(WorkFolderIn(results_, "tcs-1"));
  EXPECT_FALSE(folder.Read().has_value());
  ASSERT_EQ(folder.Make(work_), "");
  const auto read = folder.Read();
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(ToJson(*read), ToJson(work_));
  EXPECT_EQ(read->trials[1].shown_folder, "out/a/seed-0002");
}

// In a process of its own, whose environment it is.
TEST(SlurmEnvironment, IsTheCallersInItsOrderWithoutWhatSlurmAdds) {
  const auto take = [] {
    clearenv();
    setenv("ZOO", "1", 1);
    setenv("PWD", "/home/me", 1);
    setenv("GONE", "2", 1);
    setenv("API_KEY", "secret", 1);
    const auto before = ReadEnvironment();
    for (const SlurmVariable& variable : before) {
      if (variable.value.has_value() != (variable.name == "PWD")) _exit(1);
    }
    clearenv();
    setenv("API_KEY", "secret", 1);
    setenv("SLURM_JOB_ID", "12", 1);
    setenv("TMPDIR", "/tmp", 1);
    setenv("PWD", "/", 1);
    setenv("ZOO", "1", 1);
    TakeEnvironment(before);
    std::string all;
    for (char** entry = environ; *entry != nullptr; ++entry) all += std::string(*entry) + " ";
    fputs(all.c_str(), stderr);
    _exit(all == "ZOO=1 PWD=/home/me API_KEY=secret " ? 0 : 2);
  };
  EXPECT_EXIT(take(), ::testing::ExitedWithCode(0), "");
}

TEST_F(SlurmWorkFolderTest, GivesATrialToOneJobUntilItIsReleased) {
  const SlurmWorkFolder folder(WorkFolderIn(results_, "tcs-1"));
  ASSERT_EQ(folder.Make(work_), "");
  EXPECT_TRUE(folder.TryToClaim(1, {"12_0", "n1"}));
  EXPECT_FALSE(folder.TryToClaim(1, {"12_3", "n2"}));
  EXPECT_THAT(folder.Claimed(2), ElementsAre(false, true));
  auto claims = folder.Claims();
  ASSERT_EQ(claims.size(), 1u);
  EXPECT_EQ(claims[1].job, "12_0");
  EXPECT_EQ(claims[1].node, "n1");
  folder.Release(1);
  EXPECT_THAT(folder.Claimed(2), ElementsAre(false, false));
  EXPECT_TRUE(folder.TryToClaim(1, {"12_3", "n2"}));
  EXPECT_EQ(folder.Claims()[1].job, "12_3");
}

TEST_F(SlurmWorkFolderTest, TellsHowFarTrialsAreAndWhatIsWrong) {
  const SlurmWorkFolder folder(WorkFolderIn(results_, "tcs-1"));
  ASSERT_EQ(folder.Make(work_), "");
  EXPECT_EQ(folder.Progress(0), 0);
  folder.SetProgress(0, 1'500'000'000);
  EXPECT_EQ(folder.Progress(0), 1'500'000'000);
  EXPECT_EQ(folder.Error("12_0"), "");
  folder.SetError("12_0", "no such folder");
  EXPECT_EQ(folder.Error("12_0"), "no such folder");
}

TEST_F(SlurmWorkFolderTest, TheFirstRunOfATrialIsItsResult) {
  Put(results_ / "x/1.12_0/summary.json", "first");
  Put(results_ / "x/1.12_3/summary.json", "second");
  const std::string result = results_ / "a/seed-0002";
  EXPECT_EQ(PublishRun(results_ / "x/1.12_0", result), "");
  EXPECT_EQ(PublishRun(results_ / "x/1.12_3", result), "");
  EXPECT_EQ(ReadText(result + "/summary.json"), "first");
  EXPECT_TRUE(fs::is_empty(results_ / "x"));
  EXPECT_THAT(PublishRun(results_ / "x/1.12_4", results_ / "a/seed-0003"),
              HasSubstr("No such file"));
}

TEST_F(SlurmWorkFolderTest, JobsOfARetiredFolderChangeNothing) {
  const SlurmWorkFolder folder(WorkFolderIn(results_, "tcs-1"));
  ASSERT_EQ(folder.Make(work_), "");
  Put(folder.RunFolder(0, "12_0") + "/summary.json", "late");
  EXPECT_THAT(RetireWorkFolders(results_), ElementsAre("tcs-1"));
  EXPECT_FALSE(fs::exists(results_ / "slurm"));
  EXPECT_NE(PublishRun(folder.RunFolder(0, "12_0"), results_ / "seed-0001"), "");
  EXPECT_FALSE(fs::exists(results_ / "seed-0001"));
  EXPECT_FALSE(folder.TryToClaim(1, {"12_0", "n1"}));
  EXPECT_THAT(RetireWorkFolders(results_), IsEmpty());
}

}  // namespace
}  // namespace tcs
