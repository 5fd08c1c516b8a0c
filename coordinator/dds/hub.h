// The hub through which the messages of programs that speak DDS pass: it keeps them in the order of
// their virtual times until they are due, remembers participants and endpoints for processes that
// join later, and reports as gone the entities that a dead process has left behind
// (shm/dds_exchange.h).
//
// Used by the coordinator's only thread. Trusts nothing that processes write: messages are copied,
// then checked. Times are virtual nanoseconds; kNeverNs for never.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/dds/message.h"
#include "coordinator/port/unique_fd.h"
#include "shm/dds_exchange.h"
#include "shm/layout.h"

namespace tcs::dds {

// An observer of the messages that pass through the hub.
class HubObserver {
 public:
  virtual ~HubObserver() = default;
  // A message has been sent: once for each process that it is for, in the order of sending, which
  // is not that of times where processes have come to different ones.
  virtual void Entered(const shm::DdsMessage& header, std::span<const std::byte> payload) = 0;
  // Process `to` does not get this sample.
  virtual void Dropped(const shm::DdsMessage& header, std::uint32_t to) = 0;
  // Process `to` has been given the message at `at_ns`; 0: the coordinator has taken it.
  virtual void Delivered(const shm::DdsMessage&, std::uint32_t /*to*/, std::int64_t /*at_ns*/) {}
  // A process has died, or executes another program: nothing more comes from it.
  virtual void Left(std::uint32_t from) = 0;
};

// How long messages between two processes are on their way.
class HubPaths {
 public:
  virtual ~HubPaths() = default;
  // When a message that is sent now (its time_ns) reaches the process; kNeverNs: the message is
  // lost. Asked once for each message and receiver, in the order of sending.
  virtual std::int64_t ArrivalNs(const shm::DdsMessage& header, std::uint32_t to) = 0;
  // How long a process takes to hear of another's participants and endpoints when it asks for them.
  virtual std::int64_t RoundTripNs(std::uint32_t one, std::uint32_t other) const = 0;
};

class Hub {
 public:
  using Number = std::uint32_t;  // of a process, from 1 on; 0: the coordinator
  // A whole message with its header, as shm/dds_exchange.h says.
  using Bytes = std::vector<std::byte>;

  Hub() = default;
  ~Hub();
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  // A new process joins, and is told of all participants and endpoints. Returns 0, with errno, if
  // there is no room.
  Number Join(std::int64_t now_ns);
  // The process has died, or executes another program.
  void Leave(Number number, std::int64_t now_ns);
  // The process is stopped, so that it renews no lease: others miss it, as they miss a dead
  // process, until it goes on. If others have missed it by then, the process and the others find
  // each other anew.
  void Stop(Number number, std::int64_t now_ns);
  void Continue(Number number, std::int64_t now_ns);

  // Takes the messages in the first `bytes` of the process's outbox, sent at `now_ns` by a thread
  // that had been charged `ran_ns`. Says what is wrong with the first malformed message, as the
  // rest of a sentence about the process; that message and all after it are dropped.
  [[nodiscard]] std::string Send(Number from, std::size_t bytes, std::int64_t now_ns,
                                 std::int64_t ran_ns = 0);

  // When the process's next message is due.
  std::int64_t DueNs(Number number) const;
  // Puts the messages that are due, at most so many, into the process's inbox, as far as there is
  // room; returns the bytes. From then on the process is delivering, until it has come back for
  // more.
  std::size_t Deliver(Number number, std::int64_t now_ns, std::size_t most = SIZE_MAX);
  // Calls `visit(header)` for the messages that Deliver would put there, until that says false.
  template <class Visit>
  void ForEachDue(Number number, std::int64_t now_ns, Visit visit) const {
    const Member* member = Find(number);
    if (member == nullptr) return;
    std::size_t filled = 0;
    for (const auto& [due_ns, message] : member->queue) {
      if (due_ns > now_ns || !Fits(*message, filled)) return;
      filled += message->size();
      if (!visit(HeaderOf(*message))) return;
    }
  }
  void CameBack(Number number);
  bool IsDelivering(Number number) const;
  // More messages wait for the process, or are in its hands, than it can take at once
  // (shm/dds_exchange.h). A process that dies while it is full stays full.
  bool IsFull(Number number) const;

  // The messages that wait for the process and are not in its hands yet.
  struct Backlog {
    std::size_t messages = 0, bytes = 0;
    std::int64_t due_ns = shm::kNeverNs;  // the first
  };
  Backlog BacklogOf(Number number) const;

