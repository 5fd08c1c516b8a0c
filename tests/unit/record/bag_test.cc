// A recorded bag is what rosbag2 reads, holds what was written, and survives its writer.
#include "coordinator/record/bag.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "coordinator/dds/robot_topics.h"
#include "coordinator/record/message_definitions.h"
#include "tests/unit/record/bag_fixture.h"

namespace tcs::record {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// The database as somebody else reads it.
class Reader {
 public:
  explicit Reader(const std::string& path) {
    if (sqlite3_open_v2(path.c_str(), &database_, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK) {
      ADD_FAILURE() << path << ": " << sqlite3_errmsg(database_);
    }
  }
  ~Reader() { sqlite3_close(database_); }

  // The rows, each with its columns as texts joined by '|'.
  std::vector<std::string> Rows(const char* sql) const {
    std::vector<std::string> rows;
    Each(sql, [&rows](sqlite3_stmt* row) {
      std::string text;
      for (int i = 0; i < sqlite3_column_count(row); ++i) {
        const auto* column = reinterpret_cast<const char*>(sqlite3_column_text(row, i));
        text += (i > 0 ? "|" : "") + std::string(column == nullptr ? "NULL" : column);
      }
      rows.push_back(text);
    });
    return rows;
  }

  std::vector<std::vector<std::byte>> Blobs(const char* sql) const {
    std::vector<std::vector<std::byte>> blobs;
    Each(sql, [&blobs](sqlite3_stmt* row) {
      const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(row, 0));
      blobs.emplace_back(data, data + sqlite3_column_bytes(row, 0));
    });
    return blobs;
  }

 private:
  template <class Take>
  void Each(const char* sql, Take take) const {
    sqlite3_stmt* statement = nullptr;
    ASSERT_EQ(sqlite3_prepare_v2(database_, sql, -1, &statement, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database_);
    int result;
    while ((result = sqlite3_step(statement)) == SQLITE_ROW) take(statement);
    EXPECT_EQ(result, SQLITE_DONE) << sqlite3_errmsg(database_);
    sqlite3_finalize(statement);
  }

  sqlite3* database_ = nullptr;
};

class BagTest : public BagFixture {
 protected:
  BagTest() : BagFixture(StorageKind::kSqlite3, "flight_0.db3") {}
};

TEST_F(BagTest, IsAFolderOfTwoFiles) {
  Record(3);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(Folder()))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre("flight_0.db3", "metadata.yaml"));
}

TEST_F(BagTest, HasTheTablesOfRosbag2) {
  Record(3);
  const Reader reader(File());
  EXPECT_THAT(reader.Rows("PRAGMA integrity_check"), ElementsAre("ok"));
  EXPECT_THAT(reader.Rows("SELECT schema_version, ros_distro FROM schema"), ElementsAre("4|iron"));
  // Name, type, and whether NULL is refused, of each column.
  const char* const kColumns = "SELECT name, type, \"notnull\", pk FROM pragma_table_info(";
  const auto columns = [&](const std::string& table) {
    return reader.Rows((kColumns + ("'" + table) + "')").c_str());
  };
  EXPECT_THAT(columns("topics"),
              ElementsAre("id|INTEGER|0|1", "name|TEXT|1|0", "type|TEXT|1|0",
                          "serialization_format|TEXT|1|0", "offered_qos_profiles|TEXT|1|0",
                          "type_description_hash|TEXT|1|0"));
  EXPECT_THAT(columns("message_definitions"),
              ElementsAre("id|INTEGER|0|1", "topic_type|TEXT|1|0", "encoding|TEXT|1|0",
                          "encoded_message_definition|TEXT|1|0", "type_description_hash|TEXT|1|0"));
  EXPECT_THAT(columns("messages"), ElementsAre("id|INTEGER|0|1", "topic_id|INTEGER|1|0",
                                               "timestamp|INTEGER|1|0", "data|BLOB|1|0"));
  EXPECT_THAT(columns("metadata"),
              ElementsAre("id|INTEGER|0|1", "metadata_version|INTEGER|1|0", "metadata|TEXT|1|0"));
  EXPECT_THAT(reader.Rows("SELECT name, tbl_name FROM sqlite_master WHERE type = 'index'"),
              ElementsAre("timestamp_idx|messages"));
  EXPECT_THAT(reader.Rows("PRAGMA journal_mode"), ElementsAre("delete"));
}

