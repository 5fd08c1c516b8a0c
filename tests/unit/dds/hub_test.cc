// The hub as processes see it: two mappings of one area, like theirs.
#include "coordinator/dds/hub.h"

#include <errno.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "shm/dds_endpoint.h"

namespace tcs::dds {
namespace {

using shm::DdsKind;
using shm::DdsMessage;
using Number = Hub::Number;

// A process's side: its area mapped once more.
class Peer {
 public:
  Peer(Hub& hub, std::int64_t now_ns) : hub_(hub), number_(hub.Join(now_ns)) {
    void* at = mmap(nullptr, shm::kDdsAreaSize, PROT_READ | PROT_WRITE, MAP_SHARED,
                    hub.AreaOf(number_), 0);
    area_ = static_cast<char*>(at);
  }
  ~Peer() { munmap(area_, shm::kDdsAreaSize); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  Number number() const { return number_; }
  const shm::DdsArea& shown() const { return *reinterpret_cast<shm::DdsArea*>(area_); }
  char* outbox() { return area_ + shm::kDdsHeaderSize; }

  std::string Send(std::int64_t now_ns, const std::vector<DdsMessage>& messages) {
    std::size_t size = 0;
    for (const DdsMessage& message : messages) {
      memcpy(outbox() + size, &message, sizeof message);
      memset(outbox() + size + sizeof message, 0, std::min(message.payload_size, 256u));
      if (message.kind == DdsKind::kEndpoint) {
        const shm::DdsEndpoint endpoint{.kind = shm::kDdsWriter};
        memcpy(outbox() + size + sizeof message, &endpoint, sizeof endpoint);
      }
      size += message.size;
    }
    return hub_.Send(number_, size, now_ns);
  }

  std::vector<DdsMessage> Take(std::int64_t now_ns) {
    const std::size_t size = hub_.Deliver(number_, now_ns);
    hub_.CameBack(number_);
    const char* at = area_ + shm::kDdsHeaderSize + shm::kDdsBoxSize;
    const char* const end = at + size;
    std::vector<DdsMessage> messages;
    while (at != end) {
      DdsMessage message;
      memcpy(&message, at, sizeof message);
      messages.push_back(message);
      at += message.size;
    }
    return messages;
  }

 private:
  Hub& hub_;
  Number number_;
  char* area_;
};

// The least that a message of that kind has: an endpoint's policies, a sample's encapsulation.
std::uint32_t PayloadSizeOf(DdsKind kind) {
  switch (kind) {
    case DdsKind::kParticipant:
      return sizeof(shm::DdsQos);
    case DdsKind::kEndpoint:
      return sizeof(shm::DdsEndpoint);
    case DdsKind::kSample:
      return 4;
    default:
      return 0;
  }
}

// The same with a payload of so many bytes.
DdsMessage Sized(DdsMessage message, std::size_t payload_size) {
  message.payload_size = static_cast<std::uint32_t>(payload_size);
  message.size = shm::DdsMessageSize(message.payload_size);
  return message;
}

DdsMessage Message(DdsKind kind, std::uint8_t subject, std::uint32_t to = shm::kDdsEverybody) {
  DdsMessage message = Sized({}, PayloadSizeOf(kind));
  message.kind = kind;
  message.to = to;
  message.subject[0] = subject;
  message.lease_ns = INT64_MAX;
  return message;
}

TEST(DdsHub, DeliversAtTheTimeOfSendingAndNotBefore) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  EXPECT_EQ(a.Send(700, {Message(DdsKind::kSample, 1)}), "");
  EXPECT_EQ(hub.DueNs(b.number()), 700);
  EXPECT_EQ(b.shown().due_ns, 700);
  EXPECT_TRUE(b.Take(699).empty());
  const auto taken = b.Take(700);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].time_ns, 700);
  EXPECT_EQ(taken[0].from, a.number());
  EXPECT_EQ(b.shown().due_ns, shm::kNeverNs);
  EXPECT_EQ(hub.DueNs(a.number()), shm::kNeverNs) << "what one sends does not come back";
}

