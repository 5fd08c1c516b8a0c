#include "coordinator/answers/verdict.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tcs {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

ClientOutcome Controller() {
  ClientOutcome controller{.name = "r/controller", .priority = 80, .figures = {}};
  controller.figures.deadline = {
      .deadline_ns = 10 * kMillisecond, .source = "sensors", .judged = 100};
  return controller;
}

// It has missed so many deadlines of 100.
ClientOutcome LateController(std::int64_t missed, std::int64_t in_a_row, std::int64_t first_ns,
                             const LateTime& late) {
  ClientOutcome controller = Controller();
  controller.figures.deadline.missed = missed;
  controller.figures.deadline.most_in_a_row = in_a_row;
  controller.figures.deadline.first_missed_ns = first_ns;
  controller.figures.late = late;
  return controller;
}

TEST(Verdict, OfClientsThatKeptUpIsSilence) {
  EXPECT_TRUE(VerdictOn({Controller(), {.name = "r/planner"}}, {}, 1000 * kMillisecond).empty());
}

TEST(Verdict, NamesAnOverload) {
  ClientOutcome controller = LateController(100, 100, 20 * kMillisecond,
                                            {.total_ns = 9000 * kMillisecond,
                                             .queued_ns = 7500 * kMillisecond,
                                             .executed_ns = 1500 * kMillisecond});
  for (int i = 0; i < 100; ++i) controller.figures.times.execution.Add(15'100'000);
  EXPECT_EQ(
      VerdictOn({controller}, {}, 1000 * kMillisecond),
      std::vector<std::string>{
          "r/controller missed all 100 of its deadlines (10 ms, the period of sensors), the first "
          "at 0.020 s: it computes 15.1 ms each time, 151 % of a core"});
}

TEST(Verdict, NamesWhoHadTheCore) {
  const ClientOutcome controller =
      LateController(3, 2, 500 * kMillisecond,
                     {.total_ns = 120 * kMillisecond,
                      .queued_ns = 20 * kMillisecond,
                      .executed_ns = 3 * kMillisecond,
                      .others_ns = {{"r/planner", 97 * kMillisecond}}});
  const std::string start =
      "r/controller missed 3 of 100 of its deadlines (10 ms, the period of sensors), up to 2 in a "
      "row, the first at 0.500 s: r/planner";
  EXPECT_EQ(VerdictOn({controller, {.name = "r/planner", .priority = 90}}, {}, 1000 * kMillisecond)
                .front(),
            start + ", of higher priority, had the core for 97 % of that time");
  EXPECT_EQ(VerdictOn({controller, {.name = "r/planner", .priority = 80}}, {}, 1000 * kMillisecond)
                .front(),
            start + ", of the same priority, had the core for 97 % of that time");
}

TEST(Verdict, NamesWhoWasStarved) {
  ClientOutcome controller = Controller();
  controller.figures.longest_wait = {.waited_ns = 900 * kMillisecond,
                                     .release_ns = 100 * kMillisecond,
                                     .response_ns = 900 * kMillisecond,
                                     .by = "r/planner"};
  EXPECT_EQ(
      VerdictOn({controller, {.name = "r/planner", .priority = 90}}, {}, 1000 * kMillisecond),
      std::vector<std::string>{"r/controller was starved: for 900 ms from 0.100 s on it was ready, "
                               "and r/planner, of higher priority, had the core"});
}

TEST(Verdict, CountsWhatWasNeverRead) {
  ClientOutcome controller = Controller();
  InputFigures& input = controller.figures.inputs.emplace_back();
  input.from = "sensors";
  input.sent = 1001;
  input.received = 1000;
  input.unread = 1;  // it came as the run ended
  EXPECT_TRUE(VerdictOn({controller}, {}, 1000 * kMillisecond).empty());
  input.received = 650;
  input.lost = 200;
  input.unread = 151;
  input.oldest_unread_ns = 800 * kMillisecond;
  EXPECT_EQ(
      VerdictOn({controller}, {}, 1000 * kMillisecond),
      std::vector<std::string>{
          "r/controller never read 351 of 1001 datagrams from sensors: 200 were lost because its "
          "socket was full, 151 still waited for it at the end, the oldest since 0.800 s"});
}

TEST(Verdict, IsFiveSentencesAtMost) {
  std::vector<ClientOutcome> clients(9, Controller());
  for (ClientOutcome& client : clients) {
    client.figures.deadline.missed = 1;
    client.figures.times.execution.Add(kMillisecond);
  }
  const std::vector<std::string> all = VerdictOn(clients, {}, 1000 * kMillisecond);
  EXPECT_EQ(all.size(), 9u);
  EXPECT_EQ(Shortened({all.begin(), all.begin() + 5}).back(), all[4]);
  const std::vector<std::string> verdict = Shortened(all);
  ASSERT_EQ(verdict.size(), 5u);
  EXPECT_EQ(verdict.back(), "and 5 findings more, in summary.json");
}

TEST(Verdict, NamesAChainThatIsTooOld) {
  ChainFigures chain{.name = "lidar->wheels", .deadline_ns = 50 * kMillisecond, .missed = 1};
  chain.first_missed_ns = 3120 * kMillisecond;
  chain.age.Add(83 * kMillisecond);
  chain.age.Add(10 * kMillisecond);
  chain.worst.push_back({0,
                         83 * kMillisecond,
                         {{ChainHop::Of::kSensor, "lidar", 22 * kMillisecond},
                          {ChainHop::Of::kProgram, "r/planner", 61 * kMillisecond}}});
  EXPECT_EQ(
      VerdictOn({}, {chain}, 1000 * kMillisecond).front(),
      "lidar->wheels: 1 of 2 commands acted on samples older than 50 ms, the first at 3.120 s; "
      "the oldest was 83 ms old, 61 ms of it r/planner");
  chain.missed = 0;
  EXPECT_TRUE(VerdictOn({}, {chain}, 1000 * kMillisecond).empty());
}

}  // namespace
}  // namespace tcs
