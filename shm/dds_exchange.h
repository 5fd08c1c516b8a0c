// How programs that speak DDS hand their samples to each other without a network: messages, and the
// memory that they pass through.
//
// The coordinator is in the middle. A process that has a participant joins: it gets a number and an
// area, a memfd that no other process sees (whose pages cost nothing until they are used):
//
//   +---------+------------------+------------------+
//   | DdsArea | outbox           | inbox            |
//   +---------+------------------+------------------+
//               written by the     written by the
//               process            coordinator
//
// To send, a process writes whole messages into its outbox and notifies (kDdsSend): the messages
// carry the virtual time of that notification. The coordinator copies them out, checks them, and
// keeps them in the order of their times. One thread of each process, the *deliverer*, waits for
// messages that are due (kDdsWait): the coordinator wakes it at the message's time, the messages in
// its inbox. The robot's scheduler schedules the deliverer, as it does a middleware's threads,
// because the program's listeners run on it. A thread that is about to look at what has come first
// waits until no program can send anything before the thread's own time any more (kRead), and then
// until the deliverer is done (kDdsSync). Meanwhile the thread lends the deliverer its priority
// (priority inheritance). It does not wait for samples for whose receiving the deliverer still has
// to pay (coordinator/calls/dds_costs.h): natively they are not there yet, either.
//
// Back-pressure: a process for which more waits than it can take at once is *full*, because it
// takes more slowly than others write, or hangs. The coordinator shows in all areas which processes
// are full. A sample for a full process is treated as DDS says (DdsMessage::keep_last,
// kDdsUnreliable). A reliable writer that keeps all samples waits before it writes the next one
// (kDdsRoom), for as long as its QoS say, and then its write fails. Of a writer that keeps the last
// few, further samples of an instance replace the ones that wait. Best-effort samples are dropped
// and counted.
//
// The coordinator remembers participants and endpoints: a process that joins later is told of them,
// and when a process dies its participants are reported as gone once their leases are over. The
// coordinator trusts nothing that it reads here. Any change bumps kVersion (layout.h).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tcs::shm {

inline constexpr std::size_t kDdsHeaderSize = 4096;
inline constexpr std::size_t kDdsBoxSize = std::size_t{128} << 20;
// The bytes of messages that are handed over at a time. A larger message comes alone, and its
// memory is given back.
inline constexpr std::size_t kDdsUsualSize = std::size_t{16} << 20;
inline constexpr std::size_t kDdsAreaSize = kDdsHeaderSize + 2 * kDdsBoxSize;
inline constexpr std::uint32_t kDdsMostProcesses = 1024;

// Numbers of processes.
inline constexpr std::uint32_t kDdsCoordinator = 0;
inline constexpr std::uint32_t kDdsEverybody = UINT32_MAX;

// DdsMessage::sample_kind of what is more than a key.
inline constexpr std::uint32_t kDdsData = 2;

// Written by the coordinator.
struct alignas(64) DdsArea {
  std::atomic<std::int64_t> due_ns;       // of the earliest message not handed over; kNeverNs
  std::atomic<std::uint32_t> delivers;    // 1: the deliverer has not come back for more yet
  std::uint32_t process;                  // the process's number
  std::atomic<std::uint32_t> full_count;  // processes that are full
  std::uint32_t reserved32;
  std::uint64_t reserved[5];
  std::atomic<std::uint64_t> full[kDdsMostProcesses / 64];  // which: bit 0 of the first is number 1

  bool IsFull(std::uint32_t number) const {
    return number > 0 && number <= kDdsMostProcesses &&
           (full[(number - 1) / 64].load() >> ((number - 1) % 64) & 1) != 0;
  }
};
static_assert(sizeof(DdsArea) == 192);
static_assert(offsetof(DdsArea, full) == 64);
static_assert(sizeof(DdsArea) <= kDdsHeaderSize);

enum class DdsKind : std::uint16_t {
  kParticipant = 1,  // subject: the participant's GUID; payload: DdsQos
  kEndpoint = 2,     // subject: the endpoint's GUID; other: its participant's; payload: DdsEndpoint
  kSample = 3,      // subject: the writer's GUID; other: the reader's, or zeros for all that match;
                    // payload: CDR with its encapsulation header
  kHistoryEnd = 4,  // subject: a writer's GUID, other: a reader's: the reader has been sent all
                    // that the writer had when they met
  kTopic = 6,       // as kEndpoint: of topics that are made known by themselves, which Cyclone's
                    // configuration asks for (EnableTopicDiscoveryEndpoints)
  kLiveliness = 5,  // subject: a writer's or a participant's GUID: asserted, or with kDdsGone lost
};

// DdsMessage::flags.
inline constexpr std::uint16_t kDdsGone = 1;  // the subject is no more
// The subject stays alive for lease_ns only, unless its process says so (DDS's automatic
// liveliness): reported as lost, that long after the process's death.
inline constexpr std::uint16_t kDdsLeased = 2;
// No reader in the process that the sample is for has been promised it.
inline constexpr std::uint16_t kDdsUnreliable = 4;
// A message for all processes is for the sender, too, if the sender has several domains that are
// one on the network.
inline constexpr std::uint16_t kDdsToSender = 8;

struct DdsMessage {
  std::uint32_t size;  // of the whole message, a multiple of 8: this structure, the payload, zeros
  DdsKind kind;
  std::uint16_t flags;
  std::uint32_t from;    // set by the coordinator
  std::uint32_t to;      // a process's number, or kDdsEverybody but the sender (see kDdsToSender)
  std::int64_t time_ns;  // virtual, when it was sent; set by the coordinator
  std::uint8_t subject[16];
  std::uint8_t other[16];
  std::int64_t source_timestamp_ns;  // DDS's, of samples
  std::int64_t lease_ns;             // of participants and writers, INT64_MAX for ever
  std::uint32_t domain;              // as it is called on the network
  std::uint32_t status_info;         // of samples: Cyclone's NN_STATUSINFO_* bits
  std::uint32_t sample_kind;  // of samples, Cyclone's ddsi_serdata_kind: kDdsData or of a key only
  std::uint32_t payload_size;
  // Of samples for all readers: `keep_last` is how many samples of an instance a reliable writer
  // keeps (0: all), `instance` the number of the instance in the writer's process. Of participants,
  // `instance` is DdsTag of their domain.
  std::uint32_t keep_last;
  std::uint32_t sender_ran;  // the coordinator's own: see Hub::Send, the lower half
  std::uint64_t instance;
};
static_assert(sizeof(DdsMessage) == 104);
static_assert(offsetof(DdsMessage, subject) == 24);
static_assert(offsetof(DdsMessage, source_timestamp_ns) == 56);
static_assert(offsetof(DdsMessage, instance) == 96);

// The tag that Cyclone's configuration may give a domain (Discovery/Tag). Participants of domains
// with different tags do not meet. The coordinator meets the participants of all domains.
inline constexpr std::uint64_t DdsTag(const char* tag) {
  if (tag == nullptr || *tag == '\0') return 0;
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (; *tag != '\0'; ++tag) hash = (hash ^ static_cast<unsigned char>(*tag)) * 0x100000001b3u;
  return hash;
}

inline constexpr std::uint32_t DdsMessageSize(std::uint32_t payload_size) {
  return static_cast<std::uint32_t>((sizeof(DdsMessage) + payload_size + 7) / 8 * 8);
}
inline constexpr std::uint32_t kDdsMostPayload =
    static_cast<std::uint32_t>(kDdsBoxSize - sizeof(DdsMessage) - 8);

}  // namespace tcs::shm