TEST(DdsHub, KeepsTheOrderOfTimesWhoeverSpeaksFirst) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0), reader(hub, 0);
  EXPECT_EQ(a.Send(900, {Message(DdsKind::kSample, 1), Message(DdsKind::kSample, 2)}), "");
  EXPECT_EQ(b.Send(800, {Message(DdsKind::kSample, 3)}), "");
  EXPECT_EQ(b.Send(900, {Message(DdsKind::kSample, 4)}), "");
  std::vector<int> order;
  for (const DdsMessage& message : reader.Take(1000)) order.push_back(message.subject[0]);
  EXPECT_EQ(order, (std::vector<int>{3, 1, 2, 4}));
}

TEST(DdsHub, AddressedMessagesAreForOneOnly) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0), c(hub, 0);
  EXPECT_EQ(a.Send(1, {Message(DdsKind::kSample, 1, c.number())}), "");
  EXPECT_TRUE(b.Take(1).empty());
  EXPECT_EQ(c.Take(1).size(), 1u);
}

TEST(DdsHub, WhoMeetsItselfIsToldOfWhatItSays) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage message = Message(DdsKind::kLiveliness, 1);
  message.flags = shm::kDdsToSender;
  EXPECT_EQ(a.Send(5, {message, Message(DdsKind::kLiveliness, 2)}), "");
  EXPECT_EQ(a.Take(5).size(), 1u);
  EXPECT_EQ(b.Take(5).size(), 2u);
}

TEST(DdsHub, WhoJoinsLaterIsToldOfWhatIsThere) {
  Hub hub;
  Peer a(hub, 0);
  DdsMessage writer = Message(DdsKind::kEndpoint, 2);
  writer.other[0] = 1;
  DdsMessage reader = Message(DdsKind::kEndpoint, 3);
  reader.other[0] = 1;
  EXPECT_EQ(a.Send(5, {Message(DdsKind::kParticipant, 1), writer, reader}), "");
  reader.flags = shm::kDdsGone;
  EXPECT_EQ(a.Send(6, {reader, Message(DdsKind::kSample, 2)}), "");
  Peer late(hub, 10);
  const auto told = late.Take(10);
  ASSERT_EQ(told.size(), 2u) << "participant and writer: no reader, no samples";
  EXPECT_EQ(told[0].kind, DdsKind::kParticipant);
  EXPECT_EQ(told[1].subject[0], 2);
}

TEST(DdsHub, AParticipantThatEndsTakesItsEndpointsAlong) {
  Hub hub;
  Peer a(hub, 0);
  DdsMessage writer = Message(DdsKind::kEndpoint, 2);
  writer.other[0] = 1;
  DdsMessage gone = Message(DdsKind::kParticipant, 1);
  gone.flags = shm::kDdsGone;
  EXPECT_EQ(a.Send(5, {Message(DdsKind::kParticipant, 1), writer, gone}), "");
  Peer late(hub, 10);
  EXPECT_TRUE(late.Take(10).empty());
}

