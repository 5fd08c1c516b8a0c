#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/trials/slurm/array_jobs.h"
#include "coordinator/trials/slurm/commands.h"

namespace tcs {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// As squeue prints it.
std::string Line(const std::string& array, const std::string& task, const std::string& state,
                 const std::string& exit, const std::string& node, const std::string& reason) {
  const auto wide = [](std::string text, std::size_t width) {
    text.resize(width, ' ');
    return text;
  };
  return wide(array, 20) + wide(task, 20) + wide(state, 24) + wide(exit, 16) + wide(node, 128) +
         wide(reason, 128) + "\n";
}

TEST(SlurmQueue, TellsEachJobOfAnArray) {
  const auto queue = ParseQueue(Line("12", "0", "RUNNING", "0", "n1", "None") +
                                Line("12", "1", "PENDING", "0", "", "Resources") +
                                Line("13", "0", "FAILED", "17408", "n2", "NonZeroExitCode"));
  ASSERT_EQ(queue.size(), 3u);
  EXPECT_TRUE(queue.at("12_0").IsAlive());
  EXPECT_FALSE(queue.at("12_0").IsPending());
  EXPECT_EQ(queue.at("12_0").node, "n1");
  EXPECT_EQ(queue.at("12_0").reason, "");
  EXPECT_TRUE(queue.at("12_1").IsAlive());
  EXPECT_TRUE(queue.at("12_1").IsPending());
  EXPECT_EQ(queue.at("12_1").reason, "Resources");
  EXPECT_FALSE(queue.at("13_0").IsAlive());
  EXPECT_EQ(queue.at("13_0").wait_status, kRunWasKilled << 8);
  EXPECT_TRUE(ParseQueue("").empty());
}

TEST(SlurmQueue, HasExitStatusesAsOldAndNewReleasesWriteThem) {
  const auto queue = ParseQueue(Line("1", "0", "FAILED", "17408", "n1", "None") +
                                Line("1", "1", "FAILED", "68:0", "n1", "None") +
                                Line("1", "2", "FAILED", "0:9", "n1", "None"));
  EXPECT_EQ(queue.at("1_0").wait_status, kRunWasKilled << 8);
  EXPECT_EQ(queue.at("1_1").wait_status, kRunWasKilled << 8);
  EXPECT_EQ(WhyGone(&queue.at("1_2")), "FAILED: signal 9");
}

TEST(SlurmQueue, SaysWhyAJobIsGone) {
  EXPECT_EQ(WhyGone(nullptr), "its job is not in the queue any more");
  QueuedJob job;
  job.state = "NODE_FAIL";
  EXPECT_EQ(WhyGone(&job), "NODE_FAIL: the node failed");
  EXPECT_FALSE(job.IsAlive());
  job.state = "TIMEOUT";
  EXPECT_THAT(WhyGone(&job), HasSubstr("--slurm-option=--time="));
  job.state = "OUT_OF_MEMORY";
  EXPECT_THAT(WhyGone(&job), HasSubstr("--slurm-option=--mem="));
  job.state = "FAILED";
  job.wait_status = 9;
  EXPECT_EQ(WhyGone(&job), "FAILED: signal 9");
  job.wait_status = 3 << 8;
  EXPECT_EQ(WhyGone(&job), "FAILED: exit status 3");
  job.wait_status = kRunWasKilled << 8;
  EXPECT_EQ(WhyGone(&job), "FAILED: its run was killed");
}

TEST(SlurmArray, IsAskedForWithTheUsersOptionsAfterOurs) {
  SubmitRequest request;
  request.name = "tcs-1";
  request.tcsim = "/opt/it's/tcsim";
  request.folder = "/shared/out/slurm/tcs-1";
  request.jobs = 5;
  request.options = {"--partition=short", "--mem=2G"};
  auto words = SubmitWords(request);
  EXPECT_EQ(words.front(), "sbatch");
  EXPECT_THAT(words, Contains("--array=0-4"));
  EXPECT_THAT(words, Contains("--no-requeue"));
  EXPECT_THAT(words, Not(Contains("--hint=nomultithread")));
  EXPECT_THAT(words, Not(Contains(HasSubstr("--exclude"))));
  ASSERT_GE(words.size(), 3u);
  EXPECT_EQ(words[words.size() - 3], "--partition=short");
  EXPECT_EQ(words.back(), "--wrap=exec '/opt/it'\\''s/tcsim' slurm-job '/shared/out/slurm/tcs-1'");
  request.whole_cores = true;
  request.excluded_nodes = {"n1", "n3"};
  words = SubmitWords(request);
  EXPECT_THAT(words, Contains("--hint=nomultithread"));
  EXPECT_THAT(words, Contains("--exclude=n1,n3"));
}

TEST(SlurmArray, IsNoLargerThanSlurmHasIt) {
  EXPECT_EQ(LargestArray("MailProg = /bin/mail\nMaxArraySize            = 51\nMaxDBDMsgs = 2\n"),
            51);
  EXPECT_EQ(LargestArray(""), 1001);
}

TEST(SlurmOption, IsOneOfSbatchsThatTcsimDoesNotSet) {
  EXPECT_EQ(WhyNotForSbatch("--partition=short"), "");
  EXPECT_EQ(WhyNotForSbatch("--exclusive"), "");
  EXPECT_THAT(WhyNotForSbatch("partition=short"), HasSubstr("write it like"));
  EXPECT_THAT(WhyNotForSbatch("--"), HasSubstr("write it like"));
  EXPECT_THAT(WhyNotForSbatch("--array=0-9"), HasSubstr("--jobs"));
  EXPECT_THAT(WhyNotForSbatch("--wrap=true"), HasSubstr("set by tcsim"));
}

TEST(SlurmCommands, AreQuotedByTheirReason) {
  EXPECT_EQ(SlurmsReason("sbatch: error: invalid partition specified: nix\n"
                         "sbatch: error: Batch job submission failed: Invalid partition name "
                         "specified\n"),
            "Invalid partition name specified");
  EXPECT_EQ(SlurmsReason("slurm_load_jobs error: Unable to contact slurm controller\n"),
            "Unable to contact slurm controller");
  EXPECT_EQ(SlurmsReason(""), "no reason given");
}

TEST(SlurmCommands, AreRunWithBothTheirOutputs) {
  const CommandResult result =
      RunSlurmCommand({"sh", "-c", "echo 12; echo 'x: error: no' >&2; exit 3"});
  EXPECT_TRUE(result.is_found);
  EXPECT_FALSE(result.succeeded);
  EXPECT_EQ(result.out, "12\n");
  EXPECT_EQ(SlurmsReason(result.said), "no");
  EXPECT_TRUE(RunSlurmCommand({"true"}).succeeded);
  EXPECT_FALSE(RunSlurmCommand({"no-such-command-of-slurm"}).is_found);
}

}  // namespace
}  // namespace tcs
