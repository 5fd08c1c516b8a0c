// A run's topics, as they come to the hub, in a bag.
#include "coordinator/record/recording.h"

#include <gmock/gmock.h>
#include <sqlite3.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <stdexcept>

#include "tests/unit/dds/client.h"

namespace tcs::record {
namespace {

namespace fs = std::filesystem;
using dds::Client;
using dds::EndpointKind;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::int64_t kEpoch = 1'704'067'200'000'000'000;

class RecordingTest : public testing::Test {
 protected:
  RecordingTest() {
    std::string name = (fs::temp_directory_path() / "tcs_recording_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    folder_ = name;
    hub_.Observe(&log_);
    log_.Tell(&recording_);
    EXPECT_EQ(recording_.Open(folder_ + "/bag"), "");
  }
  ~RecordingTest() override { fs::remove_all(folder_); }

  // After a client has sent, as the engine does it.
  void Go(std::int64_t now_ns) {
    recording_.ReadNewTopics(now_ns);
    while (ends_.Take(now_ns).has_value()) {
    }
  }
  // "TOPIC STAMP DATA" of each message, the stamp since the run's start.
  std::vector<std::string> Close() {
    EXPECT_EQ(recording_.Close(), "");
    sqlite3* database = nullptr;
    sqlite3_open((folder_ + "/bag/bag_0.db3").c_str(), &database);
    const std::string sql =
        "SELECT name || ' ' || (timestamp - " + std::to_string(kEpoch) +
        ") || ' ' || CAST(data AS TEXT) FROM messages JOIN topics ON topics.id = topic_id "
        "ORDER BY messages.id";
    std::vector<std::string> rows;
    const auto add = [](void* to, int, char** columns, char**) {
      static_cast<std::vector<std::string>*>(to)->push_back(columns[0]);
      return 0;
    };
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), add, &rows, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
    return rows;
  }
  YAML::Node Metadata() const {
    return YAML::LoadFile(folder_ + "/bag/metadata.yaml")["rosbag2_bagfile_information"];
  }
  // The readers that `client` has been told of.
  static std::vector<dds::Endpoint> ReadersFor(Client& client, std::int64_t now_ns) {
    std::vector<dds::Endpoint> readers;
    for (const dds::Received& one : client.Take(shm::DdsKind::kEndpoint, now_ns)) {
      readers.push_back(dds::DecodeEndpoint(one.payload).value());
      EXPECT_EQ(readers.back().kind, EndpointKind::kReader);
    }
    return readers;
  }

