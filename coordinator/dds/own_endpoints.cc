#include "coordinator/dds/own_endpoints.h"

#include <algorithm>
#include <cstring>

#include "shm/check.h"
#include "shm/dds_endpoint.h"

namespace tcs::dds {

namespace {

using shm::DdsKind;
using shm::DdsMessage;

constexpr std::uint8_t kParticipantNumber = 1;  // the last but one byte of a participant's GUID
// ROS 2's middleware takes participants that say so for its own kind, with nodes.
constexpr const char* kEnclave = "enclave=/;";

std::uint64_t NumberOf(const Guid& writer) {
  std::uint64_t number = 0xcbf29ce484222325u;
  for (const auto byte : writer) number = (number ^ byte) * 0x100000001b3u;
  return number;
}

// From any GUID of a participant's endpoints to the participant's own.
Guid WithParticipantId(Guid guid) {
  guid[12] = guid[13] = 0;
  guid[14] = kParticipantNumber;
  guid[15] = shm::kDdsParticipantId;
  return guid;
}

DdsMessage Announcement(DdsKind kind, const Guid& guid, int domain) {
  DdsMessage header{};
  header.kind = kind;
  header.to = shm::kDdsEverybody;
  PutGuid(guid, header.subject);
  header.lease_ns = INT64_MAX;
  header.domain = static_cast<std::uint32_t>(domain);
  return header;
}

bool WantsHistory(const Endpoint& reader) {
  return reader.kind == EndpointKind::kReader &&
         reader.qos.durability == Durability::kTransientLocal &&
         reader.qos.reliability == Reliability::kReliable;
}

}  // namespace

// Twelve bytes that no client has: Eclipse's vendor number first, as all of Cyclone's.
Guid OwnEndpoints::ParticipantOf(int domain, std::int64_t now_ns) {
  Guid guid{0x01, 0x10, 't', 'c', 's', 0};
  for (std::size_t i = 0; i < 4; ++i) {
    guid[8 + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(domain) >> (24 - 8 * i));
  }
  guid = WithParticipantId(guid);
  if (domains_.insert(domain).second) {
    hub_.SendOwn(Announcement(DdsKind::kParticipant, guid, domain),
                 EncodeParticipant("tcsim", kEnclave), now_ns);
  }
  return guid;
}

Guid OwnEndpoints::ParticipantOf(Index endpoint) const {
  return WithParticipantId(own_[endpoint].guid);
}

OwnEndpoints::Index OwnEndpoints::Add(const Endpoint& endpoint, int domain, std::int64_t now_ns) {
  hub_.TellOwn();
  const Guid participant = ParticipantOf(domain, now_ns);
  Own& own = own_.emplace_back(Own{endpoint, domain, participant, {}});
  const auto number = static_cast<std::uint32_t>(own_.size());
  own.guid[12] = static_cast<std::uint8_t>(number >> 16);
  own.guid[13] = static_cast<std::uint8_t>(number >> 8);
  own.guid[14] = static_cast<std::uint8_t>(number);
  const bool writes = endpoint.kind == EndpointKind::kWriter;
  own.guid[15] = endpoint.keyless ? (writes ? shm::kDdsWriterNoKeyId : shm::kDdsReaderNoKeyId)
                                  : (writes ? shm::kDdsWriterWithKeyId : shm::kDdsReaderWithKeyId);
  DdsMessage header = Announcement(DdsKind::kEndpoint, own.guid, domain);
  std::copy(participant.begin(), participant.end(), header.other);
  hub_.SendOwn(header, EncodeEndpoint(endpoint), now_ns);
  return own_.size() - 1;
}

DdsMessage OwnEndpoints::SampleHeader(const Own& writer, std::int64_t timestamp_ns) const {
  DdsMessage header = Announcement(DdsKind::kSample, writer.guid, writer.domain);
  header.source_timestamp_ns = timestamp_ns;
  header.sample_kind = shm::kDdsData;
  const Qos& qos = writer.endpoint.qos;
  if (qos.reliability == Reliability::kBestEffort) header.flags |= shm::kDdsUnreliable;
  if (qos.history == History::kKeepLast) header.keep_last = static_cast<std::uint32_t>(qos.depth);
  return header;
}

void OwnEndpoints::Write(Index writer, std::span<const std::byte> cdr, std::int64_t timestamp_ns,
                         std::int64_t due_ns) {
  Own& own = own_[writer];
  TCS_CHECK(own.endpoint.kind == EndpointKind::kWriter);
  if (own.endpoint.qos.durability == Durability::kTransientLocal) {
    own.history.push_back({{cdr.begin(), cdr.end()}, timestamp_ns});
    const bool keeps_all = own.endpoint.qos.history == History::kKeepAll;
    const auto depth = static_cast<std::size_t>(own.endpoint.qos.depth);
    if (!keeps_all && own.history.size() > depth) own.history.pop_front();
  }
  std::set<Hub::Number> reached;
  for (const auto& [guid, remote] : remotes_) {
    if (remote.endpoint.kind == EndpointKind::kReader && remote.domain == own.domain &&
        remote.endpoint.topic == own.endpoint.topic) {
      reached.insert(remote.process);
    }
  }
  DdsMessage header = SampleHeader(own, timestamp_ns);
  // A sample that nobody reads is still for the observers.
  if (reached.empty()) reached.insert(shm::kDdsCoordinator);
  for (const Hub::Number process : reached) {
    header.to = process;
    hub_.SendOwn(header, cdr, due_ns);
  }
}

// The owner of a transient-local writer sends such readers the samples that the writer has kept,
// and says when those were all.
void OwnEndpoints::Meet(const Guid& guid, const Remote& remote, std::int64_t now_ns) {
  if (!WantsHistory(remote.endpoint)) return;
  for (const Own& own : own_) {
    if (own.endpoint.kind != EndpointKind::kWriter || own.domain != remote.domain ||
        own.endpoint.topic != remote.endpoint.topic ||
        own.endpoint.qos.durability != Durability::kTransientLocal) {
      continue;
    }
    DdsMessage header = SampleHeader(own, 0);
    header.to = remote.process;
    PutGuid(guid, header.other);
    for (const Kept& kept : own.history) {
      header.source_timestamp_ns = kept.timestamp_ns;
      hub_.SendOwn(header, kept.cdr, now_ns);
    }
    header.kind = DdsKind::kHistoryEnd;
    header.source_timestamp_ns = 0;
    header.sample_kind = 0;
    hub_.SendOwn(header, {}, now_ns);
  }
}

void OwnEndpoints::Forget(const Guid& subject) {
  std::erase_if(remotes_, [&subject](const auto& entry) {
    return entry.first == subject || entry.second.participant == subject;
  });
}

void OwnEndpoints::Notice(const DdsMessage& header, std::span<const std::byte> payload) {
  const Guid subject = GuidAt(header.subject);
  if ((header.flags & shm::kDdsGone) != 0) {
    if (header.kind != DdsKind::kLiveliness) Forget(subject);
    return;
  }
  if (header.kind != DdsKind::kEndpoint) return;
  const std::optional<Endpoint> endpoint = DecodeEndpoint(payload);
  if (!endpoint.has_value()) return;
  const Remote remote{header.from, static_cast<int>(header.domain), GuidAt(header.other),
                      *endpoint};
  if (remotes_.insert_or_assign(subject, remote).second) Meet(subject, remote, header.time_ns);
}

// The sample has come for one of our readers; readers that the writer does not suit must not have
// it.
bool OwnEndpoints::Matches(const Own& reader, const Remote& writer) {
  const Endpoint &ours = reader.endpoint, &theirs = writer.endpoint;
  return ours.kind == EndpointKind::kReader && theirs.kind == EndpointKind::kWriter &&
         reader.domain == writer.domain && ours.topic == theirs.topic && ours.type == theirs.type &&
         !WhatDoesNotMatch(ours.qos, theirs.qos).has_value();
}

std::optional<OwnEndpoints::Sample> OwnEndpoints::Take(std::int64_t now_ns) {
  while (auto bytes = hub_.TakeOwn(now_ns)) {
    const DdsMessage header = HeaderOf(*bytes);
    const std::span<const std::byte> payload = PayloadOf(*bytes);
    if (header.kind != DdsKind::kSample) {
      Notice(header, payload);
      continue;
    }
    const auto writer = remotes_.find(GuidAt(header.subject));
    if (writer == remotes_.end() || header.sample_kind != shm::kDdsData) continue;
    Sample sample{.readers = {},
                  .at_ns = header.time_ns,
                  .writer = NumberOf(writer->first),
                  .sender_ran_ns = header.sender_ran,
                  .cdr = {payload.begin(), payload.end()}};
    for (Index i = 0; i < own_.size(); ++i) {
      const bool is_meant = !IsAddressed(header) || GuidAt(header.other) == own_[i].guid;
      if (is_meant && Matches(own_[i], writer->second)) sample.readers.push_back(i);
    }
    if (!sample.readers.empty()) return sample;
  }
  return std::nullopt;
}

}  // namespace tcs::dds