TEST_F(BagTest, HoldsEverySampleWithItsTime) {
  constexpr int kSamples = 1234;  // of several batches
  Record(kSamples);
  const Reader reader(File());
  EXPECT_THAT(reader.Rows("SELECT id, name, type, serialization_format FROM topics"),
              ElementsAre("1|/odom|nav_msgs/msg/Odometry|cdr"));
  // As rosbag2 reads.
  const auto times = reader.Rows(
      "SELECT timestamp, topics.name FROM messages JOIN topics ON messages.topic_id = topics.id "
      "ORDER BY timestamp, messages.id");
  const auto blobs = reader.Blobs("SELECT data FROM messages ORDER BY timestamp, id");
  ASSERT_EQ(times.size(), std::size_t{kSamples});
  ASSERT_EQ(blobs.size(), std::size_t{kSamples});
  for (int i = 0; i < kSamples; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(times[at], std::to_string(kStart + i * kPeriod) + "|/odom");
    const auto read = dds::FromCdr<dds::OdometryMessage>(blobs[at]);
    ASSERT_TRUE(std::holds_alternative<dds::Owned<dds::OdometryMessage>>(read));
    EXPECT_EQ(std::get<0>(read)->pose.pose.position.x, i);
  }
}

TEST_F(BagTest, CountsItsSamplesInTheMetadata) {
  Record(301);
  const YAML::Node info = Metadata();
  EXPECT_EQ(info["message_count"].as<int>(), 301);
  EXPECT_EQ(info["starting_time"]["nanoseconds_since_epoch"].as<std::int64_t>(), kStart);
  EXPECT_EQ(info["duration"]["nanoseconds"].as<std::int64_t>(), 300 * kPeriod);
  EXPECT_EQ(info["relative_file_paths"][0].as<std::string>(), "flight_0.db3");
  EXPECT_EQ(info["topics_with_message_count"][0]["message_count"].as<int>(), 301);
  const Reader reader(File());
  EXPECT_THAT(reader.Rows("SELECT metadata_version FROM metadata"), ElementsAre("5"));
  const YAML::Node inside = YAML::Load(reader.Rows("SELECT metadata FROM metadata").at(0));
  EXPECT_EQ(YAML::Dump(inside), YAML::Dump(info));
}

TEST_F(BagTest, KeepsEachOfferOnce) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(Folder()), "");
  const int odom = bag.AddTopic("/odom", "nav_msgs/msg/Odometry");
  dds::Qos other;
  other.depth = 3;
  bag.AddOffer(odom, {});
  bag.AddOffer(odom, other);
  bag.AddOffer(odom, {});
  EXPECT_EQ(bag.Close(), "");
  const std::string expected = OfferedQosYaml(std::vector{dds::Qos(), other});
  EXPECT_THAT(Reader(File()).Rows("SELECT offered_qos_profiles FROM topics"),
              ElementsAre(expected));
  EXPECT_EQ(Metadata()["topics_with_message_count"][0]["topic_metadata"]["offered_qos_profiles"]
                .as<std::string>(),
            expected);
}

TEST_F(BagTest, DefinesEachTypeOnce) {
  Bag bag(dds::RosRelease::kHumble);
  ASSERT_EQ(bag.Open(Folder()), "");
  for (const char* topic : {"/one", "/other"}) bag.AddTopic(topic, "sensor_msgs/msg/Range");
  bag.AddTopic("/own", "my_robot/msg/State");
  EXPECT_EQ(bag.Close(), "");
  const Reader reader(File());
  EXPECT_THAT(reader.Rows("SELECT schema_version, ros_distro FROM schema"),
              ElementsAre("4|humble"));
  const std::string range = DefinitionOf("sensor_msgs/msg/Range", dds::RosRelease::kHumble);
  EXPECT_THAT(range, testing::Not(HasSubstr("variance")));
  EXPECT_THAT(
      reader.Rows("SELECT topic_type, encoding, encoded_message_definition, "
                  "type_description_hash FROM message_definitions ORDER BY id"),
      ElementsAre("sensor_msgs/msg/Range|ros2msg|" + range + "|", "my_robot/msg/State|unknown||"));
}

// As of Iron, which has hashes.
TEST_F(BagTest, SaysTheHashesOfTypes) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(Folder()), "");
  bag.AddTopic("/said", "std_msgs/msg/String");
  bag.AddTopic("/own", "my_robot/msg/State");
  bag.AddTopic("/told", "my_robot/msg/Pose", "RIHS01_1");
  EXPECT_EQ(bag.Close(), "");
  const std::string hash =
      "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";
  const Reader reader(File());
  EXPECT_THAT(reader.Rows("SELECT name, type_description_hash FROM topics ORDER BY id"),
              ElementsAre("/said|" + hash, "/own|", "/told|RIHS01_1"));
  EXPECT_THAT(
      reader.Rows("SELECT topic_type, type_description_hash FROM message_definitions ORDER BY id"),
      ElementsAre("std_msgs/msg/String|" + hash, "my_robot/msg/State|",
                  "my_robot/msg/Pose|RIHS01_1"));
}

