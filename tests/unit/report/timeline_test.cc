#include "coordinator/report/timeline.h"

#include "coordinator/report/timeline_figure.h"
#include "tests/unit/report/result_folder.h"

namespace tcs::report {
namespace {

class TimelineTest : public ResultFolderTest {
 protected:
  Timeline Read(const std::string& csv) {
    Write("run/dispatches.csv", csv);
    auto read = ReadTimeline(Path("run"), "system");
    const auto* error = std::get_if<LoadError>(&read);
    EXPECT_EQ(error, nullptr) << error->message;
    return error == nullptr ? std::get<Timeline>(read) : Timeline{};
  }
  static constexpr auto kHeader = "row,virtual_start_ns,virtual_end_ns,real_start_ns,real_end_ns\n";
};

TEST_F(TimelineTest, ThreadsShareTheirClientsRowBelowTheDynamics) {
  const Timeline timeline = Read(std::string(kHeader) +
                                 "r/b #3,0,1000,0,1000\nr/b,1000,2000,1500,2500\n"
                                 "r/a,0,1000,3000,4000\ndynamics,0,2000,5000,6000\n");
  EXPECT_EQ(timeline.rows, (std::vector<std::string>{"dynamics", "r/a", "r/b"}));
  ASSERT_EQ(timeline.slices.size(), 4u);
  EXPECT_EQ(timeline.slices[0].row, 2);
  EXPECT_EQ(timeline.slices[1].row, 2);
  EXPECT_EQ(timeline.slices[3].row, 0);
  EXPECT_EQ(timeline.virtual_end, 2);
  EXPECT_EQ(timeline.real_end, 6);
}

TEST_F(TimelineTest, ARunWithoutRealTimesHasVirtualOnes) {
  const Timeline timeline = Read("row,virtual_start_ns,virtual_end_ns\nr/a,5000,7000\n");
  EXPECT_FALSE(timeline.has_real_times);
  EXPECT_EQ(timeline.slices.at(0).virtual_start, 5);
  EXPECT_FALSE(DrawTimelines({timeline}, 760).content.empty());
}

TEST_F(TimelineTest, ManySlicesBecomeFewWithoutLosingWhoRan) {
  std::string csv = kHeader;
  for (int i = 0; i < 500; ++i) {
    csv += fmt::format("r/a,{0},{1},{0},{1}\ndynamics,{0},{1},{1},{2}\n", i * 100'000,
                       i * 100'000 + 90'000, i * 100'000 + 95'000);
  }
  std::vector<Timeline> timelines{Read(csv), Read(std::string(kHeader) + "r/a,0,1,0,1\n")};
  const auto ran = [](const Timeline& timeline, int row) {
    std::int64_t sum = 0;
    for (const Slice& slice : timeline.slices) sum += slice.row == row ? slice.real_ran : 0;
    return sum;
  };
  const std::int64_t dynamics = ran(timelines[0], 0), client = ran(timelines[0], 1);
  Shorten(&timelines, 100);
  const Timeline& timeline = timelines[0];
  EXPECT_LT(timeline.slices.size(), 100u);
  EXPECT_GT(timeline.merged_us, 0);
  EXPECT_EQ(ran(timeline, 0), dynamics);
  EXPECT_EQ(ran(timeline, 1), client);
  EXPECT_EQ(timeline.slices.front().virtual_start, 0);
  EXPECT_EQ(timeline.virtual_end, 49'990);
  EXPECT_EQ(timelines[1].merged_us, 0) << "it was short already";
}

TEST_F(TimelineTest, NothingCanBeShorterThanASliceARow) {
  std::vector<Timeline> timelines{Read(std::string(kHeader) + "r/a,0,9,0,9\nr/b,0,9,9,18\n")};
  Shorten(&timelines, 1);
  EXPECT_EQ(timelines[0].slices.size(), 2u);
  timelines.clear();
  Shorten(&timelines, 0);
}

TEST_F(TimelineTest, SlicesThatAreCloseInOneTimeOnlyStayApart) {
  const std::vector<Slice> slices{{0, 0, 10, 0, 10, 10, 10}, {0, 10, 20, 5000, 5010, 10, 10}};
  EXPECT_EQ(Merged(slices, 100).size(), 2u);
  EXPECT_EQ(Merged(slices, 5000).size(), 1u);
}

// The bytes are those that page/timeline.js takes apart.
TEST_F(TimelineTest, SlicesAreDifferencesInBytesOfSevenBits) {
  const Timeline timeline =
      Read(std::string(kHeader) + "r/a,0,300000,1000,301000\nr/a,100000,200000,400000,500000\n");
  const auto encoded = nlohmann::json::parse(Encoded(timeline));
  EXPECT_EQ(encoded.at("count"), 2);
  // 0; 0; 300 = 172 2; 1; 300 | 0; 100-300 = -200, zigzag 399 = 143 3; 100; 400-1 = 143 3; 100
  EXPECT_EQ(encoded.at("slices"), "AACsAgGsAgCPA2SPA2Q=");
}

TEST_F(TimelineTest, ANameCannotEndTheScript) {
  Timeline timeline = Read(std::string(kHeader) + "r/a,0,1,0,1\n");
  timeline.name = "</script><b>\xff";
  const std::string text = Encoded(timeline);
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(text).at("name"), "</script><b>\ufffd");
}

TEST_F(TimelineTest, AFileOfNoUseIsSaid) {
  Write("run/dispatches.csv", std::string(kHeader) + "r/a,5,1,0,1\nr/a,-5,1,0,1\nr/a,x,1,0,1\n");
  const auto read = ReadTimeline(Path("run"), "system");
  ASSERT_TRUE(std::holds_alternative<LoadError>(read));
  EXPECT_NE(std::get<LoadError>(read).message.find("no dispatches"), std::string::npos);
  EXPECT_TRUE(std::holds_alternative<LoadError>(ReadTimeline(Path("none"), "system")));
}

}  // namespace
}  // namespace tcs::report