TEST(DdsHub, TheDeadAreMissedWhenTheirLeasesAreOver) {
  Hub hub;
  Peer b(hub, 0);
  {
    Peer a(hub, 0);
    DdsMessage participant = Message(DdsKind::kParticipant, 1);
    participant.lease_ns = 10'000;
    DdsMessage leased = Message(DdsKind::kEndpoint, 2);
    leased.other[0] = 1;
    leased.flags = shm::kDdsLeased;
    leased.lease_ns = 300;
    DdsMessage other = Message(DdsKind::kEndpoint, 3);
    other.other[0] = 1;
    EXPECT_EQ(a.Send(5, {participant, leased, other}), "");
    EXPECT_EQ(b.Take(5).size(), 3u);
    hub.Leave(a.number(), 1'000);
  }
  Peer late(hub, 1'001);
  EXPECT_EQ(hub.DueNs(late.number()), shm::kNeverNs) << "whoever comes now never saw it";
  EXPECT_TRUE(b.Take(1'299).empty());
  const auto lost = b.Take(1'300);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost[0].kind, DdsKind::kLiveliness);
  EXPECT_EQ(lost[0].flags, shm::kDdsGone);
  EXPECT_EQ(lost[0].subject[0], 2);
  const auto gone = b.Take(11'000);
  ASSERT_EQ(gone.size(), 1u);
  EXPECT_EQ(gone[0].kind, DdsKind::kParticipant);
  EXPECT_EQ(gone[0].time_ns, 11'000);
}

using testing::HasSubstr;

TEST(DdsHub, SaysWhatIsWrongWithAMessageAndKeepsThoseBefore) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage wrong = Message(DdsKind::kSample, 2);
  wrong.kind = static_cast<DdsKind>(77);
  EXPECT_THAT(a.Send(1, {Message(DdsKind::kSample, 1), wrong}),
              HasSubstr("an unknown kind, 77: it"));
  EXPECT_EQ(b.Take(1).size(), 1u);
  wrong = Message(DdsKind::kSample, 2);
  wrong.payload_size = 4000;
  EXPECT_THAT(a.Send(1, {wrong}), HasSubstr("of a wrong size, 112: it"));
  wrong.payload_size = UINT32_MAX - 3;
  EXPECT_THAT(a.Send(1, {wrong}), HasSubstr("of a wrong size, 112: it"));
  memset(a.outbox(), 0xff, 200);
  EXPECT_THAT(hub.Send(a.number(), 200, 1), HasSubstr("of a wrong size, 4294967295: it"));
  EXPECT_THAT(hub.Send(a.number(), 8, 1), HasSubstr("of a wrong size, 0: it"));
  EXPECT_THAT(hub.Send(a.number(), shm::kDdsBoxSize + 8, 1), HasSubstr("than there is room for"));
  EXPECT_THAT(hub.Send(99, 0, 1), HasSubstr("in a child that it has forked"));
  EXPECT_EQ(hub.DueNs(b.number()), shm::kNeverNs);
}

TEST(DdsHub, TakesNoSampleThatIsTooShortToBeCdr) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage sample = Message(DdsKind::kSample, 1);
  sample.payload_size = 3;
  EXPECT_THAT(a.Send(1, {sample}), HasSubstr("a sample of 3 bytes, too few for any CDR"));
  EXPECT_EQ(hub.DueNs(b.number()), shm::kNeverNs);
}

TEST(DdsHub, TakesNoNewsWhoseTextsLieOutsideIt) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  const auto send = [&](DdsKind kind, const auto& payload) {
    DdsMessage message = Message(kind, 1);
    memcpy(a.outbox(), &message, sizeof message);
    memcpy(a.outbox() + sizeof message, &payload, sizeof payload);
    return hub.Send(a.number(), message.size, 1);
  };
  shm::DdsQos qos{};
  qos.user_data = {sizeof qos, 1};
  EXPECT_EQ(send(DdsKind::kParticipant, qos), "") << "the policy is not there";
  qos.present = shm::kDdsUserData;
  EXPECT_THAT(send(DdsKind::kParticipant, qos), HasSubstr("a participant that cannot be read"));
  EXPECT_THAT(send(DdsKind::kEndpoint, shm::DdsEndpoint{.kind = 3}),
              HasSubstr("an endpoint that cannot be read"));
  EXPECT_THAT(
      send(DdsKind::kEndpoint, shm::DdsEndpoint{.kind = shm::kDdsReader, .topic = {8, 999}}),
      HasSubstr("an endpoint that cannot be read"));
  EXPECT_THAT(send(DdsKind::kEndpoint, shm::DdsEndpoint{.kind = shm::kDdsReader, .qos = qos}), "")
      << "one byte beyond the policies is inside an endpoint";
  qos.partition = {UINT32_MAX, UINT32_MAX};
  qos.present = shm::kDdsPartition;
  EXPECT_THAT(send(DdsKind::kEndpoint, shm::DdsEndpoint{.kind = shm::kDdsReader, .qos = qos}),
              HasSubstr("an endpoint that cannot be read"));
  EXPECT_EQ(b.Take(1).size(), 2u);
}

TEST(DdsHub, NobodySpeaksForAnothersParticipant) {
  Hub hub;
  hub.TellOwn();
  Peer a(hub, 0), b(hub, 0), c(hub, 0);
  EXPECT_EQ(a.Send(1, {Message(DdsKind::kParticipant, 1)}), "");
  DdsMessage gone = Message(DdsKind::kParticipant, 1);
  gone.flags = shm::kDdsGone;
  const DdsMessage sample = Message(DdsKind::kSample, 1);
  DdsMessage endpoint = Message(DdsKind::kEndpoint, 2);
  endpoint.other[0] = 1;
  for (const DdsMessage& lie : {gone, sample, endpoint}) {
    EXPECT_THAT(b.Send(2, {lie}), HasSubstr("of another program"));
  }
  EXPECT_EQ(c.Take(9).size(), 1u);
  EXPECT_EQ(a.Send(3, {endpoint, sample, gone}), "");
  EXPECT_EQ(b.Send(4, {Message(DdsKind::kParticipant, 1)}), "") << "nobody's any more";
  hub.Leave(b.number(), 5);
  EXPECT_EQ(a.Send(6, {Message(DdsKind::kParticipant, 1)}), "") << "the dead speak no more";
}

TEST(DdsHub, NobodyIsSentToWhoNeverWas) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  hub.Leave(b.number(), 1);
  EXPECT_EQ(a.Send(2, {Message(DdsKind::kSample, 1, b.number())}), "") << "it has been there";
  EXPECT_THAT(a.Send(2, {Message(DdsKind::kSample, 1, b.number() + 1)}),
              HasSubstr("to a process that does not exist, 3"));
}

TEST(DdsHub, AnAreaCannotBeCutOff) {
  Hub hub;
  Peer a(hub, 0);
  EXPECT_EQ(ftruncate(hub.AreaOf(a.number()), 0), -1);
  EXPECT_EQ(errno, EPERM);
  EXPECT_EQ(fcntl(hub.AreaOf(a.number()), F_ADD_SEALS, F_SEAL_WRITE), -1);
}

TEST(DdsHub, EachProcessHasAFileOfItsOwn) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  EXPECT_EQ(hub.AreaOf(0), -1);
  EXPECT_EQ(hub.AreaOf(b.number() + 1), -1);
  struct stat of_a {
  }, of_b{};
  ASSERT_EQ(fstat(hub.AreaOf(a.number()), &of_a), 0);
  ASSERT_EQ(fstat(hub.AreaOf(b.number()), &of_b), 0);
  EXPECT_NE(of_a.st_ino, of_b.st_ino);
  EXPECT_EQ(of_a.st_size, static_cast<off_t>(shm::kDdsAreaSize));
  hub.Leave(a.number(), 1);
  EXPECT_EQ(hub.AreaOf(a.number()), -1);
}

TEST(DdsHub, WhatOneProcessSaysOfItsEndpointsHasALimit) {
  Hub hub;
  Peer a(hub, 0), other(hub, 0);
  DdsMessage endpoint = Sized(Message(DdsKind::kEndpoint, 2), 1 << 20);
  std::uint8_t made = 0;
  std::string refused;
  for (; made < 200 && refused.empty(); ++made) {
    endpoint.subject[1] = made;
    refused = a.Send(made, {endpoint});
  }
  EXPECT_EQ(made, 16);
  EXPECT_THAT(refused, HasSubstr("take 16 MiB: other programs are not told of further ones"));
  endpoint.subject[1] = 0;
  EXPECT_EQ(a.Send(200, {endpoint}), "") << "another QoS of one that is known";
  endpoint.flags = shm::kDdsGone;
  EXPECT_EQ(a.Send(201, {endpoint}), "");
  endpoint.flags = 0;
  EXPECT_EQ(a.Send(202, {endpoint}), "") << "one for one";
  EXPECT_EQ(other.Send(203, {endpoint}), "") << "each has its own";
  endpoint = Sized(endpoint, endpoint.payload_size + 1);
  EXPECT_THAT(other.Send(204, {endpoint}), HasSubstr("1048577 bytes, more than 1 MiB"));
}

TEST(DdsHub, FillsAnInboxAsFarAsItReaches) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage large = Sized(Message(DdsKind::kSample, 1), shm::kDdsUsualSize / 3);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(a.Send(i, {large}), "");
  EXPECT_EQ(b.Take(10).size(), 2u);
  EXPECT_EQ(hub.DueNs(b.number()), 2) << "the rest is due still";
  EXPECT_EQ(b.Take(10).size(), 2u);
}

TEST(DdsHub, ALargeSampleComesAloneAndItsMemoryIsGivenBack) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  const auto held = [&] {
    std::size_t bytes = 0;
    for (const Peer* peer : {&a, &b}) {
      struct stat status {};
      fstat(hub.AreaOf(peer->number()), &status);
      bytes += static_cast<std::size_t>(status.st_blocks) * 512;
    }
    return bytes;
  };
  DdsMessage large = Sized(Message(DdsKind::kSample, 1), shm::kDdsUsualSize * 3);
  EXPECT_EQ(a.Send(1, {Message(DdsKind::kSample, 1)}), "");
  EXPECT_EQ(a.Send(2, {large}), "");
  EXPECT_EQ(b.Take(10).size(), 1u);
  EXPECT_EQ(hub.Deliver(b.number(), 10), large.size);
  EXPECT_GT(held(), shm::kDdsUsualSize * 3);
  hub.CameBack(b.number());
  EXPECT_LT(held(), shm::kDdsUsualSize * 3);
}

