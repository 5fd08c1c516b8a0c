#include "coordinator/compare/read_side.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace tcs::compare {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class ReadSideTest : public ::testing::Test {
 protected:
  ReadSideTest() {
    std::string path = ::testing::TempDir() + "side.XXXXXX";
    root_ = mkdtemp(path.data());
  }
  ~ReadSideTest() override { std::filesystem::remove_all(root_); }

  void Write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = root_ + "/" + name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  void WriteRun(const std::string& name, std::uint64_t seed, double p50_ms, int status = 0,
                bool interrupted = false) const {
    Write(
        name + "/summary.json",
        fmt::format(
            R"({{"scenario": "s", "seed": {}, "accounting": "measured", "sync": "consistent", "interrupted": {},
                   "virtual_ns": 1000000000, "clients": {{"r/p": {{"ended_at_ns": {}, "wait_status": {},
                   "response_ns": {{"count": 9, "p50": {}, "p99": 9, "max": 9}}}}}}}})",
            seed, interrupted, status == 0 ? -1 : 5, status, p50_ms * 1e6));
  }
  void WriteTrials(const std::string& name, const std::string& vary, int trials) const {
    Write(name + "/trials.json",
          fmt::format(
              R"({{"scenario": "/s.yaml", "name": "t", "first_seed": 1, "trials": {}, "vary": {},
                "options": {{"sync": "consistent", "accounting": "measured", "duration": "", "drift": "", "set": []}},
                "fingerprint": {{"scenario": "", "programs": {{}}}}}})",
              trials, vary));
  }
  std::string Error(const std::string& name) const {
    const auto read = ReadSide(root_ + "/" + name);
    const auto* error = std::get_if<LoadError>(&read);
    return error == nullptr ? "" : error->message;
  }
  Side Read(const std::string& name) const {
    auto read = ReadSide(root_ + "/" + name);
    const auto* side = std::get_if<Side>(&read);
    EXPECT_NE(side, nullptr) << Error(name);
    return side == nullptr ? Side() : *side;
  }

  std::string root_;
};

TEST_F(ReadSideTest, TrialsAreTheirValuesBySeed) {
  WriteTrials("t", "null", 3);
  WriteRun("t/seed-0001", 1, 10);
  WriteRun("t/seed-0002", 2, 12);
  WriteRun("t/seed-0003", 3, 14, 256);
  const Side side = Read("t");
  const Cell& cell = side.cells.at("");
  EXPECT_EQ(cell.trials, 2u);
  EXPECT_EQ(cell.failed, 1u);
  EXPECT_THAT(cell.samples.at("r/p.response_p50").values, ElementsAre(0.010, 0.012));
  EXPECT_THAT(cell.samples.at("r/p.response_p50").seeds, ElementsAre(1, 2));
  EXPECT_THAT(cell.samples.at("run.failed").values, ElementsAre(0, 0, 1));
  EXPECT_EQ(side.scenario, "s");
}

TEST_F(ReadSideTest, AGridHasACellForEachCombinationWhateverTheOrderOfItsKeys) {
  WriteTrials("t", R"([{"key": "z", "values": ["1", "2"]}, {"key": "a", "values": ["x"]}])", 1);
  WriteTrials("u", R"([{"key": "a", "values": ["x"]}, {"key": "z", "values": ["1", "2"]}])", 1);
  for (const char* name : {"t/1,x", "t/2,x", "u/x,1", "u/x,2"}) {
    WriteRun(std::string(name) + "/seed-0001", 1, 10);
  }
  const Side t = Read("t"), u = Read("u");
  EXPECT_THAT(t.cells, SizeIs(2));
  EXPECT_EQ(t.keys, u.keys);
  for (const auto& [label, cell] : t.cells) EXPECT_TRUE(u.cells.contains(label)) << label;
  EXPECT_TRUE(t.cells.contains("a=x z=2"));
}

