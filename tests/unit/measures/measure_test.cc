#include "coordinator/measures/measure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace tcs {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSummary = R"({
  "drift_ns": 1000000, "staleness_ns": 0, "virtual_ns": 2000000000, "real_ns": 5, "overhead_percent": 2.5,
  "clients": {
    "r/planner": {
      "activations": 20, "charged_ns": 4000000,
      "response_ns": {"count": 20, "p50": 5000000, "p99": 9000000, "max": 12000000},
      "start_delay_ns": {"count": 0, "p50": 0, "p99": 0, "max": 0},
      "deadline": {"deadline_ns": 10000000, "judged": 20, "missed": 5, "most_in_a_row": 2},
      "inputs": [
        {"from": "eyes", "sent": 30, "received": 20, "lost": 4, "replaced": 0, "unread": 1, "most_waiting": 7,
         "age_ns": {"count": 20, "p50": 1000, "p99": 2000, "max": 3000}},
        {"from": "ears", "sent": 10, "received": 9, "lost": 1, "replaced": 2, "unread": 0, "most_waiting": 3,
         "age_ns": {"count": 0, "p50": 0, "p99": 0, "max": 0}}],
      "command_age_ns": null},
    "r/idle": {"deadline": null, "inputs": []}},
  "chains": {"lidar->wheels": {"deadline_ns": 25000000, "missed": 2, "age_ns": {"count": 3, "p50": 20000000, "p99": 30000000, "max": 31000000}}},
  "metrics": {
    "error": {"from": "r/planner", "count": 9, "last": 0.5, "mean": 1.5, "max": null, "first_time_ns": null},
    "far": {"from": "scenario", "asked": "max", "count": 9, "last": 0.5, "max": 2}}
})";

Measures Read() {
  const auto read = MeasuresFromSummary(kSummary);
  EXPECT_TRUE(read.has_value());
  return read.value_or(Measures());
}

TEST(Measures, AreAllThatASummaryHas) {
  const Measures all = Read();
  EXPECT_EQ(all.at("r/planner.misses").value, 5);
  EXPECT_EQ(all.at("r/planner.missed").value, 0.25);
  EXPECT_EQ(all.at("r/planner.misses_in_a_row").value, 2);
  EXPECT_EQ(all.at("r/planner.deadline").value, 0.01);
  EXPECT_EQ(all.at("r/planner.response_p99").value, 0.009);
  EXPECT_EQ(all.at("r/planner.lost").value, 5);
  EXPECT_EQ(all.at("r/planner.replaced").value, 2);
  EXPECT_EQ(all.at("r/planner.backlog").value, 7);
  EXPECT_EQ(all.at("r/planner from eyes.age_max").value, 3e-6);
  EXPECT_EQ(all.at("r/planner.computed").value, 0.004);
  EXPECT_EQ(all.at("chain lidar->wheels.age_p99").value, 0.03);
  EXPECT_EQ(all.at("chain lidar->wheels.misses").value, 2);
  EXPECT_EQ(all.at("chain lidar->wheels.missed").value, 2.0 / 3);
  EXPECT_EQ(all.at("chain lidar->wheels.deadline").value, 0.025);
  EXPECT_EQ(all.at("run.overhead").value, 0.025);
  EXPECT_EQ(all.at("error.last").value, 0.5);
}

// What scenarios may expect of a thing is what summaries have of it.
TEST(Measures, AreNamedByTheirThings) {
  const auto check = [](const std::string& of, const std::vector<FigureName>& figures) {
    for (const auto& [name, measure] : Read()) {
      if (!name.starts_with(of + ".")) continue;
      const auto found = std::ranges::find(figures, std::string_view(name).substr(of.size() + 1),
                                           &FigureName::name);
      ASSERT_NE(found, figures.end()) << name;
      EXPECT_EQ(found->unit, measure.unit) << name;
    }
  };
  check("r/planner", FiguresOfClient());
  check("chain lidar->wheels", FiguresOfChain());
  check("error", FiguresOfMetric());
  check("run", FiguresOfRun());
}

TEST(Measures, OfWhatThereIsNothingThereIsNoMeasure) {
  const Measures all = Read();
  for (const char* name :
       {"r/planner.start_delay_p50", "r/planner from ears.age_max", "r/planner.command_age_p50",
        "r/idle.misses", "r/idle.lost", "error.max", "error.first_time"}) {
    EXPECT_FALSE(all.contains(name)) << name;
  }
}

TEST(Measures, TheRobotsFiguresAreComparedAndTheSimulatorsAreNot) {
  const Measures all = Read();
  for (const char* name : {"r/planner.missed", "r/planner.response_p50", "r/planner.lost",
                           "chain lidar->wheels.age_p99", "error.mean", "far.max"}) {
    EXPECT_TRUE(all.at(name).is_compared) << name;
  }
  for (const char* name : {"run.drift", "run.real", "r/planner.activations", "far.last"}) {
    EXPECT_FALSE(all.at(name).is_compared) << name;
  }
  EXPECT_EQ(all.at("r/planner.lost").worse, WorseWhen::kMore);
  EXPECT_EQ(all.at("error.mean").worse, WorseWhen::kUnknown);
}

TEST(Measures, OtherTextHasNone) {
  for (const char* text : {"", "{", R"({"clients": {"a": {"deadline": {"missed": 1}}}})"}) {
    EXPECT_FALSE(MeasuresFromSummary(text).has_value()) << text;
  }
  EXPECT_TRUE(MeasuresFromSummary(R"({"clients": 3, "metrics": [1]})")->empty());
}

TEST(FindName, TakesTheEndOfANameThatOnlyOneHas) {
  const std::vector<std::string> names{"r/planner.misses", "r/controller.misses",
                                       "q/planner.misses", "robots.r.cpu.speed"};
  EXPECT_EQ(FindName("controller.misses", names, "measure").name, "r/controller.misses");
  EXPECT_EQ(FindName("q/planner.misses", names, "measure").name, "q/planner.misses");
  EXPECT_EQ(FindName("cpu.speed", names, "key").name, "robots.r.cpu.speed");
  EXPECT_THAT(FindName("planner.misses", names, "measure").why_not,
              HasSubstr("may be r/planner.misses or q/planner.misses"));
  EXPECT_THAT(FindName("r/planner.mises", names, "measure").why_not,
              HasSubstr("did you mean 'r/planner.misses'?"));
  EXPECT_THAT(FindName("tea", names, "measure").why_not, HasSubstr("there is: r/planner.misses"));
}

}  // namespace
}  // namespace tcs
