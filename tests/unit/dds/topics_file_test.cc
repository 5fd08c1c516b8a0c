// topics.json says what a run's hub says, and whatever stands there is read or refused.
#include "coordinator/dds/topics_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <variant>

#include "tests/unit/dds/some_topics.h"

namespace tcs::dds {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

class TopicsFileTest : public testing::Test {
 protected:
  TopicsFileTest() {
    std::string name = (fs::temp_directory_path() / "tcs_topics_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    folder_ = name;
  }
  ~TopicsFileTest() override { fs::remove_all(folder_); }

  std::string Path() const { return folder_ + "/topics.json"; }
  std::string Text() const {
    std::ifstream file(Path());
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string Complaint() const {
    const auto read = ReadTopics(folder_);
    const auto* error = std::get_if<LoadError>(&read);
    return error == nullptr ? "" : error->message;
  }

  std::string folder_;
};

TEST_F(TopicsFileTest, SaysHowManyEndpointsWereAlike) {
  std::vector<TopicReport> topics = {SomeTopics()[1]};
  topics[0].endpoints[0].count = 300;
  ASSERT_EQ(WriteTopics(topics, Path()), "");
  EXPECT_EQ(std::get<0>(ReadTopics(folder_))[0].endpoints[0].count, 300);
}

TEST_F(TopicsFileTest, WhatIsNoFileIsRefusedAndNotWaitedFor) {
  fs::create_directory(Path());
  EXPECT_THAT(Complaint(), EndsWith("topics.json is no file that can be read; make the run again"));
  fs::remove(Path());
  ASSERT_EQ(mkfifo(Path().c_str(), 0600), 0);
  EXPECT_THAT(Complaint(), EndsWith("topics.json is no file that can be read; make the run again"));
}

TEST_F(TopicsFileTest, ComesBackAsItWasInTheOrderOfNames) {
  ASSERT_EQ(WriteTopics(SomeTopics(), Path()), "");
  const auto read = ReadTopics(folder_);
  ASSERT_TRUE(std::holds_alternative<std::vector<TopicReport>>(read)) << Complaint();
  const auto& topics = std::get<std::vector<TopicReport>>(read);
  ASSERT_EQ(topics.size(), 2u);
  EXPECT_EQ(topics[0].topic, "/map");
  EXPECT_EQ(topics[0].domain, 3);
  const TopicReport odom = SomeTopics()[0];
  EXPECT_EQ(topics[1].topic, odom.topic);
  EXPECT_EQ(topics[1].type, odom.type);
  EXPECT_EQ(topics[1].samples, 201);
  EXPECT_EQ(topics[1].bytes, 201 * 716);
  EXPECT_EQ(topics[1].first_ns, 0);
  EXPECT_EQ(topics[1].last_ns, 2'000'000'000);
  EXPECT_EQ(topics[1].drops, 2);
  ASSERT_EQ(topics[1].endpoints.size(), odom.endpoints.size());
  for (std::size_t i = 0; i < odom.endpoints.size(); ++i) {
    EXPECT_EQ(topics[1].endpoints[i].kind, odom.endpoints[i].kind);
    EXPECT_EQ(topics[1].endpoints[i].process, odom.endpoints[i].process);
    EXPECT_EQ(topics[1].endpoints[i].robot, odom.endpoints[i].robot);
    EXPECT_EQ(topics[1].endpoints[i].qos, odom.endpoints[i].qos);
  }
  EXPECT_EQ(topics[0].endpoints[0].qos, SomeTopics()[1].endpoints[0].qos);
}

TEST_F(TopicsFileTest, IsJsonForOtherPrograms) {
  ASSERT_EQ(WriteTopics(SomeTopics(), Path()), "");
  const auto odom = nlohmann::json::parse(Text()).at("topics").at(1);
  EXPECT_EQ(odom.at("rate_hz"), 100.0);
  EXPECT_EQ(odom.at("endpoints").at(0).at("kind"), "writer");
  EXPECT_EQ(odom.at("endpoints").at(0).at("qos").at("deadline_ns"), nullptr);
  EXPECT_EQ(odom.at("endpoints").at(1).at("qos").at("deadline_ns"), 1'500'000'000);
  EXPECT_EQ(odom.at("endpoints").at(1).at("qos").at("history"), "keep_all");
}

TEST_F(TopicsFileTest, DoesNotDependOnTheOrderTopicsCame) {
  ASSERT_EQ(WriteTopics(SomeTopics(), Path()), "");
  const std::string text = Text();
  std::vector<TopicReport> backwards = SomeTopics();
  std::swap(backwards[0], backwards[1]);
  ASSERT_EQ(WriteTopics(backwards, Path()), "");
  EXPECT_EQ(Text(), text);
}

TEST_F(TopicsFileTest, HoldsNamesThatAreNoUtf8) {
  ASSERT_EQ(WriteTopics({{"/\xff", "\x80"}}, Path()), "");
  EXPECT_EQ(Complaint(), "");
}

TEST_F(TopicsFileTest, OfNothingIsEmpty) {
  ASSERT_EQ(WriteTopics({}, Path()), "");
  EXPECT_EQ(std::get<std::vector<TopicReport>>(ReadTopics(folder_)).size(), 0u);
}

TEST_F(TopicsFileTest, ThatIsMissingIsExplained) {
  EXPECT_THAT(Complaint(), HasSubstr("has no topics.json: no program of the run used DDS"));
  const auto nowhere = ReadTopics("/no/such");
  EXPECT_EQ(std::get<LoadError>(nowhere).message,
            "there is no folder '/no/such'; give one that tcsim run has written");
}

TEST_F(TopicsFileTest, ThatIsNotOursIsDamagedWhateverItHolds) {
  ASSERT_EQ(WriteTopics(SomeTopics(), Path()), "");
  const std::string whole = Text();
  // Cut off anywhere, and each key once under another name.
  for (std::size_t size = 0; size + 2 < whole.size(); size += 17) {
    std::ofstream(Path()) << whole.substr(0, size);
    EXPECT_THAT(Complaint(), HasSubstr("topics.json is damaged; make the run again")) << size;
  }
  int keys = 0;
  for (std::size_t at = whole.find("\":"); at != std::string::npos;
       at = whole.find("\":", at + 1)) {
    if (whole.substr(at - 7, 7) == "rate_hz") continue;  // derived: not read
    if (whole.substr(at - 5, 5) == "count") continue;    // earlier files do not have it
    std::string text = whole;
    text.insert(at, "x");
    std::ofstream(Path()) << text;
    EXPECT_THAT(Complaint(), HasSubstr("is damaged")) << text.substr(at - 10, 20);
    ++keys;
  }
  EXPECT_GT(keys, 20);
  std::string other_word = whole;
  other_word.replace(other_word.find("reliable"), 8, "reliably");
  std::ofstream(Path()) << other_word;
  EXPECT_THAT(Complaint(), HasSubstr("is damaged"));
}

TEST_F(TopicsFileTest, OfALaterVersionIsRefused) {
  std::ofstream(Path()) << R"({"version": 2, "topics": "something else"})";
  EXPECT_THAT(Complaint(), HasSubstr("topics.json was written by a later tcsim"));
}

TEST(TopicReport, HasTheRateBetweenItsFirstAndItsLastSample) {
  TopicReport topic;
  EXPECT_EQ(topic.RateHz(), 0);
  topic.Count(5'000'000'000, 10);
  EXPECT_EQ(topic.RateHz(), 0);
  topic.Count(5'500'000'000, 10);
  EXPECT_EQ(topic.RateHz(), 2);
  topic.Count(6'000'000'000, 10);
  EXPECT_EQ(topic.RateHz(), 2);
  EXPECT_EQ(topic.bytes, 30);
}

}  // namespace
}  // namespace tcs::dds