  // Sends a message of the coordinator itself, due at `due_ns`. Size, time and sender of `header`
  // are filled in here.
  void SendOwn(shm::DdsMessage header, std::span<const std::byte> payload, std::int64_t due_ns);
  // The earliest message for the coordinator, if it is from before or at `now_ns`. Such messages
  // are participants, endpoints and messages addressed to the coordinator; they are kept only once
  // it has asked to be told.
  void TellOwn() { tells_own_ = true; }
  std::optional<Bytes> TakeOwn(std::int64_t now_ns);
  std::int64_t OwnDueNs() const { return own_.empty() ? shm::kNeverNs : own_.begin()->first; }

  // Null: nobody observes. The observer outlives this.
  void Observe(HubObserver* observer) { observer_ = observer; }

  // Null: messages arrive when they are sent. `paths` outlives this.
  void Route(HubPaths* paths) { paths_ = paths; }

  // How many processes have joined so far: the largest number.
  Number count() const { return static_cast<Number>(members_.size()); }
  // The memory of the process's area, where nobody else looks; -1 if there is no such process.
  int AreaOf(Number number) const;
  // Samples that a process did not get because too much waits for it.
  struct Drops {
    std::uint64_t unreliable = 0;  // promised to nobody
    std::uint64_t replaced = 0;    // by later ones of a writer that keeps the last ones
    std::uint64_t lost = 0;        // promised, but the process takes nothing any more
  };
  const Drops& drops() const { return drops_; }

 private:
  using Message = std::shared_ptr<const Bytes>;
  using Queued = std::multimap<std::int64_t, Message>;  // by the time when it is due

  struct Member {
    char* area = nullptr;  // null: the process has left
    UniqueFd fd;           // of the area
    bool delivers = false;
    bool full = false;
    bool stopped = false;
    std::vector<Message> lease_ends;  // while stopped: those that others do not have yet
    Queued queue;
    std::size_t queued_bytes = 0;
    std::size_t delivered_bytes = 0;  // in the inbox until the process comes back for more
    std::size_t known_bytes = 0;      // of its participants and endpoints
    // While the process is full: the queued messages that may be replaced, by writer and instance.
    std::map<std::pair<Guid, std::uint64_t>, std::deque<Queued::iterator>> replaceable;

    shm::DdsArea& shown() const { return *reinterpret_cast<shm::DdsArea*>(area); }
    char* outbox() const { return area + shm::kDdsHeaderSize; }
    char* inbox() const { return outbox() + shm::kDdsBoxSize; }
    void ShowDue() const;
    void ShowFull(Number number, bool is_full) const;  // of another process, in this area
  };
  // A participant or an endpoint.
  struct Known {
    Number from;
    shm::DdsKind kind;
    Guid subject, participant;
    std::uint16_t flags;
    std::int64_t lease_ns;
    Message message;
  };

  std::string EnterAll(Number from, std::span<const std::byte> left, std::int64_t now_ns,
                       std::int64_t ran_ns);
  void Enter(const shm::DdsMessage& header, Bytes bytes);
  std::optional<std::string> WhyNot(const shm::DdsMessage& header,
                                    std::span<const std::byte> payload) const;
  std::vector<Known>::const_iterator KnownAs(Number from, const Guid& subject) const;
  bool IsAnothers(const Guid& guid, Number number) const;
  void Forget(Number from, const Guid& subject);
  // Whether a box with so many bytes in it has room for the message.
  static bool Fits(const Bytes& message, std::size_t filled);
  void TellDelivered(const Bytes& message, Number to, std::int64_t at_ns);
  Member* Find(Number number);
  const Member* Find(Number number) const;
  void Queue(Number to, std::int64_t due_ns, const Message& message);
  // The same, for a message that is sent now.
  void Pass(Number to, const shm::DdsMessage& header, const Message& message);
  // The messages that others get when the leases of a process's entities are over.
  std::vector<Message> EndLeases(Number number, const std::vector<Known>& of, std::int64_t now_ns);
  void Introduce(Number to, Number whom, std::int64_t now_ns);
  void QueueForOthers(Number from, std::int64_t due_ns, const Message& message);
  void Remember(const shm::DdsMessage& header, const Message& message);
  void Drop(const shm::DdsMessage& header, Number to, std::uint64_t& count);
  void Replace(Number to, Queued::iterator latest);
  void ShowFull(Number number);
  static void GiveBack(const Member& member, std::size_t box, std::size_t bytes);

  HubObserver* observer_ = nullptr;
  HubPaths* paths_ = nullptr;
  bool tells_own_ = false;
  Queued own_;                           // for the coordinator
  std::vector<Member> members_;          // of number i + 1
  std::vector<Known> known_;             // in the order in which they came
  std::map<GuidPrefix, Number> owners_;  // of participants that exist
  Drops drops_;
};

}  // namespace tcs::dds