TEST(DdsHub, SamplesForWhoDoesNotTakeThemAreDroppedAndCounted) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage large =
      Sized(Message(DdsKind::kSample, 1), shm::kDdsUsualSize - sizeof(DdsMessage) - 8);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(a.Send(i, {large}), "");
  EXPECT_EQ(hub.drops().lost, 4u);
  EXPECT_EQ(a.Send(20, {Message(DdsKind::kParticipant, 2)}), "");
  EXPECT_EQ(hub.drops().lost, 4u) << "who is there is not dropped";
}

TEST(DdsHub, NewsForWhoDoesNotTakeThemHaveALimitToo) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage asserted = Sized(Message(DdsKind::kLiveliness, 1), 8 << 20);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(a.Send(i, {asserted}), "");
  EXPECT_EQ(hub.drops().lost, 11u) << "320 MiB wait";
}

TEST(DdsHub, AllSeeWhoIsFull) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0), c(hub, 0);
  const DdsMessage sample = Sized(Message(DdsKind::kSample, 1, b.number()), 600'000);
  EXPECT_EQ(a.Send(1, {sample}), "");
  EXPECT_EQ(a.shown().full_count, 0u);
  EXPECT_EQ(a.Send(2, {sample}), "");
  EXPECT_EQ(a.shown().full_count, 1u);
  EXPECT_TRUE(a.shown().IsFull(b.number()));
  EXPECT_TRUE(hub.IsFull(b.number()));
  EXPECT_FALSE(hub.IsFull(c.number()));
  hub.Deliver(b.number(), 2);
  EXPECT_TRUE(hub.IsFull(b.number())) << "it still has them in its hands";
  hub.CameBack(b.number());
  EXPECT_FALSE(hub.IsFull(b.number()));
  EXPECT_EQ(a.shown().full_count, 0u);
}

