// A bag in MCAP is what readers that are not ours read (tests/mcap), holds what was written, and
// survives its writer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coordinator/record/message_definitions.h"
#include "tests/unit/record/bag_fixture.h"

namespace tcs::record {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// What a command prints, without the newline at the end, and whether it failed.
struct Said {
  std::string text;
  bool failed;
};

Said Execute(const std::string& command) {
  Said said{"", true};
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return said;
  std::array<char, 4096> buffer;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) {
    said.text.append(buffer.data(), n);
  }
  said.failed = pclose(pipe) != 0;
  if (said.text.ends_with('\n')) said.text.pop_back();
  return said;
}

std::string Contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class McapTest : public BagFixture {
 protected:
  McapTest() : BagFixture(StorageKind::kMcap, "flight_0.mcap") {}

  void SetUp() override {
    const Said installed = Execute(TCS_MCAP_INSTALL " '" TCS_BUILD "'");
    if (installed.failed) GTEST_SKIP() << installed.text;
    reader_ = "node '" + installed.text + "/read.mjs' ";
  }

  struct Read {
    std::vector<nlohmann::json> channels, messages;
    nlohmann::json end;
  };
  Said Reader(const std::string& kind = "") const { return Execute(reader_ + File() + " " + kind); }
  // All lines that the reader prints.
  Read ReadAll(const std::string& kind = "") const {
    const Said said = Reader(kind);
    EXPECT_FALSE(said.failed) << said.text;
    Read read;
    std::istringstream lines(said.text);
    for (std::string line; std::getline(lines, line);) {
      auto json = nlohmann::json::parse(line, nullptr, false);
      EXPECT_FALSE(json.is_discarded()) << line;
      if (json.contains("topic")) read.channels.push_back(json);
      if (json.contains("of")) read.messages.push_back(json);
      if (json.contains("profile")) read.end = json;
    }
    return read;
  }

  // That the first `count` of them are there.
  static void ExpectSamples(const Read& read, int count) {
    ASSERT_EQ(read.messages.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const nlohmann::json& message = read.messages[static_cast<std::size_t>(i)];
      EXPECT_EQ(message["of"], "/odom");
      EXPECT_EQ(message["stamp"]["number"], std::to_string(kStart + i * kPeriod));
      const auto& fields = message["fields"];
      ASSERT_EQ(fields.size(), 2 + 1 + 1 + 7 + 36 + 6 + 36u);
      EXPECT_EQ(fields[3], "hunter");
      EXPECT_EQ(fields[4], i);
      EXPECT_EQ(fields[5], 0.1);
      EXPECT_EQ(fields[10], 1);
    }
  }

  std::string reader_;
};

TEST_F(McapTest, IsReadByOthers) {
  constexpr int kSamples = 1234;  // of several chunks
  Record(kSamples);
  const Read read = ReadAll();
  ExpectSamples(read, kSamples);
  ASSERT_EQ(read.channels.size(), 1u);
  EXPECT_EQ(read.channels[0]["topic"], "/odom");
  EXPECT_EQ(read.channels[0]["type"], "nav_msgs/msg/Odometry");
  EXPECT_EQ(read.channels[0]["encoding"], "cdr");
  EXPECT_EQ(read.channels[0]["profiles"], OfferedQosYaml(std::vector{dds::Qos()}));
  EXPECT_EQ(read.channels[0]["hash"],
            "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
  EXPECT_EQ(read.channels[0]["definition"],
            DefinitionOf("nav_msgs/msg/Odometry", dds::RosRelease::kIron));
  EXPECT_EQ(read.end["profile"], "ros2");
  EXPECT_EQ(read.end["chunks"], 13);
}

TEST_F(McapTest, IsABagOfTwoFilesThatSaysSo) {
  Record(301);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(Folder()))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre("flight_0.mcap", "metadata.yaml"));
  const YAML::Node info = Metadata();
  EXPECT_EQ(info["storage_identifier"].as<std::string>(), "mcap");
  EXPECT_EQ(info["relative_file_paths"][0].as<std::string>(), "flight_0.mcap");
  EXPECT_EQ(info["message_count"].as<int>(), 301);
  EXPECT_EQ(info["duration"]["nanoseconds"].as<std::int64_t>(), 300 * kPeriod);
}

