// The coordinator's own writers and readers, met by clients through the hub.
#include "coordinator/dds/own_endpoints.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/unit/dds/client.h"

namespace tcs::dds {
namespace {

using shm::DdsKind;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

class OwnEndpointsTest : public testing::Test {
 protected:
  // The texts of the samples that come for `reader`.
  std::vector<std::string> TakeFor(OwnEndpoints::Index reader, std::int64_t now_ns) {
    std::vector<std::string> texts;
    while (const auto sample = ends_.Take(now_ns)) {
      const auto& readers = sample->readers;
      if (std::find(readers.begin(), readers.end(), reader) == readers.end()) continue;
      texts.emplace_back(reinterpret_cast<const char*>(sample->cdr.data()), sample->cdr.size());
    }
    return texts;
  }
  std::vector<std::string> TextsOf(const std::vector<Received>& samples) {
    std::vector<std::string> texts;
    for (const Received& one : samples) {
      texts.emplace_back(reinterpret_cast<const char*>(one.payload.data()), one.payload.size());
    }
    return texts;
  }

  Hub hub_;
  OwnEndpoints ends_{hub_};
};

TEST_F(OwnEndpointsTest, AreAnnouncedToWhoeverJoinsWithOneParticipantPerDomain) {
  const auto odom = ends_.Add(AWriter("rt/odom", kLatched), 0, 0);
  const auto wrench = ends_.Add(AReader("rt/wrench"), 0, 0);
  const auto far = ends_.Add(AWriter("rt/odom"), 7, 0);
  Client client(hub_, 100);
  const std::vector<Received> told = client.Take(100);
  std::vector<Guid> participants;
  for (const Received& one : told) {
    if (one.header.kind == DdsKind::kParticipant) participants.push_back(one.subject());
  }
  EXPECT_THAT(participants, ElementsAre(ends_.ParticipantOf(odom), ends_.ParticipantOf(far)));
  EXPECT_EQ(ends_.ParticipantOf(odom), ends_.ParticipantOf(wrench));
  ASSERT_THAT(told, SizeIs(5));
  EXPECT_EQ(told[1].subject(), ends_.GuidOf(odom));
  EXPECT_EQ(told[1].other(), ends_.ParticipantOf(odom));
  // DDS's rule, by which Cyclone finds the participant of an endpoint.
  const Guid guid = ends_.GuidOf(odom), participant = ends_.ParticipantOf(odom);
  EXPECT_TRUE(std::equal(guid.begin(), guid.begin() + 12, participant.begin()));
  const auto endpoint = DecodeEndpoint(told[1].payload);
  ASSERT_TRUE(endpoint.has_value());
  EXPECT_EQ(endpoint->topic, "rt/odom");
  EXPECT_EQ(endpoint->kind, EndpointKind::kWriter);
  EXPECT_EQ(endpoint->qos, kLatched);
  EXPECT_EQ(told[4].header.domain, 7u);
}

TEST_F(OwnEndpointsTest, WriteOnceToEachProcessThatReadsTheTopicAtTheTimeWhenItIsDue) {
  const auto odom = ends_.Add(AWriter("rt/odom"), 0, 0);
  Client twice(hub_, 0), once(hub_, 0), elsewhere(hub_, 0), another(hub_, 0);
  twice.Announce(1, AReader("rt/odom"), 10);
  twice.Announce(2, AReader("rt/odom", kCareless), 10);
  once.Announce(1, AReader("rt/odom"), 10);
  elsewhere.Announce(1, AReader("rt/odom"), 10, 7);
  another.Announce(1, AReader("rt/pose"), 10);
  another.Announce(2, AWriter("rt/odom"), 10);
  EXPECT_FALSE(ends_.Take(10).has_value());
  ends_.Write(odom, BytesOf("here"), 5'000, 300);
  for (Client* reads : {&twice, &once}) {
    EXPECT_THAT(reads->Take(DdsKind::kSample, 299), IsEmpty());
    const auto samples = reads->Take(DdsKind::kSample, 300);
    ASSERT_THAT(samples, SizeIs(1));
    EXPECT_TRUE(samples[0].Says("here"));
    EXPECT_EQ(samples[0].subject(), ends_.GuidOf(odom));
    EXPECT_EQ(samples[0].header.time_ns, 300);
    EXPECT_EQ(samples[0].header.source_timestamp_ns, 5'000);
  }
  EXPECT_THAT(elsewhere.Take(DdsKind::kSample, 300), IsEmpty());
  EXPECT_THAT(another.Take(DdsKind::kSample, 300), IsEmpty());
}

TEST_F(OwnEndpointsTest, WriteNoMoreToReadersThatAreGone) {
  const auto odom = ends_.Add(AWriter("rt/odom"), 0, 0);
  Client ends_reader(hub_, 0), ends_all(hub_, 0), dies(hub_, 0), stays(hub_, 0);
  for (Client* client : {&ends_reader, &ends_all, &dies, &stays}) {
    client->Announce(1, AReader("rt/odom"), 10);
  }
  ends_reader.End(1, 20);
  ends_all.End(0, 20);
  hub_.Leave(dies.number(), 20);
  while (ends_.Take(30).has_value()) {
  }
  ends_.Write(odom, BytesOf("later"), 0, 30);
  EXPECT_THAT(ends_reader.Take(DdsKind::kSample, 30), IsEmpty());
  EXPECT_THAT(ends_all.Take(DdsKind::kSample, 30), IsEmpty());
  EXPECT_THAT(stays.Take(DdsKind::kSample, 30), SizeIs(1));
}

TEST_F(OwnEndpointsTest, TellLateReadersWhatTheyAskForAndThatThisWasAll) {
  Qos two = kLatched;
  two.depth = 2;
  const auto kept = ends_.Add(AWriter("rt/map", two), 0, 0);
  const auto lost = ends_.Add(AWriter("rt/scan"), 0, 0);
  for (int i = 1; i <= 3; ++i) {
    ends_.Write(kept, BytesOf("map" + std::to_string(i)), 1000 + i, i);
    ends_.Write(lost, BytesOf("scan"), 1000 + i, i);
  }
  Client late(hub_, 50);
  late.Announce(1, AReader("rt/map", kLatched), 60);
  late.Announce(2, AReader("rt/map"), 60);
  late.Announce(3, AReader("rt/scan"), 60);
  EXPECT_FALSE(ends_.Take(60).has_value());
  const auto told = late.Take(60);
  ASSERT_GE(told.size(), 3u);
  const std::vector<Received> last(told.end() - 3, told.end());
  EXPECT_THAT(TextsOf(last), ElementsAre("map2", "map3", ""));
  EXPECT_EQ(last[0].header.source_timestamp_ns, 1002) << "as it was written";
  EXPECT_EQ(last[0].header.time_ns, 60) << "not before the reader was there";
  EXPECT_EQ(last[2].header.kind, DdsKind::kHistoryEnd);
  for (const Received& one : last) {
    EXPECT_EQ(one.other(), late.GuidOf(1)) << "for the one reader only";
    EXPECT_EQ(one.subject(), ends_.GuidOf(kept));
  }
  // From here on as everybody else; and another QoS is no new reader.
  ends_.Write(kept, BytesOf("map4"), 1004, 70);
  late.Announce(1, AReader("rt/map", kLatched), 71);
  EXPECT_FALSE(ends_.Take(71).has_value());
  EXPECT_THAT(TextsOf(late.Take(80)), ElementsAre("map4"));
  // Gone and back again it is one.
  late.End(1, 90);
  late.Announce(1, AReader("rt/map", kLatched), 91);
  EXPECT_FALSE(ends_.Take(91).has_value());
  EXPECT_THAT(TextsOf(late.Take(91)), ElementsAre("map3", "map4", ""));
}

TEST_F(OwnEndpointsTest, KeepAllThatIsToBeKept) {
  Qos all = kLatched;
  all.history = History::kKeepAll;
  const auto map = ends_.Add(AWriter("rt/map", all), 0, 0);
  for (int i = 0; i < 30; ++i) ends_.Write(map, BytesOf("map"), i, i);
  Client late(hub_, 50);
  late.Announce(1, AReader("rt/map", kLatched), 60);
  EXPECT_FALSE(ends_.Take(60).has_value());
  EXPECT_THAT(late.Take(DdsKind::kSample, 60), SizeIs(30));
}

TEST_F(OwnEndpointsTest, TakeInTheOrderOfTimesNotBeforeTheyMay) {
  const auto wrench = ends_.Add(AReader("rt/wrench", kCareless), 0, 0);
  Client fast(hub_, 0), slow(hub_, 0);
  fast.Announce(1, AWriter("rt/wrench"), 1);
  slow.Announce(1, AWriter("rt/wrench"), 1);
  fast.Write(1, "third", {shm::kDdsCoordinator}, 30, {.stamp_ns = 30});
  slow.Write(1, "first", {shm::kDdsCoordinator}, 10, {.stamp_ns = 10});
  slow.Write(1, "second", {shm::kDdsCoordinator}, 20, {.stamp_ns = 20});
  const auto sample = ends_.Take(29);
  ASSERT_TRUE(sample.has_value());
  EXPECT_EQ(sample->cdr, BytesOf("first"));
  EXPECT_EQ(sample->at_ns, 10);
  EXPECT_THAT(TakeFor(wrench, 29), ElementsAre("second"));
  EXPECT_THAT(TakeFor(wrench, 30), ElementsAre("third"));
}

TEST_F(OwnEndpointsTest, TakeOnlyDataOfWritersThatSuitTheReader) {
  const auto strict = ends_.Add(AReader("rt/wrench"), 0, 0);
  const auto any = ends_.Add(AReader("rt/wrench", kCareless), 0, 0);
  Client client(hub_, 0);
  client.Announce(1, AWriter("rt/wrench"), 1);
  client.Announce(2, AWriter("rt/wrench", kCareless), 1);
  client.Announce(3, AWriter("rt/pose"), 1);
  Endpoint other_type = AWriter("rt/wrench");
  other_type.type = "geometry_msgs::msg::dds_::Twist_";
  client.Announce(4, other_type, 1);
  client.Announce(5, AWriter("rt/wrench"), 1, 7);
  const auto write_all = [&client](std::int64_t at_ns) {
    for (std::uint8_t writer = 1; writer <= 6; ++writer) {
      client.Write(writer, "from " + std::to_string(writer), {shm::kDdsCoordinator}, at_ns,
                   {.stamp_ns = at_ns});
    }
  };
  write_all(10);
  EXPECT_THAT(TakeFor(strict, 10), ElementsAre("from 1")) << "not what is offered best effort";
  write_all(20);
  EXPECT_THAT(TakeFor(any, 20), ElementsAre("from 1", "from 2"));
  // The end of an instance is no command.
  client.Write(1, "gone", {shm::kDdsCoordinator}, 30, {.stamp_ns = 30, .kind = 1});
  EXPECT_FALSE(ends_.Take(30).has_value());
}

// One reader that is for late samples, as a recording's, does not bring them to the others.
TEST_F(OwnEndpointsTest, TakeWhatIsAddressedToOneReaderForThatOneOnly) {
  const auto command = ends_.Add(AReader("rt/wrench", kCareless), 0, 0);
  const auto recorder = ends_.Add(AReader("rt/wrench", kLatched), 0, 0);
  Client client(hub_, 0);
  client.Announce(1, AWriter("rt/wrench", kLatched), 1);
  client.Write(1, "older", {shm::kDdsCoordinator}, 10,
               {.stamp_ns = 5, .addressee = ends_.GuidOf(recorder)});
  EXPECT_THAT(TakeFor(command, 10), IsEmpty());
  client.Write(1, "older", {shm::kDdsCoordinator}, 20,
               {.stamp_ns = 5, .addressee = ends_.GuidOf(recorder)});
  EXPECT_THAT(TakeFor(recorder, 20), ElementsAre("older"));
}

}  // namespace
}  // namespace tcs::dds