DdsMessage Large(std::uint8_t subject, std::uint32_t payload_size) {
  return Sized(Message(DdsKind::kSample, subject), payload_size);
}

std::vector<int> TimesOf(const std::vector<DdsMessage>& messages, std::uint8_t subject) {
  std::vector<int> times;
  for (const DdsMessage& message : messages) {
    if (message.subject[0] == subject) times.push_back(static_cast<int>(message.time_ns));
  }
  return times;
}

TEST(DdsHub, OfWhoKeepsTheLastThoseAreLeftForWhoIsFull) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage sample = Message(DdsKind::kSample, 1);
  sample.keep_last = 2;
  DdsMessage end = sample;
  end.status_info = 1;
  int now = 0;
  for (; now < 5; ++now) {
    sample.instance = static_cast<std::uint64_t>(now % 2);
    EXPECT_EQ(a.Send(now, {sample}), "");
  }
  EXPECT_EQ(a.Send(5, {Large(2, 2'000'000)}), "") << "now it is full";
  EXPECT_EQ(hub.drops().replaced, 0u);
  EXPECT_EQ(a.Send(6, {end}), "");
  sample.instance = 0;
  EXPECT_EQ(a.Send(7, {sample}), "");
  EXPECT_EQ(a.Send(8, {sample}), "");
  EXPECT_EQ(hub.drops().replaced, 3u) << "0, 2 and 4 of instance 0";
  const auto taken = b.Take(10);
  EXPECT_EQ(TimesOf(taken, 1), (std::vector<int>{1, 3, 6, 7, 8}));
  EXPECT_EQ(TimesOf(taken, 2), std::vector<int>{5});
  for (now = 11; now < 15; ++now) EXPECT_EQ(a.Send(now, {sample}), "");
  EXPECT_EQ(b.Take(20).size(), 4u) << "it is not full any more";
}

