// Programs that err, in all that looks at what they send: the hub, the log of topics, the
// coordinator's own endpoints and the recording. Nothing of theirs crashes any of these, and what
// others get is well-formed. Most is found by the sanitizers (the preset asan).
#include <gmock/gmock.h>
#include <stdlib.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <random>
#include <set>
#include <thread>

#include "coordinator/dds/well_formed.h"
#include "coordinator/record/recording.h"
#include "tests/unit/dds/client.h"

namespace tcs::record {
namespace {

using dds::Hub;
using shm::DdsKind;
using shm::DdsMessage;

// A program that writes into its outbox whatever the dice say.
class Program {
 public:
  Program(Hub& hub, std::int64_t now_ns) : hub_(hub), number_(hub.Join(now_ns)) {
    area_ = static_cast<char*>(mmap(nullptr, shm::kDdsAreaSize, PROT_READ | PROT_WRITE, MAP_SHARED,
                                    hub.AreaOf(number_), 0));
  }
  ~Program() { munmap(area_, shm::kDdsAreaSize); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  Hub::Number number() const { return number_; }
  char* outbox() const { return area_ + shm::kDdsHeaderSize; }

  // How many messages there were, each of which had to be as everybody relies on.
  int Take(std::int64_t now_ns) {
    const std::size_t size = hub_.Deliver(number_, now_ns);
    const auto* at = reinterpret_cast<const std::byte*>(outbox() + shm::kDdsBoxSize);
    std::span<const std::byte> left(at, size);
    int count = 0;
    for (; !left.empty(); ++count) {
      EXPECT_GE(left.size(), sizeof(DdsMessage));
      const DdsMessage header = dds::HeaderOf(left);
      EXPECT_FALSE(dds::WhatIsWrongWithSize(header, left.size()).has_value());
      const auto message = left.first(header.size);
      EXPECT_EQ(dds::WhatIsWrong(header, dds::PayloadOf(message)), std::nullopt);
      EXPECT_LE(header.from, hub_.count());
      EXPECT_LE(header.time_ns, now_ns);
      if (testing::Test::HasFailure()) return count;
      left = left.subspan(header.size);
    }
    hub_.CameBack(number_);
    return count;
  }

 private:
  Hub& hub_;
  Hub::Number number_;
  char* area_;
};

class HostileMessagesTest : public testing::Test {
 protected:
  HostileMessagesTest() {
    std::string name = (std::filesystem::temp_directory_path() / "tcs_hostile_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    hub_.Observe(&log_);
    log_.Tell(&recording_);
    EXPECT_EQ(recording_.Open(folder_ + "/bag"), "");
  }
  ~HostileMessagesTest() override { std::filesystem::remove_all(folder_); }

  unsigned Dice(unsigned sides) { return static_cast<unsigned>(random_() % sides); }

  // What a program of that number may well say, with GUIDs of a few others among them.
  std::vector<std::byte> Sensible(Hub::Number from) {
    DdsMessage header{};
    header.kind = static_cast<DdsKind>(1 + Dice(5));
    header.flags = Dice(6) == 0 ? static_cast<std::uint16_t>(Dice(8)) : std::uint16_t{0};
    header.to = Dice(3) == 0 ? Dice(4) : shm::kDdsEverybody;
    header.subject[3] = static_cast<std::uint8_t>(Dice(8) == 0 ? Dice(5) : from);
    header.subject[15] = static_cast<std::uint8_t>(Dice(4));
    header.other[3] = Dice(4) == 0 ? 0 : header.subject[3];
    header.sample_kind = Dice(5) == 0 ? Dice(4) : shm::kDdsData;
    header.keep_last = Dice(3);
    header.instance = Dice(3);
    header.lease_ns = Dice(3) == 0 ? static_cast<std::int64_t>(Dice(2000)) : INT64_MAX;
    header.source_timestamp_ns = Dice(50);
    std::vector<std::byte> payload(Dice(40));
    if (header.kind == DdsKind::kParticipant) payload = dds::EncodeParticipant("a", "b");
    if (header.kind == DdsKind::kEndpoint) {
      payload = dds::EncodeEndpoint(
          dds::AnEnd(Dice(2) == 0 ? dds::EndpointKind::kWriter : dds::EndpointKind::kReader,
                     "rt/t" + std::to_string(Dice(5)), Dice(2) == 0 ? dds::kLatched : dds::Qos{}));
    }
    if (header.kind == DdsKind::kSample && Dice(50) == 0) payload.resize(600'000);
    header.payload_size = static_cast<std::uint32_t>(payload.size());
    header.size = shm::DdsMessageSize(header.payload_size);
    std::vector<std::byte> bytes(header.size);
    dds::PutHeader(header, bytes);
    std::copy(payload.begin(), payload.end(), bytes.begin() + sizeof header);
    return bytes;
  }

  // A few bytes of it otherwise, mostly of its header and of an endpoint's numbers.
  void Spoil(std::vector<std::byte>& bytes) {
    for (unsigned i = Dice(4); i > 0; --i) {
      const std::size_t reach =
          Dice(3) == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 200);
      constexpr unsigned kValues[] = {0, 1, 0x7f, 0x80, 0xff};
      bytes[Dice(static_cast<unsigned>(reach))] =
          static_cast<std::byte>(Dice(2) == 0 ? kValues[Dice(5)] : Dice(256));
    }
  }

  std::string SendSomething(const Program& program, std::int64_t now_ns) {
    std::size_t size = 0;
    for (unsigned i = Dice(4); i > 0; --i) {
      std::vector<std::byte> bytes = Sensible(program.number());
      if (Dice(3) == 0) Spoil(bytes);
      memcpy(program.outbox() + size, bytes.data(), bytes.size());
      size += bytes.size();
    }
    if (Dice(20) == 0) size = Dice(10) == 0 ? shm::kDdsBoxSize + Dice(9) : Dice(400);
    return hub_.Send(program.number(), size, now_ns);
  }

  void Look(std::int64_t now_ns) {
    recording_.ReadNewTopics(now_ns);
    while (ends_.Take(now_ns).has_value()) {
    }
  }

  std::mt19937 random_{20261121};
  std::string folder_;
  Hub hub_;
  dds::OwnEndpoints ends_{hub_};
  dds::TopicLog log_{[](Hub::Number number) { return dds::Speaker{std::to_string(number), "r"}; }};
  Recording recording_{log_, ends_, 0, dds::RosRelease::kIron};
};

TEST_F(HostileMessagesTest, WhatIsAcceptedIsWellFormed) {
  const auto map = ends_.Add(dds::AWriter("rt/t0", dds::kLatched), 0, 0);
  ends_.Add(dds::AReader("rt/t1"), 0, 0);
  std::vector<std::unique_ptr<Program>> programs;
  int refused = 0, taken = 0;
  for (std::int64_t now = 0; now < 6'000; ++now) {
    if (programs.size() < 4) programs.push_back(std::make_unique<Program>(hub_, now));
    Program& one = *programs[Dice(static_cast<unsigned>(programs.size()))];
    refused += !SendSomething(one, now).empty();
    Look(now);
    if (Dice(10) == 0) ends_.Write(map, dds::BytesOf("a map"), now, now + Dice(20));
    if (Dice(3) == 0) taken += one.Take(now);
    if (Dice(100) == 0) hub_.Stop(one.number(), now);
    if (Dice(50) == 0) hub_.Continue(one.number(), now);
    if (Dice(150) != 0) continue;
    hub_.Leave(one.number(), now);
    std::erase_if(programs, [&one](const auto& program) { return program.get() == &one; });
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(taken, 5'000);
  for (const auto& program : programs) program->Take(10'000);
  EXPECT_EQ(recording_.Close(), "");
  EXPECT_EQ(dds::WriteTopics(log_.reports(), folder_ + "/topics.json"), "");
  const auto read = dds::ReadTopics(folder_);
  ASSERT_TRUE(std::holds_alternative<std::vector<dds::TopicReport>>(read));
  EXPECT_EQ(std::get<0>(read).size(), log_.reports().size());
  const YAML::Node bag =
      YAML::LoadFile(folder_ + "/bag/metadata.yaml")["rosbag2_bagfile_information"];
  std::set<std::pair<std::string, std::string>> topics;  // bags know no domains
  std::int64_t samples = 0;
  for (const dds::TopicReport& topic : log_.reports()) {
    topics.emplace(topic.topic, topic.type);
    samples += topic.samples;
  }
  EXPECT_EQ(bag["topics_with_message_count"].size(), topics.size());
  EXPECT_EQ(bag["message_count"].as<std::int64_t>(), samples);
  EXPECT_GT(samples, 500);
}

// It is copied, then checked, and then nobody looks into the outbox any more.
TEST_F(HostileMessagesTest, SizesThatChangeWhileTheyAreReadDoNoHarm) {
  Program program(hub_, 0), other(hub_, 0);
  std::atomic<bool> done = false;
  DdsMessage header{};
  header.kind = DdsKind::kSample;
  header.to = other.number();
  header.payload_size = 64;
  header.size = shm::DdsMessageSize(64);
  memcpy(program.outbox(), &header, sizeof header);
  std::thread changes([&] {
    auto* const size = reinterpret_cast<volatile std::uint32_t*>(program.outbox());
    auto* const payload_size = reinterpret_cast<volatile std::uint32_t*>(
        program.outbox() + offsetof(DdsMessage, payload_size));
    constexpr std::uint32_t kPayloads[] = {64, 8, 0, 4'000'000, UINT32_MAX, shm::kDdsMostPayload};
    for (std::size_t i = 0; !done; ++i) {
      *payload_size = kPayloads[i % std::size(kPayloads)];
      *size = shm::DdsMessageSize(*payload_size);
    }
  });
  int accepted = 0, refused = 0;
  for (int i = 0; accepted < 1'000 || refused < 1'000; ++i) {
    const bool fits = hub_.Send(program.number(), shm::DdsMessageSize(64), i).empty();
    ++(fits ? accepted : refused);
    if (i % 20 == 0) other.Take(i);
  }
  done = true;
  changes.join();
}

// As of a client that is made for each call.
TEST_F(HostileMessagesTest, EndpointsThatComeAndGoWithoutEndTakeNoMoreRoom) {
  dds::Client client(hub_, 0);
  for (std::int64_t now = 0; now < 3'000; ++now) {
    client.Announce(1, dds::AWriter("rt/call"), now);
    client.Announce(2, dds::AReader("rt/reply"), now);
    Look(now);
    client.End(1, now);
    client.End(2, now);
  }
  ASSERT_THAT(log_.reports(), testing::SizeIs(2));
  const auto& ends = log_.reports()[0].endpoints;
  ASSERT_THAT(ends, testing::SizeIs(2)) << "its own, and the recording's";
  EXPECT_EQ(ends[0].count, 3'000);
  EXPECT_EQ(ends[1].count, 1);
  dds::Client late(hub_, 3'000);
  EXPECT_THAT(late.Take(DdsKind::kEndpoint, 3'000), testing::SizeIs(2)) << "the recording's";
}

TEST_F(HostileMessagesTest, OfEverOtherTopicsTheFirstOnesAreKnown) {
  dds::Client client(hub_, 0);
  const auto most = static_cast<int>(dds::TopicLog::kMostEnds);
  hub_.Observe(&log_);
  log_.Tell(nullptr);
  for (int i = 0; i < most; ++i) {
    EXPECT_TRUE(log_.is_whole());
    client.Announce(1, dds::AWriter("rt/goal" + std::to_string(i)), i);
    client.End(1, i);
  }
  client.Announce(1, dds::AWriter("rt/goal0"), most);
  EXPECT_TRUE(log_.is_whole()) << "that one is known";
  client.Announce(2, dds::AWriter("rt/one_more"), most);
  EXPECT_FALSE(log_.is_whole());
  EXPECT_THAT(log_.reports(), testing::SizeIs(most));
  EXPECT_EQ(log_.reports()[0].endpoints[0].count, 2);
}

}  // namespace
}  // namespace tcs::record