  std::string folder_;
  dds::Hub hub_;
  dds::OwnEndpoints ends_{hub_};
  dds::TopicLog log_{[](dds::Hub::Number) { return dds::Speaker{}; }};
  Recording recording_{log_, ends_, kEpoch, dds::RosRelease::kIron};
};

TEST_F(RecordingTest, ReadsEachTopicOnceInAWayThatSuitsAllItsWriters) {
  Client client(hub_, 0);
  dds::Qos strict = dds::kLatched;
  strict.deadline = VirtualDuration::Milliseconds(5);
  client.Announce(1, dds::AWriter("rt/scan", dds::kCareless), 10);
  client.Announce(2, dds::AWriter("rt/scan"), 10);
  client.Announce(3, dds::AReader("rt/cmd", strict), 10);
  Go(10);
  const auto readers = ReadersFor(client, 10);
  ASSERT_THAT(readers, SizeIs(2));
  EXPECT_EQ(readers[0].topic, "rt/scan");
  EXPECT_EQ(readers[1].topic, "rt/cmd");
  for (const dds::Endpoint& reader : readers) {
    EXPECT_EQ(reader.qos.history, dds::History::kKeepAll);
    EXPECT_EQ(dds::WhatDoesNotMatch(reader.qos, dds::kCareless), std::nullopt);
  }
  // And none because of its own readers.
  Go(20);
  EXPECT_THAT(ReadersFor(client, 20), IsEmpty());
}

// What such a writer has written before it is met, it tells who asks for it.
TEST_F(RecordingTest, AsksForWhatAWriterKeeps) {
  Client client(hub_, 0);
  client.Announce(1, dds::AWriter("rt/map", dds::kLatched), 10);
  dds::Qos no_history = dds::kLatched;
  no_history.reliability = dds::Reliability::kBestEffort;
  client.Announce(2, dds::AWriter("rt/other_map", no_history), 10);
  Go(10);
  const auto readers = ReadersFor(client, 10);
  ASSERT_THAT(readers, SizeIs(2));
  EXPECT_EQ(readers[0].qos.durability, dds::Durability::kTransientLocal);
  EXPECT_EQ(readers[0].qos.reliability, dds::Reliability::kReliable);
  EXPECT_EQ(readers[1].qos.durability, dds::Durability::kVolatile);
}

// Nodes see the readers, and expect them to say what type they mean.
TEST_F(RecordingTest, ReadsWithTheHashOfTheType) {
  Client client(hub_, 0);
  dds::Endpoint odom = dds::AWriter("rt/odom"), own = dds::AWriter("rt/own");
  odom.type = "nav_msgs::msg::dds_::Odometry_";
  const std::string hash = "RIHS01_" + std::string(64, '7');
  own.user_data = "serviceid=1;typehash=" + hash + ";";
  client.Announce(1, odom, 10);
  client.Announce(2, own, 10);
  Go(10);
  const auto readers = ReadersFor(client, 10);
  ASSERT_THAT(readers, SizeIs(2));
  EXPECT_EQ(readers[0].user_data,
            "typehash=RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0;");
  EXPECT_EQ(readers[1].user_data, "typehash=" + hash + ";");
}

TEST_F(RecordingTest, HasEachSampleOnceAtTheTimeWhenItWasWritten) {
  const auto odom = ends_.Add(dds::AWriter("rt/odom"), 0, 0);
  Go(0);
  ends_.Write(odom, dds::BytesOf("o1"), kEpoch, 0);
  Client client(hub_, 50), other(hub_, 50);
  client.Announce(1, dds::AWriter("rt/cmd"), 100);
  other.Announce(1, dds::AReader("rt/cmd"), 100);
  other.Announce(2, dds::AReader("rt/odom"), 100);
  Go(100);
  client.Write(1, "cmd1", {shm::kDdsCoordinator, other.number()}, 123'456'789,
               {.stamp_ns = kEpoch});
  ends_.Write(odom, dds::BytesOf("o2"), kEpoch + 200'000'000, 200'000'000);
  // To both of them, but it is the program's clock that the other one has come to.
  client.Write(1, "cmd2", {other.number(), shm::kDdsCoordinator}, 300'000'000,
               {.stamp_ns = kEpoch + 1});
  EXPECT_THAT(Close(), ElementsAre("/odom 0 o1", "/cmd 123456789 cmd1", "/odom 200000000 o2",
                                   "/cmd 300000000 cmd2"));
  EXPECT_EQ(Metadata()["message_count"].as<int>(), 4);
  EXPECT_EQ(Metadata()["duration"]["nanoseconds"].as<std::int64_t>(), 300'000'000);
  EXPECT_EQ(Metadata()["starting_time"]["nanoseconds_since_epoch"].as<std::int64_t>(), kEpoch);
}

TEST_F(RecordingTest, SaysWhatEachWriterOffers) {
  Client client(hub_, 0);
  client.Announce(1, dds::AWriter("rt/scan", dds::kCareless), 10);
  client.Announce(2, dds::AWriter("rt/scan", dds::kLatched), 10);
  client.Announce(3, dds::AWriter("rt/scan", dds::kLatched), 10);
  client.Announce(4, dds::AReader("rt/scan"), 10);
  Go(10);
  EXPECT_THAT(Close(), IsEmpty());
  const YAML::Node topics = Metadata()["topics_with_message_count"];
  ASSERT_EQ(topics.size(), 1u);
  const YAML::Node offers =
      YAML::Load(topics[0]["topic_metadata"]["offered_qos_profiles"].as<std::string>());
  ASSERT_EQ(offers.size(), 2u) << "each kind once, and readers offer nothing";
  EXPECT_EQ(offers[0]["reliability"].as<int>(), 2);
  EXPECT_EQ(offers[1]["durability"].as<int>(), 1);
}

TEST_F(RecordingTest, LeavesOutWhatRosSaysOfItsNodes) {
  const auto nodes = ends_.Add(dds::AWriter("ros_discovery_info", dds::kLatched), 0, 0);
  ends_.Write(nodes, dds::BytesOf("nodes"), kEpoch, 0);
  Client client(hub_, 0);
  client.Announce(1, dds::AWriter("ros_discovery_info", dds::kLatched), 10);
  client.Announce(2, dds::AWriter("rt/odom"), 10);
  Go(10);
  client.Write(2, "odom", {shm::kDdsCoordinator}, 20, {.stamp_ns = kEpoch});
  EXPECT_THAT(Close(), ElementsAre("/odom 20 odom"));
  EXPECT_EQ(Metadata()["topics_with_message_count"].size(), 1u);
}

}  // namespace
}  // namespace tcs::record