TEST_F(ReadSideTest, TrialsThatDidNotEndAreCounted) {
  WriteTrials("t", "null", 3);
  WriteRun("t/seed-0001", 1, 10);
  WriteRun("t/seed-0002", 2, 10, 0, true);
  EXPECT_THAT(Read("t").warnings, ElementsAre(HasSubstr("2 of 3 trials of ")));
}

TEST_F(ReadSideTest, ARunHasItsParts) {
  WriteRun("r", 4, 10);
  std::string rows = "client,thread,cause,release_ns,start_ns,end_ns,charged_ns\n";
  for (int i = 0; i < 200; ++i) {
    rows += fmt::format("r/p,0,timer,{},{},{},1000\n", i * 1000, i * 1000, i * 1000 + 400 + i);
  }
  Write("r/activations.csv", rows);
  Write(
      "r/summary.json",
      R"({"scenario": "s", "seed": 4, "accounting": "measured", "sync": "consistent", "interrupted": false,
            "virtual_ns": 1, "real_ns": 1, "drift_ns": 0, "drift_bound_ns": 0, "staleness_ns": 0, "coordinating_ns": 0,
            "clients_ns": 0, "dynamics_ns": 0, "overhead_percent": 0,
            "clients": {"r/p": {"robot": "r", "class": "periodic", "charged_ns": 0, "host_cpu_ns": 0, "stolen_ns": 0,
              "activations": 200, "overruns": 0, "ended_at_ns": -1, "wait_status": 0,
              "response_ns": {"count": 200, "p50": 500, "p99": 598, "max": 599},
              "deadline": {"deadline_ns": 549, "judged": 200, "missed": 50, "most_in_a_row": 50}}}})");
  const Side side = Read("r");
  EXPECT_TRUE(side.is_run);
  const Cell& cell = side.cells.at("");
  EXPECT_THAT(cell.parts.at("r/p.response_p50"), SizeIs(20));
  EXPECT_NEAR(cell.parts.at("r/p.response_p50").front(), 404.5e-9, 1e-12);
  ASSERT_THAT(cell.parts.at("r/p.missed"), SizeIs(20));
  EXPECT_EQ(cell.parts.at("r/p.missed").front(), 0);
  EXPECT_EQ(cell.parts.at("r/p.missed").back(), 1);
}

TEST_F(ReadSideTest, WhatIsNoResultIsNamed) {
  EXPECT_THAT(Error("nothing"), HasSubstr("there is no folder"));
  Write("other/readme.txt", "x");
  EXPECT_THAT(Error("other"), HasSubstr("is no result folder"));
  Write("cut/trace.json", "[");
  EXPECT_THAT(Error("cut"), HasSubstr("the run did not end"));
  WriteRun("stopped", 1, 10, 0, true);
  EXPECT_THAT(Error("stopped"), HasSubstr("was interrupted"));
  Write("broken/summary.json", "{");
  EXPECT_THAT(Error("broken"), HasSubstr("is damaged"));
  Write("bad/trials.json", "{}");
  EXPECT_THAT(Error("bad"), HasSubstr("trials.json is damaged"));
  Write("typed/summary.json", R"({"seed": "one", "interrupted": false, "clients": [3]})");
  EXPECT_THAT(Error("typed"), HasSubstr("is damaged"));
  WriteTrials("huge", R"([{"key": "a", "values": ["1", "2"]}])", 2'000'000'000);
  EXPECT_THAT(Error("huge"), HasSubstr("trials.json is damaged"));
  WriteTrials("empty", "null", 2);
  EXPECT_THAT(Error("empty"), HasSubstr("no trial that went to its end"));
}

TEST(PartMedians, AreThoseOfNeighbours) {
  std::vector<double> values(10);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  EXPECT_THAT(PartMedians(values, 2), ElementsAre(2, 7));
  EXPECT_TRUE(PartMedians(values, 3).empty());
}

}  // namespace
}  // namespace tcs::compare
