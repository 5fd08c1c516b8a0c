#include <gmock/gmock.h>

#include "coordinator/report/measure_data.h"
#include "coordinator/report/measure_figure.h"
#include "coordinator/report/measure_sections.h"
#include "coordinator/report/measure_words.h"
#include "coordinator/report/read_results.h"
#include "coordinator/report/varied.h"
#include "tests/unit/report/result_folder.h"

namespace tcs::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kSpeed = "robots.r.cpu.speed";

class MeasureTest : public ResultFolderTest {
 protected:
  // Runs of which r/planner misses so many of its 100 deadlines of 10 ms.
  void WriteMisses(const std::string& folder, const std::vector<int>& missed) {
    for (std::size_t i = 0; i < missed.size(); ++i) {
      auto summary = Summary();
      summary["clients"].erase("r/controller");  // whose misses would be beside those
      auto& planner = summary["clients"]["r/planner"];
      planner["deadline"] = {{"deadline_ns", 10'000'000},
                             {"judged", 100},
                             {"missed", missed[i]},
                             {"most_in_a_row", 1}};
      planner["response_ns"] = {
          {"count", 100}, {"p50", 1'000'000}, {"p99", 1'000'000 * (1 + missed[i])}, {"max", 1}};
      Write(fmt::format("{}/seed-{:04}/summary.json", folder, i + 1), summary.dump());
    }
  }
  void WriteSweep() {
    Write("sweep/trials.json", R"({"name": "tcs", "first_seed": 1, "trials": 3,
          "vary": {"key": "robots.r.cpu.speed", "values": ["2", "0.5", "1"]}})");
    WriteMisses("sweep/0.5", {50, 60, 70});
    WriteMisses("sweep/1", {0, 10, 0});
    WriteMisses("sweep/2", {0, 0, 0});
  }
  void WriteGrid() {
    Write("grid/trials.json", R"({"name": "tcs", "first_seed": 1, "trials": 2, "vary": [
          {"key": "robots.r.clients.planner.priority", "values": ["50", "10"]},
          {"key": "robots.r.cpu.speed", "values": ["0.5", "1"]},
          {"key": "dynamics.engine", "values": ["ode", "simbody"]}]})");
    for (const char* priority : {"50", "10"}) {
      for (const char* engine : {"ode", "simbody"}) {
        WriteMisses(fmt::format("grid/{},0.5,{}", priority, engine), {40, 60});
        WriteMisses(fmt::format("grid/{},1,{}", priority, engine), {0, 0});
      }
    }
  }
  Results Read(const std::string& name) {
    auto read = ReadResults({Path(name)}, {});
    const auto* error = std::get_if<LoadError>(&read);
    EXPECT_EQ(error, nullptr) << error->message;
    return error == nullptr ? std::get<Results>(read) : Results{};
  }
};

TEST_F(MeasureTest, MissedDeadlinesAgainstSpeedAreWhatIsShownUnasked) {
  WriteSweep();
  const auto plots = MeasurePlots(Read("sweep"), {});
  ASSERT_THAT(plots, SizeIs(1));
  EXPECT_EQ(plots[0].measure, "r/planner.missed");
  EXPECT_EQ(plots[0].against, kSpeed);
  const auto& points = plots[0].panels.at(0).curves.at(0).points;
  ASSERT_THAT(points, SizeIs(3));
  EXPECT_EQ(points[0].label, "0.5") << "by value, not as they were given";
  EXPECT_THAT(points[0].values, ElementsAre(0.5, 0.6, 0.7));
}

TEST_F(MeasureTest, WhereNobodyIsLateResponseTimesAreShownBesideTheDeadline) {
  Write("sweep/trials.json", R"({"name": "tcs", "first_seed": 1, "trials": 1,
        "vary": {"key": "robots.r.cpu.speed", "values": ["1", "2"]}})");
  WriteMisses("sweep/1", {0});
  WriteMisses("sweep/2", {0});
  const auto plots = MeasurePlots(Read("sweep"), {});
  ASSERT_THAT(plots, SizeIs(1));
  EXPECT_EQ(plots[0].measure, "r/planner.response_p99");
  EXPECT_EQ(plots[0].deadline, 0.01);
  EXPECT_THAT(DrawMeasure(plots[0], kWideWidth).content, HasSubstr(">deadline<"));
}

TEST_F(MeasureTest, AGridHasACurveForEachValueOfOneKeyAndAPanelForEachOfTheOthers) {
  WriteGrid();
  const auto plots = MeasurePlots(Read("grid"), {{"planner.misses"}, ""});
  ASSERT_THAT(plots, SizeIs(1));
  const MeasurePlotData& plot = plots[0];
  EXPECT_EQ(plot.against, kSpeed);
  EXPECT_EQ(plot.curves_are, "planner.priority");
  ASSERT_THAT(plot.panels, SizeIs(2));
  EXPECT_EQ(plot.panels[0].title, "dynamics.engine = ode");
  ASSERT_THAT(plot.panels[1].curves, SizeIs(2));
  EXPECT_EQ(plot.panels[1].curves[0].name, "10");
  EXPECT_EQ(plot.panels[0].curves[1].colour, plot.panels[1].curves[1].colour);
  EXPECT_THAT(plot.panels[1].curves[1].points[0].values, ElementsAre(40, 60));
}