TEST(DdsHub, WhatIsPromisedToNobodyIsDroppedForWhoIsFull) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage sample = Message(DdsKind::kSample, 1);
  sample.flags = shm::kDdsUnreliable;
  EXPECT_EQ(a.Send(1, {sample, Large(2, 2'000'000), sample, sample}), "");
  EXPECT_EQ(hub.drops().unreliable, 2u);
  EXPECT_EQ(hub.drops().lost, 0u);
  EXPECT_EQ(b.Take(10).size(), 2u);
}

TEST(DdsHub, AStoppedProcessIsMissedUnlessItGoesOnInTime) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  DdsMessage participant = Message(DdsKind::kParticipant, 1);
  participant.lease_ns = 10'000;
  DdsMessage writer = Message(DdsKind::kEndpoint, 2);
  writer.other[0] = 1;
  writer.flags = shm::kDdsLeased;
  writer.lease_ns = 300;
  EXPECT_EQ(a.Send(5, {participant, writer}), "");
  EXPECT_EQ(b.Take(5).size(), 2u);
  hub.Stop(a.number(), 100);
  hub.Continue(a.number(), 399);
  EXPECT_EQ(hub.DueNs(b.number()), shm::kNeverNs);

  hub.Stop(a.number(), 1'000);
  hub.Stop(a.number(), 1'100);
  const auto lost = b.Take(1'300);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost[0].kind, DdsKind::kLiveliness);
  hub.Continue(a.number(), 2'000);
  EXPECT_EQ(hub.DueNs(b.number()), shm::kNeverNs) << "its next sample says that it is alive";

  EXPECT_EQ(b.Send(2'500, {Message(DdsKind::kParticipant, 7)}), "");
  EXPECT_EQ(a.Take(2'500).size(), 1u);
  hub.Stop(a.number(), 3'000);
  EXPECT_EQ(b.Take(13'000).size(), 2u);
  hub.Continue(a.number(), 20'000);
  const auto again = b.Take(100'020'000);
  ASSERT_EQ(again.size(), 3u) << "gone, there, its writer";
  EXPECT_EQ(again[0].flags, shm::kDdsGone);
  EXPECT_EQ(again[1].flags, 0);
  EXPECT_EQ(again[2].subject[0], 2);
  const auto others = a.Take(100'020'000);
  ASSERT_EQ(others.size(), 2u);
  EXPECT_EQ(others[0].flags, shm::kDdsGone);
  EXPECT_EQ(others[1].subject[0], 7);
}

TEST(DdsHub, TheCoordinatorIsOneOfThem) {
  Hub hub;
  hub.TellOwn();
  Peer a(hub, 0);
  EXPECT_EQ(a.Send(400, {Message(DdsKind::kParticipant, 1), Message(DdsKind::kSample, 2, 0)}), "");
  EXPECT_FALSE(hub.TakeOwn(399).has_value());
  ASSERT_TRUE(hub.TakeOwn(400).has_value());
  const auto sample = hub.TakeOwn(400);
  ASSERT_TRUE(sample.has_value());
  DdsMessage header;
  memcpy(&header, sample->data(), sizeof header);
  EXPECT_EQ(header.subject[0], 2);
  EXPECT_FALSE(hub.TakeOwn(400).has_value());

  const std::byte payload[5] = {};
  hub.SendOwn(Message(DdsKind::kEndpoint, 3), payload, 500);
  EXPECT_TRUE(a.Take(499).empty());
  const auto taken = a.Take(500);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].from, 0u);
  EXPECT_EQ(taken[0].payload_size, 5u);
  EXPECT_EQ(Peer(hub, 600).Take(600).size(), 2u)
      << "the participant and the coordinator's endpoint";
  EXPECT_FALSE(hub.TakeOwn(1000).has_value()) << "its own messages are not for it";
}

TEST(DdsHub, WhoeverHandsOverIsDeliveringUntilItComesBack) {
  Hub hub;
  Peer a(hub, 0), b(hub, 0);
  EXPECT_EQ(a.Send(1, {Message(DdsKind::kSample, 1)}), "");
  hub.Deliver(b.number(), 1);
  EXPECT_TRUE(hub.IsDelivering(b.number()));
  EXPECT_EQ(b.shown().delivers, 1u);
  hub.CameBack(b.number());
  EXPECT_FALSE(hub.IsDelivering(b.number()));
  EXPECT_EQ(b.shown().delivers, 0u);
}

}  // namespace
}  // namespace tcs::dds
