// What is counted of what goes through the hub.
#include "coordinator/dds/topic_log.h"

#include <gmock/gmock.h>

#include "coordinator/dds/own_endpoints.h"
#include "tests/unit/dds/client.h"

namespace tcs::dds {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

struct Heard : TopicLog::Listener {
  void Opened(TopicLog::Topic topic, int domain, const Endpoint& endpoint) override {
    opened.emplace_back(topic, domain);
    kinds.push_back(endpoint.kind);
  }
  void Written(TopicLog::Topic, std::int64_t at_ns, std::span<const std::byte> cdr) override {
    written.emplace_back(at_ns, std::string(reinterpret_cast<const char*>(cdr.data()), cdr.size()));
  }
  std::vector<std::pair<TopicLog::Topic, int>> opened;
  std::vector<EndpointKind> kinds;
  std::vector<std::pair<std::int64_t, std::string>> written;
};

class TopicLogTest : public testing::Test {
 protected:
  TopicLogTest() {
    log_.Tell(&heard_);
    hub_.Observe(&log_);
  }

  Hub hub_;
  TopicLog log_{[](Hub::Number number) {
    return number == 0 ? Speaker{"tcsim", ""} : Speaker{"r/" + std::to_string(number), "r"};
  }};
  Heard heard_;
};

TEST_F(TopicLogTest, ASampleCountsOnceForHoweverManyItIs) {
  Client writer(hub_, 0), one(hub_, 0), other(hub_, 0);
  writer.Announce(1, AWriter("rt/odom"), 5);
  const std::vector<Hub::Number> both = {one.number(), other.number()};
  writer.Write(1, "abcd", both, 100, {.stamp_ns = 90});
  writer.Write(1, "abcd", both, 350, {.stamp_ns = 340});
  // Written twice with the same stamp, by a program that sets it itself.
  writer.Write(1, "efg!", both, 600, {.stamp_ns = 590});
  writer.Write(1, "efg!", both, 600, {.stamp_ns = 590});
  ASSERT_THAT(log_.reports(), SizeIs(1));
  const TopicReport& report = log_.reports()[0];
  EXPECT_EQ(report.topic, "/odom");
  EXPECT_EQ(report.type, "std_msgs/msg/Header");
  EXPECT_EQ(report.samples, 4);
  EXPECT_EQ(report.bytes, 16);
  EXPECT_EQ(report.first_ns, 100);
  EXPECT_EQ(report.last_ns, 600);
  EXPECT_DOUBLE_EQ(report.RateHz(), 3 / 500e-9);
  EXPECT_THAT(heard_.written, ElementsAre(Pair(100, "abcd"), Pair(350, "abcd"), Pair(600, "efg!"),
                                          Pair(600, "efg!")));
}

TEST_F(TopicLogTest, ADeliveryIsToldWhenAProcessIsGivenTheSample) {
  struct Deliveries : TopicLog::DeliveryListener {
    void Delivered(const TopicLog::Delivery& d) override {
      told.push_back({static_cast<std::int64_t>(d.topic), d.from, d.to, d.sent_ns,
                      d.source_timestamp_ns, d.received_ns});
    }
    std::vector<std::vector<std::int64_t>> told;
  } deliveries;
  log_.TellDeliveries(&deliveries);
  OwnEndpoints ends(hub_);
  ends.Add(AReader("rt/cmd"), 0, 0);
  Client writer(hub_, 0), reader(hub_, 0);
  const std::int64_t from = writer.number(), to = reader.number();
  writer.Announce(1, AWriter("rt/odom"), 5);
  writer.Announce(2, AWriter("rt/cmd"), 5);
  writer.Write(1, "abcd", {reader.number()}, 100, {.stamp_ns = 90});
  writer.Write(2, "efgh", {shm::kDdsCoordinator}, 300, {.stamp_ns = 290});
  EXPECT_THAT(deliveries.told, IsEmpty()) << "nobody has taken anything";
  reader.Take(shm::DdsKind::kSample, 250);
  while (ends.Take(400).has_value()) {
  }
  const auto topic = [this](const char* name) {
    std::int64_t number = 0;
    while (log_.reports()[static_cast<std::size_t>(number)].topic != name) ++number;
    return number;
  };
  EXPECT_THAT(deliveries.told, ElementsAre(ElementsAre(topic("/odom"), from, to, 100, 90, 250),
                                           ElementsAre(topic("/cmd"), from, 0, 300, 290, 300)));
  // The end of an instance, and what comes once nobody listens.
  writer.Write(1, "a key", {reader.number()}, 500, {.stamp_ns = 500, .kind = 1});
  reader.Take(shm::DdsKind::kSample, 500);
  log_.TellNobody();
  writer.Write(1, "abcd", {reader.number()}, 600, {.stamp_ns = 600});
  reader.Take(shm::DdsKind::kSample, 600);
  EXPECT_THAT(deliveries.told, SizeIs(2));
}

TEST_F(TopicLogTest, TheEndOfAnInstanceIsNoSample) {
  Client writer(hub_, 0), reader(hub_, 0);
  writer.Announce(1, AWriter("rt/odom"), 5);
  writer.Write(1, "a key", {reader.number()}, 100, {.stamp_ns = 100, .kind = 1});
  EXPECT_EQ(log_.reports()[0].samples, 0);
  EXPECT_THAT(heard_.written, IsEmpty());
}

TEST_F(TopicLogTest, WhatLateReadersAreToldAgainDoesNotCount) {
  OwnEndpoints ends(hub_);
  const auto map = ends.Add(AWriter("rt/map", kLatched), 0, 0);
  ends.Write(map, BytesOf("one"), 1'010, 10);
  Client late(hub_, 0);
  late.Announce(1, AReader("rt/map", kLatched), 50);
  EXPECT_FALSE(ends.Take(50).has_value());
  EXPECT_THAT(late.Take(shm::DdsKind::kSample, 50), SizeIs(1)) << "it has been told";
  ends.Write(map, BytesOf("two"), 1'060, 60);
  EXPECT_EQ(log_.reports()[0].samples, 2);
  EXPECT_THAT(heard_.written, ElementsAre(Pair(10, "one"), Pair(60, "two")));
}

// A recorder's reader is late by no fault of the writer's: what was written before it has not been
// counted yet.
TEST_F(TopicLogTest, WhatNobodyWasThereForCountsWhenTheCoordinatorHearsOfIt) {
  Client writer(hub_, 0), reader(hub_, 0);
  writer.Announce(1, AWriter("rt/map", kLatched), 5);
  const Guid ours{1}, theirs{2};
  const std::vector<Hub::Number> us = {shm::kDdsCoordinator}, them = {reader.number()};
  writer.Write(1, "first", them, 10, {.stamp_ns = 3, .addressee = theirs});
  EXPECT_EQ(log_.reports()[0].samples, 0) << "it is the coordinator's that counts";
  writer.Write(1, "first", us, 11, {.stamp_ns = 3, .addressee = ours});
  writer.Write(1, "second", us, 11, {.stamp_ns = 4, .addressee = ours});
  writer.Write(1, "second", us, 20, {.stamp_ns = 4, .addressee = ours});
  EXPECT_THAT(heard_.written, ElementsAre(Pair(11, "first"), Pair(11, "second")));
}

TEST_F(TopicLogTest, TopicsAreApartByTypeAndDomainAndKeepTheirEnds) {
  Client client(hub_, 0);
  Qos careful;
  careful.depth = 3;
  client.Announce(1, AWriter("rt/odom"), 5);
  client.Announce(2, AReader("rt/odom", careful), 6);
  client.Announce(2, AReader("rt/odom", kCareless), 7);  // another QoS, the same reader
  client.Announce(3, AWriter("rt/odom"), 8, 7);
  Endpoint foreign = AWriter("DDSPerfRDataKS");
  foreign.type = "KeyedSeq";
  client.Announce(4, foreign, 9);
  client.End(1, 10);
  ASSERT_THAT(log_.reports(), SizeIs(3));
  const TopicReport& odom = log_.reports()[0];
  ASSERT_THAT(odom.endpoints, SizeIs(2)) << "those that there ever were, each once";
  EXPECT_EQ(odom.endpoints[0].kind, EndpointKind::kWriter);
  EXPECT_EQ(odom.endpoints[0].process, "r/1");
  EXPECT_EQ(odom.endpoints[1].qos, careful);
  EXPECT_EQ(log_.reports()[1].domain, 7);
  EXPECT_EQ(log_.reports()[2].topic, "DDSPerfRDataKS");
  EXPECT_EQ(log_.reports()[2].type, "KeyedSeq");
  EXPECT_THAT(heard_.opened, ElementsAre(Pair(0, 0), Pair(0, 0), Pair(1, 7), Pair(2, 0)));
}

TEST_F(TopicLogTest, SamplesOfWritersThatWereNeverAnnouncedAreNobodys) {
  Client client(hub_, 0), reader(hub_, 0);
  client.Write(9, "abcd", {reader.number()}, 100, {.stamp_ns = 100});
  EXPECT_THAT(log_.reports(), IsEmpty());
}

TEST_F(TopicLogTest, DropsCountOnceForEachReaderThatMissesASample) {
  Client writer(hub_, 0);
  writer.Announce(1, AWriter("rt/image"), 5);
  writer.Announce(2, AWriter("rt/scan"), 5);
  shm::DdsMessage sample{};
  const Guid guid = writer.GuidOf(2);
  PutGuid(guid, sample.subject);
  log_.Dropped(sample, 7);
  log_.Dropped(sample, 8);
  EXPECT_EQ(log_.reports()[0].drops, 0);
  EXPECT_EQ(log_.reports()[1].drops, 2);
}

}  // namespace
}  // namespace tcs::dds