TEST_F(MeasureTest, AnyKeyMayBeTheAxisAndWordsAreInTheirOrder) {
  WriteGrid();
  const auto plots = MeasurePlots(Read("grid"), {{"r/planner.missed"}, "engine"});
  ASSERT_THAT(plots, SizeIs(1));
  EXPECT_FALSE(plots[0].is_numeric);
  const auto& points = plots[0].panels.at(0).curves.at(0).points;
  EXPECT_EQ(points.at(0).label, "ode");
  EXPECT_EQ(points.at(1).at, 1);
}

TEST_F(MeasureTest, TrialsWithoutTheMeasureAreCountedAndTheirValueIsStillOnTheAxis) {
  WriteSweep();
  for (const char* seed : {"seed-0001", "seed-0002", "seed-0003"}) {
    Write(std::string("sweep/0.5/") + seed + "/summary.json", Summary().dump());
  }
  const Results results = Read("sweep");
  const auto plots = MeasurePlots(results, {{"planner.missed"}, ""});
  EXPECT_EQ(plots.at(0).without_value, 3u);
  EXPECT_THAT(plots.at(0).tried, SizeIs(3));
  const auto parts = MeasureSections(results, {{"planner.missed"}, ""});
  EXPECT_THAT(parts.at(0).figure.note, HasSubstr("3 trials have no such figure"));
  EXPECT_THAT(parts.at(0).figure.narrow.content, HasSubstr(">0.5<"));
}

TEST_F(MeasureTest, TheSentenceSaysFromWhereOnNobodyIsLate) {
  WriteSweep();
  const auto parts = MeasureSections(Read("sweep"), {});
  ASSERT_THAT(parts, SizeIs(1));
  EXPECT_EQ(parts[0].figure.title, "Missed deadlines of r/planner against robots.r.cpu.speed");
  EXPECT_THAT(parts[0].figure.sentence,
              HasSubstr("60\u00a0% at 0.5, 0\u00a0% at 2 (none from 1 on)."));
  EXPECT_THAT(parts[0].text, HasSubstr("cpu.speed  trials  10 %"));
  for (const Drawing* drawing : {&parts[0].figure.wide, &parts[0].figure.narrow}) {
    EXPECT_THAT(drawing->content, HasSubstr("missed deadlines of r/planner [% of all]"));
    EXPECT_THAT(drawing->content, HasSubstr("robots.r.cpu.speed [times the host"));
    EXPECT_THAT(drawing->content, HasSubstr("band f0"));
  }
}

TEST_F(MeasureTest, ARequestThatCannotBeMetIsSaid) {
  WriteSweep();
  const Results results = Read("sweep");
  EXPECT_EQ(WhyNoMeasure(results, {{"planner.misses"}, "cpu.speed"}), "");
  EXPECT_THAT(WhyNoMeasure(results, {{"planner.mised"}, ""}),
              HasSubstr("did you mean 'r/planner.missed'?"));
  EXPECT_THAT(WhyNoMeasure(results, {{}, "cores"}), HasSubstr("--against: there is no varied key"));
  WriteRun("one");
  EXPECT_EQ(WhyNoMeasure(Read("one"), {}), "");
  EXPECT_THAT(WhyNoMeasure(Read("one"), {{"planner.missed"}, ""}),
              HasSubstr("these folders have none"));
  EXPECT_THAT(MeasurePlots(Read("one"), {}), IsEmpty());
}

TEST(MeasureSpread, IsWhatATenthAndNineTenthsLieBelow) {
  std::vector<double> values;
  for (int i = 0; i <= 100; ++i) values.push_back(i);
  const MeasureSpread spread = MeasureSpreadOf(values);
  EXPECT_EQ(spread.low, 10);
  EXPECT_EQ(spread.median, 50);
  EXPECT_EQ(spread.high, 90);
}

TEST(ShortKeys, AreAsLongAsTheyMustBe) {
  EXPECT_THAT(ShortKeys({"robots.a.cpu.speed", "drift"}), ElementsAre("cpu.speed", "drift"));
  EXPECT_THAT(ShortKeys({"robots.a.cpu.speed", "robots.b.cpu.speed"}),
              ElementsAre("a.cpu.speed", "b.cpu.speed"));
}

TEST(MeasureWordsTest, ANameOfOnesOwnStaysAsItIs) {
  EXPECT_EQ(MeasureWords("r/planner.response_p99"), "response time (p99) of r/planner");
  EXPECT_EQ(MeasureWords("lap_time.last"), "lap_time.last");
}

}  // namespace
}  // namespace tcs::report
