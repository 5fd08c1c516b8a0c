// What `tcsim topics` prints.
#include "coordinator/dds/topics_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/dds/some_topics.h"

namespace tcs::dds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(TopicsTable, HasALinePerTopic) {
  EXPECT_EQ(
      TopicsTable(SomeTopics(), false),
      "topic  type                   domain  samples    rate  drops  writers         readers\n"
      "/odom  nav_msgs/msg/Odometry       0      201  100 Hz      2  tcsim           "
      "hunter/controller, hunter/planner x2\n"
      "/map   nav_msgs/msg/Path           3        1       -      0  hunter/planner  -\n");
}

TEST(TopicsTable, LeavesTheOnlyDomainOut) {
  EXPECT_THAT(TopicsTable({SomeTopics()[0]}, false), Not(HasSubstr("domain")));
}

TEST(TopicsTable, OfNoTopicsIsItsHead) {
  EXPECT_EQ(TopicsTable({}, true), "topic  type  samples  rate  drops  writers  readers\n");
}

TEST(TopicsTable, HasALinePerEndpointIfAsked) {
  const std::string table = TopicsTable(SomeTopics(), true);
  EXPECT_THAT(table, HasSubstr("\n    writer tcsim: reliable, keep_last 10, volatile\n"));
  EXPECT_THAT(table, HasSubstr("\n    reader hunter/controller: best_effort, keep_all, volatile, "
                               "deadline 1500ms, lifespan 2s, lease 7ns\n"));
  EXPECT_THAT(table, HasSubstr("\n    writer hunter/planner: reliable, keep_last 10, "
                               "transient_local, manual_by_topic\n"));
}

TEST(TopicsTable, CountsEndpointsThatAreAlike) {
  TopicReport topic{"/call", "a/msg/A"};
  topic.endpoints = {{EndpointKind::kWriter, "hunter/planner", "hunter", {}, 300},
                     {EndpointKind::kWriter, "hunter/planner", "hunter", {.depth = 1}}};
  const std::string table = TopicsTable({topic}, true);
  EXPECT_THAT(table, HasSubstr(" hunter/planner x301 "));
  EXPECT_THAT(table, HasSubstr("\n    writer hunter/planner x300: reliable, keep_last 10, "));
  EXPECT_THAT(table, HasSubstr("\n    writer hunter/planner: reliable, keep_last 1, "));
}

TEST(TopicWarnings, NameReadersThatNoWriterSuits) {
  TopicReport topic{"/odom", "nav_msgs/msg/Odometry"};
  Qos best_effort;
  best_effort.reliability = Reliability::kBestEffort;
  topic.endpoints = {{EndpointKind::kWriter, "tcsim", "", best_effort},
                     {EndpointKind::kReader, "hunter/planner", "hunter", {}},
                     {EndpointKind::kReader, "hunter/controller", "hunter", best_effort}};
  EXPECT_THAT(
      TopicWarnings({topic}),
      ElementsAre("/odom: the reader of hunter/planner gets nothing: it wants reliable, but "
                  "is offered best_effort by tcsim"));
  topic.endpoints.push_back({EndpointKind::kWriter, "other/estimator", "other", {}});
  EXPECT_THAT(TopicWarnings({topic}), IsEmpty());
}

TEST(TopicWarnings, CountDrops) {
  EXPECT_THAT(TopicWarnings(SomeTopics()),
              testing::Contains("/odom: 2 samples did not reach a reader that matched"));
}

TEST(TopicWarnings, SayNothingOfAReaderWithoutAnyWriter) {
  TopicReport topic{"/odom", "nav_msgs/msg/Odometry"};
  topic.endpoints = {{EndpointKind::kReader, "hunter/planner", "hunter", {}}};
  EXPECT_THAT(TopicWarnings({topic}), IsEmpty());
}

TEST(TopicWarnings, NameATopicOfTwoTypes) {
  TopicReport written{"/odom", "sensor_msgs/msg/Imu"}, read{"/odom", "nav_msgs/msg/Odometry"};
  written.endpoints = {{EndpointKind::kWriter, "tcsim", "", {}}};
  read.endpoints = {{EndpointKind::kReader, "hunter/planner", "hunter", {}}};
  EXPECT_THAT(
      TopicWarnings({written, read}),
      ElementsAre("/odom: hunter/planner reads nav_msgs/msg/Odometry there, but tcsim writes "
                  "sensor_msgs/msg/Imu, so no sample arrives; use one type at both "
                  "ends"));
  read.domain = 7;
  EXPECT_THAT(TopicWarnings({written, read}), IsEmpty());
}

TEST(TopicWarnings, NameATopicOfTwoDomains) {
  const EndpointReport ours{EndpointKind::kWriter, "tcsim", "", {}};
  TopicReport written{"/odom", "nav_msgs/msg/Odometry"}, read = written;
  written.endpoints = {ours};
  read.domain = 42;
  read.endpoints = {{EndpointKind::kReader, "hunter/planner", "hunter", {}}};
  EXPECT_THAT(TopicWarnings({written, read}),
              ElementsAre("/odom: hunter/planner reads it in domain 42, but tcsim writes it in "
                          "domain 0, so no sample "
                          "arrives; use one domain at both ends (ROS_DOMAIN_ID of programs, "
                          "`domain` of channels)"));
  // Programs that talk in domains of their own may mean to.
  written.endpoints = {{EndpointKind::kWriter, "hunter/camera", "hunter", {}}};
  EXPECT_THAT(TopicWarnings({written, read}), IsEmpty());
}

TEST(TopicWarnings, NameTwoTopicsThatLookLikeOne) {
  Qos all;
  all.history = History::kKeepAll;
  TopicReport written{"/odomm", "nav_msgs/msg/Odometry"}, read{"/odom", "nav_msgs/msg/Odometry"};
  written.endpoints = {{EndpointKind::kWriter, "tcsim", "", {}},
                       {EndpointKind::kReader, "tcsim", "", all}};  // a recording
  read.endpoints = {{EndpointKind::kReader, "hunter/planner", "hunter", {}}};
  EXPECT_THAT(
      TopicWarnings({written, read}),
      ElementsAre(
          "/odom: hunter/planner reads it, and no program writes it; /odomm: tcsim writes it with "
          "the same type, and no program reads it; if they belong together, use one name"));
  // Programs may leave topics to others that are not there.
  written.endpoints[0].process = "hunter/controller";
  EXPECT_THAT(TopicWarnings({written, read}), IsEmpty());
  // Commands of another robot have a reader of their own.
  TopicReport command{"/wrench", "geometry_msgs/msg/Wrench"},
      of_other{"/other/wrench", command.type};
  command.endpoints = {{EndpointKind::kReader, "tcsim", "", {}}};
  of_other.endpoints = {{EndpointKind::kWriter, "other/controller", "other", {}},
                        {EndpointKind::kReader, "tcsim", "", {}}};
  EXPECT_THAT(TopicWarnings({command, of_other}), IsEmpty());
  of_other.endpoints.pop_back();
  EXPECT_THAT(TopicWarnings({command, of_other}), ElementsAre(HasSubstr("use one name")));
}

}  // namespace
}  // namespace tcs::dds
