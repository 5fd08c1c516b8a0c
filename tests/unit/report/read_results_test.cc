#include "coordinator/report/read_results.h"

#include "tests/unit/report/result_folder.h"

namespace tcs::report {
namespace {

class ReadResultsTest : public ResultFolderTest {
 protected:
  Results Read(const std::vector<std::string>& names, const std::vector<std::string>& bodies = {},
               Distance distance = Distance::kRead) {
    auto read = ReadResults(Paths(names), bodies, distance);
    const auto* error = std::get_if<LoadError>(&read);
    EXPECT_EQ(error, nullptr) << error->message;
    return error == nullptr ? std::get<Results>(read) : Results{};
  }
  std::string Refused(const std::vector<std::string>& names,
                      const std::vector<std::string>& bodies = {}) {
    const auto read = ReadResults(Paths(names), bodies);
    const auto* error = std::get_if<LoadError>(&read);
    return error == nullptr ? "" : error->message;
  }
  std::vector<std::string> Paths(const std::vector<std::string>& names) {
    std::vector<std::string> paths;
    for (const std::string& name : names) paths.push_back(Path(name));
    return paths;
  }
};

TEST_F(ReadResultsTest, ARunIsASystemWithOneTrial) {
  WriteRun("one", 5, 3);
  const Results results = Read({"one/"});
  ASSERT_EQ(results.systems.size(), 1u);
  EXPECT_EQ(results.systems[0].name, "one");
  EXPECT_EQ(results.scenario, "chase");
  EXPECT_EQ(results.bodies[0], "a");
  EXPECT_EQ(results.bodies[1], "b");
  EXPECT_EQ(Distances(results.systems[0]), (std::vector<double>{5, 5, 5}));
  EXPECT_DOUBLE_EQ(results.systems[0].runs[0].overhead, 0.025);
}

TEST_F(ReadResultsTest, OtherBodiesCanBeMeant) {
  WriteRun("one", 5, 1);
  EXPECT_EQ(Distances(Read({"one"}, {"c", "a"}).systems[0]), (std::vector<double>{1}));
  EXPECT_NE(Refused({"one"}, {"a", "d"}).find("no body 'd'"), std::string::npos);
}

TEST_F(ReadResultsTest, LinksOfOneModelAreNotMeasuredAgainstEachOther) {
  WriteRun("one");
  const std::string links = "time_s,body,x_m,y_m,z_m\n0,rover/base,0,0,0\n0,rover/wheel,1,0,0\n";
  Write("one/bodies.csv", links);
  const Results alone = Read({"one"});
  EXPECT_TRUE(Distances(alone.systems[0]).empty());
  EXPECT_EQ(alone.bodies[0], "");
  Write("one/bodies.csv", links + "0,cart/base,7,0,0\n0,cart/wheel,8,0,0\n");
  const Results both = Read({"one"});
  EXPECT_EQ(Distances(both.systems[0]), (std::vector<double>{7}));
  EXPECT_EQ(both.bodies[0], "rover/base");
  EXPECT_EQ(both.bodies[1], "cart/base");
  EXPECT_EQ(Distances(Read({"one"}, {"rover/base", "rover/wheel"}).systems[0]),
            (std::vector<double>{1}));
}

TEST_F(ReadResultsTest, APlannersActivationGoesOnWhileItWaitsForThreads) {
  WriteRun("one");
  std::vector<std::string> warnings;
  const auto read = ReadRunTimes(Path("one"), &warnings);
  const auto& run = std::get<report::Run>(read);
  const ActivationTimes& planner = run.clients.at("r/planner").times;
  ASSERT_EQ(planner.response_s.size(), 1u) << "neither the start nor another thread's";
  EXPECT_DOUBLE_EQ(planner.lateness_s[0], 1e-6);
  EXPECT_DOUBLE_EQ(planner.response_s[0], 1e-3);
  EXPECT_DOUBLE_EQ(planner.computed_s[0], 0.7e-3);
  EXPECT_DOUBLE_EQ(run.clients.at("r/controller").times.lateness_s.at(0), 7e-6);
}

TEST_F(ReadResultsTest, TrialsThatFailedAreNamed) {
  Write("trials/trials.json", R"({"name": "tcs", "first_seed": 7, "trials": 5, "vary": null})");
  WriteRun("trials/seed-0007", 4);
  WriteRun("trials/seed-0008", 6);
  Write("trials/seed-0009/tcsim.log",
        "drift 1 ms\ntcsim: r/planner cannot be started: No such file\ntcsim: warning: x\n");
  WriteRun("trials/seed-0010");
  auto summary = Summary();
  summary["clients"]["r/planner"]["wait_status"] = 256;
  summary["clients"]["r/planner"]["ended_at_ns"] = 1'500'000'000;
  Write("trials/seed-0010/summary.json", summary.dump());
  const Results results = Read({"trials"});
  const System& system = results.systems.at(0);
  EXPECT_EQ(system.name, "tcs");
  EXPECT_EQ(system.runs.size(), 2u);
  ASSERT_EQ(system.failed.size(), 3u);
  EXPECT_EQ(system.failed[0].name, "seed-0009");
  EXPECT_EQ(system.failed[0].why, "r/planner cannot be started: No such file");
  EXPECT_EQ(system.failed[1].why, "r/planner ended at 1.50\u00a0s with exit status 1");
  EXPECT_EQ(system.failed[2].name, "seed-0011");
  EXPECT_EQ(system.failed[2].why, "it was not made");
}

TEST_F(ReadResultsTest, FailuresOfOneKindAreOneSentence) {
  System system{"tcs", {}, {}};
  for (int i = 1; i <= 7; ++i)
    system.failed.push_back({fmt::format("seed-{}", i), "it did not end"});
  system.failed.push_back({"seed-8", "it was not made"});
  EXPECT_EQ(Failures(system), (std::vector<std::string>{
                                  "tcs, seed-1, seed-2, seed-3, seed-4 and 3 more: it did not end",
                                  "tcs, seed-8: it was not made"}));
}

TEST_F(ReadResultsTest, ASweepHasASystemPerValue) {
  Write(
      "sweep/trials.json",
      R"({"first_seed": 1, "trials": 1, "vary": {"key": "duration", "values": ["20s", 60, "../x"]}})");
  WriteRun("sweep/20s/seed-0001");
  WriteRun("sweep/60/seed-0001");
  WriteRun("sweep/_._x/seed-0001");
  const Results results = Read({"sweep"});
  EXPECT_TRUE(results.systems.empty());
  const Sweep& sweep = results.sweeps.at(0);
  EXPECT_EQ(sweep.name, "sweep");
  EXPECT_EQ(sweep.key, "duration");
  ASSERT_EQ(sweep.values.size(), 3u);
  EXPECT_EQ(sweep.values[0].number, 20.0);
  EXPECT_EQ(sweep.values[1].text, "60");
}

TEST_F(ReadResultsTest, AFolderWithoutAGoodRunIsLeftOutIfThereAreOthers) {
  WriteRun("good");
  Write("damaged/summary.json", R"({"scenario": "chase", "interrupted": )");
  Write("odd/summary.json", R"({"scenario": 7})");
  Write("stopped/summary.json", R"({"interrupted": true})");
  Write("unfinished/trace.json", "{");
  Write("broken/trials.json", "[]");
  const Results results = Read({"damaged", "odd", "good", "stopped", "unfinished", "broken"});
  EXPECT_EQ(results.systems.size(), 1u);
  ASSERT_EQ(results.warnings.size(), 5u);
  EXPECT_NE(results.warnings[0].find("damaged/summary.json is damaged"), std::string::npos);
  EXPECT_NE(results.warnings[2].find("stopped/summary.json is damaged"), std::string::npos);
  EXPECT_NE(Refused({"damaged"}).find("damaged"), std::string::npos);
}

TEST_F(ReadResultsTest, ARunThatFailedIsShownWithItsCause) {
  WriteRun("crashed");
  auto summary = Summary();
  summary["clients"]["r/planner"]["wait_status"] = 11;
  summary["clients"]["r/planner"]["ended_at_ns"] = 1'500'000'000;
  Write("crashed/summary.json", summary.dump());
  WriteRun("stopped");
  summary = Summary();
  summary["interrupted"] = true;
  summary["verdict"] = {"SIGINT stopped the run at 2.000 s of its 9 s"};
  Write("stopped/summary.json", summary.dump());
  WriteRun("killed");
  std::filesystem::remove(Path("killed/summary.json"));
  const Results results = Read({"killed", "crashed", "stopped"});
  ASSERT_EQ(results.systems.size(), 3u);
  const auto first = [&](std::size_t i) { return results.systems[i].runs.at(0).verdict.at(0); };
  EXPECT_EQ(first(0),
            "the run was cut off soon after 1.00\u00a0ms: it was killed, ended by an "
            "error, or it still goes on");
  EXPECT_EQ(first(1), "r/planner ended at 1.50\u00a0s with signal 11");
  EXPECT_EQ(first(2), "SIGINT stopped the run at 2.000 s of its 9 s");
  for (const System& system : results.systems) EXPECT_FALSE(system.runs[0].is_whole);
  ASSERT_EQ(results.warnings.size(), 1u);
  EXPECT_NE(results.warnings[0].find("killed has no summary.json"), std::string::npos);
  EXPECT_EQ(results.scenario, "chase");
}

TEST_F(ReadResultsTest, AnswersAreReadAndStartsDoNotCount) {
  WriteRun("one");
  const Results results = Read({"one"});
  const auto& run = results.systems[0].runs[0];
  const auto& controller = run.clients.at("r/controller");
  ASSERT_TRUE(controller.deadline.has_value());
  EXPECT_EQ(controller.deadline->missed, 1);
  EXPECT_EQ(controller.deadline->period_of, "imu");
  EXPECT_EQ(controller.response.max_ns, 9000);
  ASSERT_EQ(controller.responses_s.size(), 2u) << "that of the start, too";
  EXPECT_DOUBLE_EQ(controller.responses_s[1], 9e-6);
  EXPECT_FALSE(run.clients.at("r/planner").deadline.has_value());
  EXPECT_TRUE(Read({"one"}, {}, Distance::kLeftOut).bodies[0].empty());
}

TEST_F(ReadResultsTest, WhatIsNoResultIsRefusedWithASentence) {
  EXPECT_NE(Refused({"nowhere"}).find("there is no folder"), std::string::npos);
  Write("other/notes.txt", "x");
  EXPECT_NE(Refused({"other"}).find("neither summary.json nor trials.json"), std::string::npos);
}

TEST_F(ReadResultsTest, DifferentScenariosAreNotCompared) {
  WriteRun("one");
  WriteRun("two");
  auto summary = Summary();
  summary["scenario"] = "other";
  Write("two/summary.json", summary.dump());
  EXPECT_NE(Refused({"one", "two"}).find("is of scenario 'other'"), std::string::npos);
}

TEST_F(ReadResultsTest, ASystemGivenTwiceHasTwoNames) {
  WriteRun("one");
  const Results results = Read({"one", "one"});
  EXPECT_EQ(results.systems[0].name, "one");
  EXPECT_EQ(results.systems[1].name, "one (2)");
}

TEST_F(ReadResultsTest, LinesOfNoUseAreLeftOutWithAWarning) {
  WriteRun("one");
  Write("one/bodies.csv", Bodies(5, 2) + "0.02,a,x,0,0,0\n0.02,b\n0.02,a,1");
  const Results results = Read({"one"});
  EXPECT_EQ(Distances(results.systems[0]).size(), 2u);
  ASSERT_EQ(results.warnings.size(), 1u);
  EXPECT_NE(results.warnings[0].find("bodies.csv has 3 lines that cannot be used"),
            std::string::npos);
}

TEST_F(ReadResultsTest, ARunWithoutBodiesHasNoDistances) {
  WriteRun("one");
  std::filesystem::remove(Path("one/bodies.csv"));
  const Results results = Read({"one"});
  EXPECT_TRUE(Distances(results.systems[0]).empty());
  EXPECT_EQ(results.bodies[0], "");
}

}  // namespace
}  // namespace tcs::report