TEST_F(McapTest, KeepsTopicsApartAndThoseWithoutMessages) {
  Bag bag(dds::RosRelease::kHumble, StorageKind::kMcap);
  ASSERT_EQ(bag.Open(Folder()), "");
  const int range = bag.AddTopic("/range", "sensor_msgs/msg/Range");
  const int own = bag.AddTopic("/own", "my_robot/msg/State");
  bag.Write(range, kStart, dds::EncodeClock(0));
  bag.Write(own, kStart + 1, std::vector<std::byte>(5, std::byte{7}));
  bag.Write(own, kStart + 2'000'000'000, {});
  bag.AddTopic("/other", "sensor_msgs/msg/Range");
  bag.AddTopic("/range", "std_msgs/msg/String");
  EXPECT_EQ(bag.Close(), "");
  // A clock is no range, and nobody is to read it as one.
  const Said said = Reader();
  EXPECT_TRUE(said.failed);

  Bag other(dds::RosRelease::kHumble, StorageKind::kMcap);
  ASSERT_EQ(other.Open(Folder()), "");
  const int clock = other.AddTopic("/clock", "rosgraph_msgs/msg/Clock");
  const int state = other.AddTopic("/own", "my_robot/msg/State");
  other.AddTopic("/range", "sensor_msgs/msg/Range");
  other.Write(state, kStart + 2'000'000'000, {});
  other.Write(clock, kStart, dds::EncodeClock(kStart));
  other.Write(state, kStart + 1, std::vector<std::byte>(5, std::byte{7}));
  other.AddTopic("/late", "sensor_msgs/msg/Range");
  EXPECT_EQ(other.Close(), "");
  const Read read = ReadAll();
  std::vector<std::string> topics;
  for (const auto& channel : read.channels) topics.push_back(channel["topic"]);
  EXPECT_THAT(topics, ElementsAre("/clock", "/own", "/range", "/late"));
  EXPECT_EQ(read.channels[1]["type"], "my_robot/msg/State");
  EXPECT_FALSE(read.channels[1].contains("hash"));
  EXPECT_EQ(read.channels[1]["definition"], "");
  EXPECT_EQ(read.channels[2]["definition"],
            DefinitionOf("sensor_msgs/msg/Range", dds::RosRelease::kHumble));
  ASSERT_EQ(read.messages.size(), 3u);
  EXPECT_EQ(read.messages[0]["cdr"], "");
  EXPECT_EQ(read.messages[1]["fields"], nlohmann::json({1'700'000'000, 0}));
  EXPECT_EQ(read.messages[2]["cdr"], "BwcHBwc=");
}

TEST_F(McapTest, IsEmptyWhereNothingWasWritten) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(Folder()), "");
  EXPECT_EQ(bag.Close(), "");
  const Read read = ReadAll();
  EXPECT_EQ(read.end["messages"], 0);
  EXPECT_EQ(read.end["chunks"], 0);
}

TEST_F(McapTest, OfAKilledWriterIsReadToItsLastChunk) {
  RecordUntilKilled(350);  // three and a half chunks
  ExpectSamples(ReadAll("cut-off"), 300);
  EXPECT_EQ(Metadata()["message_count"].as<int>(), 300);
}

TEST_F(McapTest, ThatIsCutAnywhereIsReadAsFarAsItsChunksGo) {
  Record(300);
  const std::string whole = Contents(File());
  for (std::size_t size : {whole.size() - 1, whole.size() * 3 / 4, whole.size() / 2}) {
    std::ofstream(File(), std::ios::binary | std::ios::trunc) << whole.substr(0, size);
    const Read read = ReadAll("cut-off");
    EXPECT_EQ(read.messages.size() % 100, 0u);
    ExpectSamples(read, static_cast<int>(read.messages.size()));
  }
}

TEST_F(McapTest, WithAnotherByteIsRefused) {
  Record(300);
  const std::string whole = Contents(File());
  // In the first chunk, and in the summary.
  for (const std::size_t at : {std::size_t{600}, whole.size() - 60}) {
    std::string other = whole;
    other[at] = static_cast<char>(other[at] ^ 0x10);
    std::ofstream(File(), std::ios::binary | std::ios::trunc) << other;
    EXPECT_TRUE(Reader().failed) << at;
  }
}

TEST_F(McapTest, IsTheSameOfTheSameSamples) {
  Record(250);
  const std::string first = Contents(File());
  Record(250);
  EXPECT_EQ(Contents(File()), first);
}

TEST_F(McapTest, WritesLargeSamplesBeforeTheSecondIsOver) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(Folder()), "");
  const int topic = bag.AddTopic("/cloud", "my_robot/msg/Cloud");
  std::vector<std::byte> megabyte(1 << 20);
  unsigned random = 1;  // what cannot be compressed
  for (std::byte& byte : megabyte) byte = std::byte((random = random * 1664525 + 1013904223) >> 24);
  for (int i = 0; i < 5; ++i) bag.Write(topic, kStart, megabyte);
  EXPECT_EQ(Metadata()["message_count"].as<int>(), 4);
  EXPECT_EQ(bag.Close(), "");
  const Read read = ReadAll();
  EXPECT_EQ(read.messages.size(), 5u);
  EXPECT_EQ(read.end["chunks"], 5);
  EXPECT_EQ(read.messages[4]["cdr"], read.messages[0]["cdr"]);
}

TEST_F(McapTest, OnAFullDiskSaysWhatIsMissing) {
  ExpectSaysWhatIsMissingBeyond(1 << 13);
  // All chunks before the one that had no room.
  const int kept = Metadata()["message_count"].as<int>();
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, 1000);
  EXPECT_EQ(kept % 100, 0);
  ExpectSamples(ReadAll("cut-off"), kept);
}

TEST_F(McapTest, ThatCannotBeMadeIsOneSentence) {
  Bag bag = NewBag();
  const std::string error = bag.Open("/proc/no/such");
  EXPECT_THAT(error, HasSubstr("/proc/no/such"));
  EXPECT_EQ(error.find('\n'), std::string::npos);
  fs::create_directories(File() + "/full");
  EXPECT_THAT(bag.Open(Folder()), HasSubstr("cannot be replaced"));
  EXPECT_FALSE(bag.is_open());
}

}  // namespace
}  // namespace tcs::record
