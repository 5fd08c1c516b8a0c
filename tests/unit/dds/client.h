// A client's side of the hub for tests: says what its endpoints are, writes, and takes what is for
// it, through a mapping of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/dds/endpoint_code.h"
#include "coordinator/dds/hub.h"
#include "shm/dds_endpoint.h"

namespace tcs::dds {

inline std::vector<std::byte> BytesOf(std::string_view text) {
  const auto* at = reinterpret_cast<const std::byte*>(text.data());
  return {at, at + text.size()};
}

struct Received {
  shm::DdsMessage header;
  std::vector<std::byte> payload;

  Guid subject() const { return GuidAt(header.subject); }
  Guid other() const { return GuidAt(header.other); }
  bool Says(std::string_view text) const { return payload == BytesOf(text); }
};

class Client {
 public:
  Client(Hub& hub, std::int64_t now_ns) : hub_(hub), number_(hub.Join(now_ns)) {
    void* at = mmap(nullptr, shm::kDdsAreaSize, PROT_READ | PROT_WRITE, MAP_SHARED,
                    hub.AreaOf(number_), 0);
    area_ = static_cast<char*>(at);
  }
  ~Client() { munmap(area_, shm::kDdsAreaSize); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  Hub::Number number() const { return number_; }

  // Of this client's participant, or of its endpoint `entity`.
  Guid GuidOf(std::uint8_t entity) const {
    Guid guid{0x01, 0x10, 0x77, static_cast<std::uint8_t>(number_)};
    guid[14] = entity;
    return guid;
  }

  void Announce(std::uint8_t entity, const Endpoint& endpoint, std::int64_t now_ns,
                int domain = 0) {
    auto header = HeaderOf(shm::DdsKind::kEndpoint, entity, domain);
    const Guid participant = GuidOf(0);
    std::copy(participant.begin(), participant.end(), header.other);
    Send(header, EncodeEndpoint(endpoint), now_ns);
  }
  void End(std::uint8_t entity, std::int64_t now_ns) {
    auto header =
        HeaderOf(entity == 0 ? shm::DdsKind::kParticipant : shm::DdsKind::kEndpoint, entity, 0);
    header.flags = shm::kDdsGone;
    Send(header, {}, now_ns);
  }

  struct Sample {
    std::int64_t stamp_ns = 0;
    std::uint32_t kind = shm::kDdsData;
    Guid addressee{};  // one reader
  };
  // What a tap sends of a sample, to each process in turn.
  void Write(std::uint8_t writer, std::string_view text, const std::vector<Hub::Number>& to,
             std::int64_t now_ns, const Sample& sample) {
    for (const Hub::Number process : to) {
      auto header = HeaderOf(shm::DdsKind::kSample, writer, 0);
      header.to = process;
      header.source_timestamp_ns = sample.stamp_ns;
      header.sample_kind = sample.kind;
      std::copy(sample.addressee.begin(), sample.addressee.end(), header.other);
      Send(header, BytesOf(text), now_ns);
    }
  }

  std::vector<Received> Take(std::int64_t now_ns) {
    const std::size_t size = hub_.Deliver(number_, now_ns);
    hub_.CameBack(number_);
    const char* at = area_ + shm::kDdsHeaderSize + shm::kDdsBoxSize;
    std::vector<Received> all;
    for (const char* const end = at + size; at != end; at += all.back().header.size) {
      Received& received = all.emplace_back();
      memcpy(&received.header, at, sizeof received.header);
      const auto* payload = reinterpret_cast<const std::byte*>(at + sizeof received.header);
      received.payload.assign(payload, payload + received.header.payload_size);
    }
    return all;
  }
  std::vector<Received> Take(shm::DdsKind kind, std::int64_t now_ns) {
    std::vector<Received> all = Take(now_ns);
    std::erase_if(all, [kind](const Received& one) { return one.header.kind != kind; });
    return all;
  }

 private:
  shm::DdsMessage HeaderOf(shm::DdsKind kind, std::uint8_t entity, int domain) const {
    shm::DdsMessage header{};
    header.kind = kind;
    header.to = shm::kDdsEverybody;
    header.lease_ns = INT64_MAX;
    header.domain = static_cast<std::uint32_t>(domain);
    const Guid subject = GuidOf(entity);
    std::copy(subject.begin(), subject.end(), header.subject);
    return header;
  }
  void Send(shm::DdsMessage header, const std::vector<std::byte>& payload, std::int64_t now_ns) {
    header.payload_size = static_cast<std::uint32_t>(payload.size());
    header.size = shm::DdsMessageSize(header.payload_size);
    char* outbox = area_ + shm::kDdsHeaderSize;
    memcpy(outbox, &header, sizeof header);
    std::copy(payload.begin(), payload.end(), reinterpret_cast<std::byte*>(outbox) + sizeof header);
    EXPECT_EQ(hub_.Send(number_, header.size, now_ns), "");
  }

  Hub& hub_;
  Hub::Number number_;
  char* area_;
};

inline Endpoint AnEnd(EndpointKind kind, std::string topic, Qos qos = {}) {
  return {.kind = kind,
          .topic = std::move(topic),
          .type = "std_msgs::msg::dds_::Header_",
          .keyless = true,
          .qos = qos};
}
inline Endpoint AWriter(std::string topic, Qos qos = {}) {
  return AnEnd(EndpointKind::kWriter, std::move(topic), qos);
}
inline Endpoint AReader(std::string topic, Qos qos = {}) {
  return AnEnd(EndpointKind::kReader, std::move(topic), qos);
}
inline constexpr Qos kLatched{.durability = Durability::kTransientLocal};
inline constexpr Qos kCareless{.reliability = Reliability::kBestEffort};

}  // namespace tcs::dds