TEST_F(BagTest, NamesOneTopicOfTwoTypesTwice) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(Folder()), "");
  const int first = bag.AddTopic("/state", "a/msg/A");
  const int second = bag.AddTopic("/state", "a/msg/B");
  const int third = bag.AddTopic("/state", "a/msg/C");
  EXPECT_EQ(bag.AddTopic("/state", "a/msg/A"), first);
  EXPECT_EQ(bag.AddTopic("/state", "a/msg/B"), second);
  EXPECT_EQ(bag.AddTopic("/state", "a/msg/C"), third);
  EXPECT_EQ(bag.Close(), "");
  EXPECT_THAT(Reader(File()).Rows("SELECT name, type FROM topics ORDER BY id"),
              ElementsAre("/state|a/msg/A", "/state_2|a/msg/B", "/state_3|a/msg/C"));
}

TEST_F(BagTest, TakesSamplesThatAreNotInOrderOrEmpty) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(Folder()), "");
  const int topic = bag.AddTopic("/t", "a/msg/A");
  const std::vector<std::byte> one = {std::byte{1}}, none;
  bag.Write(topic, kStart + 5, one);
  bag.Write(topic, kStart, none);
  bag.Write(topic, kStart + 3'000'000'000, one);
  bag.Write(topic, kStart + 2, one);
  EXPECT_EQ(bag.Close(), "");
  EXPECT_EQ(Metadata()["starting_time"]["nanoseconds_since_epoch"].as<std::int64_t>(), kStart);
  EXPECT_EQ(Metadata()["duration"]["nanoseconds"].as<std::int64_t>(), 3'000'000'000);
  EXPECT_THAT(Reader(File()).Rows("SELECT length(data) FROM messages ORDER BY timestamp"),
              ElementsAre("0", "1", "1", "1"));
}

TEST_F(BagTest, ReplacesAnEarlierOne) {
  Record(50);
  Record(3);
  EXPECT_THAT(Reader(File()).Rows("SELECT count(*) FROM messages"), ElementsAre("3"));
  EXPECT_EQ(Metadata()["message_count"].as<int>(), 3);
}

TEST_F(BagTest, OfAKilledWriterCanBeOpened) {
  RecordUntilKilled(350);  // three and a half batches
  const Reader reader(File());
  EXPECT_THAT(reader.Rows("PRAGMA integrity_check"), ElementsAre("ok"));
  // All but the last batch; and the metadata say the same.
  EXPECT_THAT(reader.Rows("SELECT count(*) FROM messages"), ElementsAre("300"));
  EXPECT_EQ(Metadata()["message_count"].as<int>(), 300);
  EXPECT_EQ(Metadata()["duration"]["nanoseconds"].as<std::int64_t>(), 299 * kPeriod);
}

TEST_F(BagTest, WritesLargeSamplesBeforeTheSecondIsOver) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(Folder()), "");
  const int topic = bag.AddTopic("/cloud", "sensor_msgs/msg/PointCloud2");
  const std::vector<std::byte> megabyte(1 << 20);
  for (int i = 0; i < 5; ++i) bag.Write(topic, kStart, megabyte);
  EXPECT_EQ(Metadata()["message_count"].as<int>(), 4);
  EXPECT_THAT(Reader(File()).Rows("SELECT count(*) FROM messages"), ElementsAre("4"));
  EXPECT_EQ(bag.Close(), "");
  EXPECT_EQ(Metadata()["message_count"].as<int>(), 5);
}

TEST_F(BagTest, OnAFullDiskSaysWhatIsMissing) {
  ExpectSaysWhatIsMissingBeyond(1 << 16);
  const Reader reader(File());
  EXPECT_THAT(reader.Rows("PRAGMA integrity_check"), ElementsAre("ok"));
  EXPECT_EQ(reader.Rows("SELECT count(*) FROM messages").at(0),
            Metadata()["message_count"].as<std::string>());
}

TEST_F(BagTest, ThatCannotBeMadeIsOneSentence) {
  Bag bag = NewBag();
  const std::string error = bag.Open("/proc/no/such");
  EXPECT_THAT(error, HasSubstr("/proc/no/such"));
  EXPECT_EQ(error.find('\n'), std::string::npos);
  fs::create_directories(File());  // a folder where the file should be
  fs::create_directories(File() + "/full");
  EXPECT_THAT(bag.Open(Folder()), HasSubstr("cannot be replaced"));
  EXPECT_FALSE(bag.is_open());
}

TEST_F(BagTest, IsCalledAfterItsFolder) {
  Bag bag = NewBag();
  ASSERT_EQ(bag.Open(root_ + "/run.1/"), "");
  EXPECT_EQ(bag.Close(), "");
  EXPECT_TRUE(fs::exists(root_ + "/run.1/run.1_0.db3"));
}

}  // namespace
}  // namespace tcs::record
