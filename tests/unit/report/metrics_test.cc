// Metrics of a result folder, as the report's page has them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "coordinator/report/metric_curves.h"

namespace tcs::report {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Key;
using testing::Pair;

class MetricsOfFolder : public testing::Test {
 protected:
  MetricsOfFolder() { std::filesystem::create_directory(folder_); }
  ~MetricsOfFolder() override { std::filesystem::remove_all(folder_); }
  void Write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ + "/" + file) << text;
  }
  const std::string folder_ = testing::TempDir() + "metrics_of_folder_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(MetricsOfFolder, AreThoseOfItsSummaryAndItsTable) {
  Write("summary.json", R"({"metrics": {
    "error": {"from": "r/a", "count": 3, "mean": 0.5, "first_time_ns": 5},
    "caught": {"from": "scenario", "asked": "first_time_when", "count": 2, "first_time_ns": 1500000000},
    "never": {"from": "scenario", "asked": "first_time_when", "count": 2, "first_time_ns": null},
    "r/b/caught": {"from": "r/b", "count": 1, "mean": 7}}})");
  Write("metrics.csv",
        "name,time_ns,value,from\n"
        "error,1000000000,0.25,r/a\n"
        "caught,0,0,scenario\n"
        "caught,2000000000,9,r/b\n"
        "error,500000000,0.75,r/a\n"
        "caught,1500000000,1,scenario\n"
        "stranger,1,1,r/c\n");
  const auto figures = ReadMetricFigures(folder_);
  EXPECT_THAT(figures, ElementsAre(Key("caught"), Key("error"), Key("never"), Key("r/b/caught")));
  EXPECT_EQ(figures.at("error").asked, "mean");
  EXPECT_EQ(figures.at("error").value, 0.5);
  EXPECT_EQ(figures.at("caught").value, 1.5);
  EXPECT_EQ(figures.at("never").value, std::nullopt);
  const auto curves = ReadMetricCurves(folder_, 2, figures);
  EXPECT_THAT(curves, ElementsAre(Key("caught"), Key("error"), Key("r/b/caught")));
  EXPECT_THAT(curves.at("error").points, ElementsAre(Pair(0.5, 0.75), Pair(1, 0.25)));
  EXPECT_THAT(curves.at("caught").points, ElementsAre(Pair(0, 0), Pair(1.5, 1)));
  EXPECT_THAT(curves.at("r/b/caught").points, ElementsAre(Pair(2, 9)));
}

TEST_F(MetricsOfFolder, AreThinnedToWhatOneCanSee) {
  Write("summary.json", R"({"metrics": {"wave": {"from": "r/a", "count": 1, "mean": 0}}})");
  std::string table = "name,time_ns,value,from\n";
  for (int i = 0; i < 20'000; ++i) {
    table += "wave," + std::to_string(i * 50'000) + "," + (i % 2 == 0 ? "1" : "-1") + ",r/a\n";
  }
  Write("metrics.csv", table + "wave,999999999,50,r/a\n");
  const auto points = ReadMetricCurves(folder_, 1, ReadMetricFigures(folder_)).at("wave").points;
  EXPECT_GT(points.size(), 500);
  EXPECT_LT(points.size(), 1000);
  EXPECT_TRUE(std::ranges::is_sorted(points));
  EXPECT_EQ(points.back().second, 50) << "what stands out stays";
}

TEST_F(MetricsOfFolder, MayBeMissingOrDamaged) {
  EXPECT_THAT(ReadMetricFigures(folder_), IsEmpty());
  for (const char* summary : {"", "[]", "{}", R"({"metrics": 3})", R"({"metrics": {"a": 3}})"}) {
    Write("summary.json", summary);
    EXPECT_THAT(ReadMetricFigures(folder_), IsEmpty()) << summary;
  }
  Write("summary.json", R"({"metrics": {"a": {"from": 3, "asked": [], "count": "x"}}})");
  EXPECT_EQ(ReadMetricFigures(folder_).at("a").value, std::nullopt);
  EXPECT_THAT(ReadMetricCurves(folder_, 1, {}), IsEmpty());
  Write("metrics.csv", "what,is,this\n");
  EXPECT_THAT(ReadMetricCurves(folder_, 1, {}), IsEmpty());
}

}  // namespace
}  // namespace tcs::report
