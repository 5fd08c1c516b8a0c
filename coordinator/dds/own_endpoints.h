// The coordinator's own writers and readers: the hub connects the coordinator like a process,
// without it being a DDS participant. A participant per domain stands for all of its endpoints
// there.
//
// Cyclone decides in the reader's process whether a client's reader matches: every process with a
// reader of the topic gets the samples, once. Cyclone also decides in the writer's process whether
// a client's writer suits a reader of ours. If several readers of ours have the topic, the choice
// among them is made here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/dds/endpoint_code.h"
#include "coordinator/dds/hub.h"

namespace tcs::dds {

class OwnEndpoints {
 public:
  using Index = std::size_t;  // of an endpoint, in the order of adding

  // The hub outlives this.
  explicit OwnEndpoints(Hub& hub) : hub_(hub) {}

  // The endpoint is announced at `now_ns` to all processes that have joined, and to those that
  // will.
  Index Add(const Endpoint& endpoint, int domain, std::int64_t now_ns);

  // The sample reaches all readers of the topic at `due_ns`, and not before samples that were
  // written earlier. `timestamp_ns` is DDS's source timestamp.
  void Write(Index writer, std::span<const std::byte> cdr, std::int64_t timestamp_ns,
             std::int64_t due_ns);

  struct Sample {
    std::vector<Index> readers;  // all that the writer suits, or the addressed one
    std::int64_t at_ns;          // when it was written
    std::uint64_t writer;        // a different number for each writer
    std::int64_t sender_ran_ns;  // as Hub::Send was told
    std::vector<std::byte> cdr;
  };
  // The next sample that was written by `now_ns` to one of the readers. Also takes notice of
  // others' readers and writers.
  std::optional<Sample> Take(std::int64_t now_ns);

  // The endpoint's GUID: the twelve bytes of its participant, then four of its own.
  Guid GuidOf(Index endpoint) const { return own_[endpoint].guid; }
  // The GUID of the participant that the endpoint belongs to.
  Guid ParticipantOf(Index endpoint) const;

 private:
  struct Kept {
    std::vector<std::byte> cdr;
    std::int64_t timestamp_ns;
  };
  struct Own {
    Endpoint endpoint;
    int domain = 0;
    Guid guid{};
    std::deque<Kept> history;  // of a transient-local writer
  };
  // An endpoint of another process.
  struct Remote {
    Hub::Number process = 0;
    int domain = 0;
    Guid participant{};
    Endpoint endpoint;
  };

  Guid ParticipantOf(int domain, std::int64_t now_ns);
  void Notice(const shm::DdsMessage& header, std::span<const std::byte> payload);
  void Meet(const Guid& guid, const Remote& remote, std::int64_t now_ns);
  void Forget(const Guid& subject);
  static bool Matches(const Own& reader, const Remote& writer);
  shm::DdsMessage SampleHeader(const Own& writer, std::int64_t timestamp_ns) const;

  Hub& hub_;
  std::vector<Own> own_;
  std::set<int> domains_;  // with a participant
  std::map<Guid, Remote> remotes_;
};

}  // namespace tcs::dds
