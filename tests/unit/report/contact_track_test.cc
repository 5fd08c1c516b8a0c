#include "coordinator/report/contact_track.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace tcs::report {
namespace {

using Point = ContactTrack::Point;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::SizeIs;

const ContactTrack::Pair kOnFloor{"foot", "floor", false}, kOnBox{"foot", "box", true};

// Two points of one pair and one of another, at each of so many moments.
ContactTrack Steps(std::size_t moments, std::size_t most_points) {
  ContactTrack track(most_points);
  for (std::size_t i = 0; i < moments; ++i) {
    track.Add(i, kOnFloor, {0, 0, 0}, {0, 0, 3});
    track.Add(i, kOnBox, {5, 5, 5}, {1, 0, 0});
    track.Add(i, kOnFloor, {4, 0, 0}, {0, 2, 1});
  }
  return track;
}

TEST(ContactTrack, KeepsAllThatThereIsRoomFor) {
  const ContactTrack track = Steps(10, 30);
  EXPECT_THAT(track.points(), SizeIs(30));
  EXPECT_FALSE(track.has_sums());
  EXPECT_EQ(track.stride(), 1u);
  EXPECT_EQ(track.pairs()[1].second, "box");
  EXPECT_TRUE(track.pairs()[1].second_moves);
}

TEST(ContactTrack, SumsWhatTwoThingsDoToEachOtherWhereThereAreMore) {
  const ContactTrack track = Steps(10, 20);
  ASSERT_THAT(track.points(), SizeIs(20));
  EXPECT_TRUE(track.has_sums());
  EXPECT_EQ(track.stride(), 1u);
  const double second = std::hypot(2, 1), share = second / (3 + second);
  for (const Point& point : track.points()) {
    if (point.pair != 0) continue;
    EXPECT_THAT(point.force_n, ElementsAre(0, 2, 4)) << point.moment;
    EXPECT_NEAR(point.point_m[0], 4 * share, 1e-12) << "nearer to the stronger one";
  }
}

TEST(ContactTrack, LeavesMomentsOutWhereThatIsNotEnough) {
  const ContactTrack track = Steps(100, 60);
  EXPECT_EQ(track.stride(), 4u);
  EXPECT_THAT(track.points(), SizeIs(50));
  for (const Point& point : track.points()) EXPECT_EQ(point.moment % 4, 0u);
}

TEST(ContactTrack, IsBoundedHoweverMuchTouchesAtOnce) {
  ContactTrack track(5);
  for (int i = 0; i < 100; ++i) {
    track.Add(0, {"a" + std::to_string(i), "b", false}, {}, {0, 0, 1});
  }
  EXPECT_THAT(track.points(), SizeIs(5));
  ContactTrack none(0);
  none.Add(0, kOnBox, {}, {0, 0, 1});
  EXPECT_THAT(none.points(), SizeIs(0));
}

TEST(ContactTrack, GoesWithMomentsThatAreThinned) {
  ContactTrack track = Steps(10, 1000);
  track.Thin();
  EXPECT_THAT(track.points(), SizeIs(15));
  EXPECT_EQ(track.points().back().moment, 4u);
}

TEST(ContactTrack, APartCountsFromItsOwnBeginning) {
  const ContactTrack part = Steps(10, 1000).Part(3, 5);
  ASSERT_THAT(part.points(), SizeIs(6));
  EXPECT_EQ(part.points().front().moment, 0u);
  EXPECT_EQ(part.points().back().moment, 1u);
  EXPECT_THAT(part.pairs(), SizeIs(2));
}

TEST(ContactTrack, LeavesOutWhatComesTooLate) {
  ContactTrack track;
  track.Add(5, kOnFloor, {}, {0, 0, 1});
  track.Add(4, kOnFloor, {}, {0, 0, 2});
  EXPECT_THAT(track.points(), SizeIs(1));
  EXPECT_THAT(track.points(), Each(Field(&Point::moment, 5u)));
}

// What does not change takes a byte for each number.
TEST(ContactTrack, IsWrittenSmall) {
  const std::size_t moments = 1000;
  const nlohmann::json track = ToJson(Steps(moments, 1'000'000), moments);
  EXPECT_LT(track["data"].get<std::string>().size(), moments * (1 + 3 * 7) * 4 / 3 + 100);
  EXPECT_TRUE(ToJson(ContactTrack(), moments).is_null());
}

}  // namespace
}  // namespace tcs::report
