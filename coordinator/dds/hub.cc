#include "coordinator/dds/hub.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <iterator>
#include <new>
#include <utility>

#include "coordinator/dds/well_formed.h"
#include "coordinator/os/shared_memory.h"
#include "shm/time_values.h"

namespace tcs::dds {

namespace {

using shm::DdsKind;
using shm::DdsMessage;

// The bytes that may wait for one process. A process that lets more wait has stopped taking them.
constexpr std::size_t kMostQueuedBytes = std::size_t{256} << 20;
// The bytes beyond that for news of participants, endpoints and liveliness: a program should not
// miss any news for as long as it may still go on.
constexpr std::size_t kMostQueuedNewsBytes = std::size_t{64} << 20;
// The bytes that one process may have told of its participants and endpoints: some ten thousands of
// them.
constexpr std::size_t kMostKnownBytes = std::size_t{16} << 20;
// A process is full beyond that: some milliseconds' work for its deliverer. Cyclone's writers stop
// at half of it.
constexpr std::size_t kFullBytes = std::size_t{1} << 20;

// A participant that has been missed is found again that much later. Over a network that takes as
// long as the next announcement; Cyclone needs some of that time to collect what it knew under the
// same GUID.
constexpr std::int64_t kRediscoveryNs = 100'000'000;

std::int64_t After(std::int64_t now_ns, std::int64_t ns) {
  return ns < 0 ? shm::kNeverNs : shm::AddSaturated(now_ns, ns);
}

// A writer that keeps the last samples has room for a new one at the cost of an earlier one. A
// sample that ends an instance is not replaced, and replaces none.
bool IsReplaceable(const DdsMessage& header) {
  return header.kind == DdsKind::kSample && header.keep_last > 0 && header.status_info == 0 &&
         !IsAddressed(header);
}

bool IsNewsOfEntity(const DdsMessage& header) {
  return header.kind == DdsKind::kParticipant || header.kind == DdsKind::kEndpoint ||
         header.kind == DdsKind::kTopic;
}

}  // namespace

Hub::~Hub() {
  for (const Member& member : members_) {
    if (member.area == nullptr) continue;
    munmap(member.area, shm::kDdsAreaSize);
  }
}

int Hub::AreaOf(Number number) const {
  const Member* member = Find(number);
  return member == nullptr ? -1 : member->fd.get();
}

void Hub::Member::ShowDue() const {
  shown().due_ns.store(queue.empty() ? shm::kNeverNs : queue.begin()->first);
}

void Hub::Member::ShowFull(Number number, bool is_full) const {
  const std::uint64_t bit = std::uint64_t{1} << (number - 1) % 64;
  std::atomic<std::uint64_t>& word = shown().full[(number - 1) / 64];
  if (is_full) {
    word.fetch_or(bit);
    shown().full_count.fetch_add(1);
  } else {
    word.fetch_and(~bit);
    shown().full_count.fetch_sub(1);
  }
}

Hub::Member* Hub::Find(Number number) {
  return const_cast<Member*>(std::as_const(*this).Find(number));
}

const Hub::Member* Hub::Find(Number number) const {
  if (number == 0 || number > members_.size()) return nullptr;
  const Member& member = members_[number - 1];
  return member.area == nullptr ? nullptr : &member;
}

Hub::Number Hub::Join(std::int64_t now_ns) {
  if (members_.size() == shm::kDdsMostProcesses) {
    errno = ENOSPC;
    return 0;
  }
  SharedMemory memory = MakeSharedMemory("tcs-dds", shm::kDdsAreaSize);
  if (!memory.fd) return 0;
  Member& member = members_.emplace_back();
  member.area = static_cast<char*>(memory.at);
  member.fd = std::move(memory.fd);
  const Number number = count();
  auto* area = new (memory.at) shm::DdsArea{};
  area->process = number;
  member.ShowDue();
  for (Number other = 1; other < number; ++other) {
    if (members_[other - 1].full && Find(other) != nullptr) member.ShowFull(other, true);
  }
  for (const Known& known : known_) {
    const bool is_far = paths_ != nullptr && known.from != shm::kDdsCoordinator;
    const std::int64_t way_ns = is_far ? paths_->RoundTripNs(known.from, number) : 0;
    Queue(number, now_ns + way_ns, known.message);
  }
  return number;
}

// The process's number is not given again: others may still hear from the process. But its memory
// goes back, even if the process still has that, too.
void Hub::Leave(Number number, std::int64_t now_ns) {
  Member* member = Find(number);
  if (member == nullptr) return;
  munmap(member->area, shm::kDdsAreaSize);
  fallocate(member->fd.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0,
            static_cast<off_t>(shm::kDdsAreaSize));
  const bool was_full = member->full, was_stopped = member->stopped;
  *member = Member{};
  // A writer that waits for room here goes on when others miss the process.
  member->full = was_full;
  std::vector<Known> left;
  std::erase_if(known_, [&](const Known& known) {
    if (known.from == number) left.push_back(known);
    return known.from == number;
  });
  // If the process was stopped, its leases run out as they do already.
  if (!was_stopped) EndLeases(number, left, now_ns);
  std::erase_if(owners_, [number](const auto& owner) { return owner.second == number; });
  if (observer_ != nullptr) observer_->Left(number);
}

// No process says that a lease is over: others notice.
std::vector<Hub::Message> Hub::EndLeases(Number number, const std::vector<Known>& of,
                                         std::int64_t now_ns) {
  std::vector<Message> ends;
  for (const Known& known : of) {
    const bool is_participant = known.kind == DdsKind::kParticipant;
    if (!is_participant && (known.flags & shm::kDdsLeased) == 0) continue;
    const std::int64_t due = After(now_ns, known.lease_ns);
    if (due == shm::kNeverNs) continue;
    DdsMessage header = HeaderOf(*known.message);
    header.size = sizeof header;
    header.payload_size = 0;
    header.kind = is_participant ? DdsKind::kParticipant : DdsKind::kLiveliness;
    header.flags = shm::kDdsGone;
    header.time_ns = due;
    Bytes bytes(sizeof header);
    PutHeader(header, bytes);
    ends.push_back(std::make_shared<const Bytes>(std::move(bytes)));
    QueueForOthers(number, due, ends.back());
  }
  return ends;
}

void Hub::Stop(Number number, std::int64_t now_ns) {
  Member* member = Find(number);
  if (member == nullptr || std::exchange(member->stopped, true)) return;
  std::vector<Known> own;
  std::ranges::copy_if(known_, std::back_inserter(own),
                       [number](const Known& known) { return known.from == number; });
  member->lease_ends = EndLeases(number, own, now_ns);
}

void Hub::Continue(Number number, std::int64_t now_ns) {
  Member* member = Find(number);
  if (member == nullptr || !std::exchange(member->stopped, false)) return;
  bool is_missed = false;
  for (const Message& end : std::exchange(member->lease_ends, {})) {
    const DdsMessage header = HeaderOf(*end);
    if (header.time_ns <= now_ns) {
      is_missed |= header.kind == DdsKind::kParticipant;
      continue;
    }
    const auto is_it = [&end](const auto& queued) { return queued.second == end; };
    std::erase_if(own_, is_it);
    for (Member& other : members_) {
      if (std::erase_if(other.queue, is_it) == 0) continue;
      other.queued_bytes -= end->size();
      other.ShowDue();
    }
  }
  if (!is_missed) return;
  for (Number other = shm::kDdsCoordinator; other <= count(); ++other) {
    if (other == number) continue;
    Introduce(other, number, now_ns);
    if (other != shm::kDdsCoordinator) Introduce(number, other, now_ns);
  }
}

// As if process `whom` had gone and come back.
void Hub::Introduce(Number to, Number whom, std::int64_t now_ns) {
  for (const bool comes : {false, true}) {
    for (const Known& known : known_) {
      if (known.from != whom || (!comes && known.kind != DdsKind::kParticipant)) continue;
      Bytes bytes = *known.message;
      DdsMessage header = HeaderOf(bytes);
      if (!comes) header.flags = shm::kDdsGone;
      header.time_ns = comes ? now_ns + kRediscoveryNs : now_ns;
      PutHeader(header, bytes);
      Queue(to, header.time_ns, std::make_shared<const Bytes>(std::move(bytes)));
    }
  }
}

std::string Hub::Send(Number from, std::size_t bytes, std::int64_t now_ns, std::int64_t ran_ns) {
  const Member* member = Find(from);
  if (member == nullptr) {
    return "sends DDS messages in a child that it has forked, where its participants are not: they "
           "are lost; let the child make its own, after executing a program";
  }
  if (bytes > shm::kDdsBoxSize) {
    return fmt::format(
        "sends {} bytes of DDS messages at once, more than there is room for: they "
        "are lost; is its libtcs_dds.so of another version?",
        bytes);
  }
  std::string wrong =
      EnterAll(from, {reinterpret_cast<const std::byte*>(member->outbox()), bytes}, now_ns, ran_ns);
  GiveBack(*Find(from), shm::kDdsHeaderSize, bytes);
  return wrong;
}

// The messages are in memory that the program may write to all the while.
std::string Hub::EnterAll(Number from, std::span<const std::byte> left, std::int64_t now_ns,
                          std::int64_t ran_ns) {
  while (!left.empty()) {
    DdsMessage header{};
    if (left.size() >= sizeof header) header = HeaderOf(left);
    // The header that has been checked is not to be read again.
    std::atomic_signal_fence(std::memory_order_seq_cst);
    if (auto wrong = WhatIsWrongWithSize(header, left.size())) return *wrong;
    header.from = from;
    header.time_ns = now_ns;
    header.sender_ran = static_cast<std::uint32_t>(ran_ns);
    Bytes copy(left.begin(), left.begin() + header.size);
    PutHeader(header, copy);
    if (auto wrong = WhyNot(header, PayloadOf(copy))) return *wrong;
    left = left.subspan(header.size);
    Enter(header, std::move(copy));
  }
  return {};
}

// The size of the message is right.
std::optional<std::string> Hub::WhyNot(const DdsMessage& header,
                                       std::span<const std::byte> payload) const {
  if (auto wrong = WhatIsWrong(header, payload)) return wrong;
  if (header.to != shm::kDdsEverybody && header.to > count()) {
    return fmt::format(
        "sends a DDS message to a process that does not exist, {}: it and what it "
        "sent with it are lost; is its libtcs_dds.so of another version?",
        header.to);
  }
  if (IsAnothers(GuidAt(header.subject), header.from) ||
      (IsNewsOfEntity(header) && header.kind != DdsKind::kParticipant &&
       IsAnothers(GuidAt(header.other), header.from))) {
    return "speaks for a DDS participant of another program: that is lost; GUIDs must not be "
           "copied from one program into another";
  }
  if (!IsNewsOfEntity(header) || (header.flags & shm::kDdsGone) != 0) return std::nullopt;
  const auto before = KnownAs(header.from, GuidAt(header.subject));
  const std::size_t had = before == known_.end() ? 0 : before->message->size();
  if (Find(header.from)->known_bytes - had + header.size > kMostKnownBytes) {
    return "has made so many DDS participants, writers and readers that their descriptions take 16 "
           "MiB: other programs are not told of further ones; delete the ones that are not needed "
           "any more";
  }
  return std::nullopt;
}

std::vector<Hub::Known>::const_iterator Hub::KnownAs(Number from, const Guid& subject) const {
  return std::ranges::find_if(
      known_, [&](const Known& known) { return known.from == from && known.subject == subject; });
}

// Whether the participant that the GUID belongs to is another process's.
bool Hub::IsAnothers(const Guid& guid, Number number) const {
  const auto owner = owners_.find(PrefixOf(guid));
  return owner != owners_.end() && owner->second != number;
}

// Gives back the memory of a box of which so many bytes have been used.
void Hub::GiveBack(const Member& member, std::size_t box, std::size_t bytes) {
  if (bytes <= shm::kDdsUsualSize) return;
  fallocate(member.fd.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
            static_cast<off_t>(box + shm::kDdsUsualSize),
            static_cast<off_t>(bytes - shm::kDdsUsualSize));
}

void Hub::SendOwn(DdsMessage header, std::span<const std::byte> payload, std::int64_t due_ns) {
  header.payload_size = static_cast<std::uint32_t>(payload.size());
  header.size = shm::DdsMessageSize(header.payload_size);
  header.from = shm::kDdsCoordinator;
  header.time_ns = due_ns;
  Bytes bytes(header.size);
  PutHeader(header, bytes);
  std::copy(payload.begin(), payload.end(), bytes.begin() + sizeof header);
  Enter(header, std::move(bytes));
}

void Hub::TellDelivered(const Bytes& message, Number to, std::int64_t at_ns) {
  if (observer_ == nullptr) return;
  DdsMessage header;
  memcpy(&header, message.data(), sizeof header);
  observer_->Delivered(header, to, at_ns);
}

std::optional<Hub::Bytes> Hub::TakeOwn(std::int64_t now_ns) {
  if (own_.empty() || own_.begin()->first > now_ns) return std::nullopt;
  const Message message = own_.begin()->second;
  TellDelivered(*message, shm::kDdsCoordinator, own_.begin()->first);
  own_.erase(own_.begin());
  return *message;
}

void Hub::Enter(const DdsMessage& header, Bytes bytes) {
  const auto message = std::make_shared<const Bytes>(std::move(bytes));
  if (observer_ != nullptr) {
    observer_->Entered(header, std::span(*message).subspan(sizeof header, header.payload_size));
  }
  Remember(header, message);
  if (header.to == shm::kDdsEverybody) {
    for (Number to = shm::kDdsCoordinator; to <= count(); ++to) {
      if (to != header.from) Pass(to, header, message);
    }
    const bool to_sender = (header.flags & shm::kDdsToSender) != 0;
    if (to_sender && header.from != shm::kDdsCoordinator) {
      Queue(header.from, header.time_ns, message);
    }
  } else {
    Pass(header.to, header, message);
  }
}

void Hub::Pass(Number to, const DdsMessage& header, const Message& message) {
  std::int64_t due_ns = header.time_ns;
  const bool is_heard = to == shm::kDdsCoordinator || Find(to) != nullptr;
  if (paths_ != nullptr && header.from != shm::kDdsCoordinator && is_heard) {
    due_ns = paths_->ArrivalNs(header, to);
  }
  if (due_ns != shm::kNeverNs) {
    Queue(to, due_ns, message);
  } else if (observer_ != nullptr && header.kind == DdsKind::kSample) {
    observer_->Dropped(header, to);
  }
}

void Hub::Remember(const DdsMessage& header, const Message& message) {
  if (!IsNewsOfEntity(header)) return;
  const Guid subject = GuidAt(header.subject);
  if ((header.flags & shm::kDdsGone) != 0) return Forget(header.from, subject);
  if (header.kind == DdsKind::kParticipant) owners_[PrefixOf(subject)] = header.from;
  Member* member = Find(header.from);  // null: the coordinator
  if (member != nullptr) member->known_bytes += message->size();
  Known now{header.from,  header.kind,     subject, GuidAt(header.other),
            header.flags, header.lease_ns, message};
  const auto before = KnownAs(header.from, subject);
  if (before == known_.end()) {
    known_.push_back(std::move(now));
    return;
  }
  if (member != nullptr) member->known_bytes -= before->message->size();
  known_[static_cast<std::size_t>(before - known_.begin())] = std::move(now);
}

// A participant takes its endpoints along.
void Hub::Forget(Number from, const Guid& subject) {
  Member* member = Find(from);
  std::erase_if(known_, [&](const Known& known) {
    if (known.from != from || (known.subject != subject && known.participant != subject)) {
      return false;
    }
    if (known.kind == DdsKind::kParticipant) owners_.erase(PrefixOf(known.subject));
    if (member != nullptr) member->known_bytes -= known.message->size();
    return true;
  });
}

void Hub::QueueForOthers(Number from, std::int64_t due_ns, const Message& message) {
  for (Number to = shm::kDdsCoordinator; to <= count(); ++to) {
    if (to != from) Queue(to, due_ns, message);
  }
}

void Hub::Queue(Number to, std::int64_t due_ns, const Message& message) {
  if (to == shm::kDdsCoordinator && tells_own_) own_.emplace(due_ns, message);
  Member* member = Find(to);
  if (member == nullptr) return;
  const DdsMessage header = HeaderOf(*message);
  if (header.kind == DdsKind::kSample) {
    if (member->full && (header.flags & shm::kDdsUnreliable) != 0) {
      return Drop(header, to, drops_.unreliable);
    }
  }
  const std::size_t most =
      header.kind == DdsKind::kSample ? kMostQueuedBytes : kMostQueuedBytes + kMostQueuedNewsBytes;
  if (member->queued_bytes + message->size() > most) return Drop(header, to, drops_.lost);
  member->queued_bytes += message->size();
  const auto place = member->queue.emplace(due_ns, message);
  ShowFull(to);
  if (member->full) Replace(to, place);
  member->ShowDue();
}

void Hub::Drop(const DdsMessage& header, Number to, std::uint64_t& count) {
  ++count;
  if (observer_ != nullptr && header.kind == DdsKind::kSample) observer_->Dropped(header, to);
}

// A full process has one message more; if that is of a writer that keeps the last ones, only the
// last ones stay.
void Hub::Replace(Number to, Queued::iterator latest) {
  const DdsMessage header = HeaderOf(*latest->second);
  if (!IsReplaceable(header)) return;
  Member& member = members_[to - 1];
  const auto note = [&member](Queued::iterator place) {
    const DdsMessage noted = HeaderOf(*place->second);
    if (!IsReplaceable(noted)) return;
    member.replaceable[{GuidAt(noted.subject), noted.instance}].push_back(place);
  };
  if (member.replaceable.empty()) {
    for (auto place = member.queue.begin(); place != member.queue.end(); ++place) note(place);
  } else {
    note(latest);
  }
  auto& kept = member.replaceable[{GuidAt(header.subject), header.instance}];
  while (kept.size() > header.keep_last) {
    const Queued::iterator earlier = kept.front();
    kept.pop_front();
    Drop(HeaderOf(*earlier->second), to, drops_.replaced);
    member.queued_bytes -= earlier->second->size();
    member.queue.erase(earlier);
  }
  ShowFull(to);
}

// In all areas, when the process's state has changed.
void Hub::ShowFull(Number number) {
  Member& member = members_[number - 1];
  const bool full = IsFull(number);
  if (std::exchange(member.full, full) == full) return;
  if (!full) member.replaceable.clear();
  for (const Member& other : members_) {
    if (other.area != nullptr) other.ShowFull(number, full);
  }
}

std::int64_t Hub::DueNs(Number number) const {
  const Member* member = Find(number);
  return member == nullptr || member->queue.empty() ? shm::kNeverNs : member->queue.begin()->first;
}

Hub::Backlog Hub::BacklogOf(Number number) const {
  const Member* member = Find(number);
  if (member == nullptr) return {};
  return {member->queue.size(), member->queued_bytes, DueNs(number)};
}

bool Hub::Fits(const Bytes& message, std::size_t filled) {
  if (filled + message.size() <= shm::kDdsUsualSize) return true;
  return filled == 0 && message.size() <= shm::kDdsBoxSize;
}

std::size_t Hub::Deliver(Number number, std::int64_t now_ns, std::size_t most) {
  Member* member = Find(number);
  if (member == nullptr) return 0;
  std::size_t filled = 0;
  member->replaceable.clear();  // its entries refer to the queue's begin
  for (; most > 0 && !member->queue.empty() && member->queue.begin()->first <= now_ns; --most) {
    const Bytes& message = *member->queue.begin()->second;
    if (!Fits(message, filled)) break;
    memcpy(member->inbox() + filled, message.data(), message.size());
    TellDelivered(message, number, now_ns);
    filled += message.size();
    member->queued_bytes -= message.size();
    member->queue.erase(member->queue.begin());
  }
  member->delivered_bytes = filled;
  member->delivers = true;
  member->shown().delivers.store(1);
  member->ShowDue();
  return filled;
}

void Hub::CameBack(Number number) {
  Member* member = Find(number);
  if (member == nullptr) return;
  member->delivers = false;
  GiveBack(*member, shm::kDdsHeaderSize + shm::kDdsBoxSize, member->delivered_bytes);
  member->delivered_bytes = 0;
  member->shown().delivers.store(0);
  ShowFull(number);
}

bool Hub::IsFull(Number number) const {
  const Member* member = Find(number);
  if (member == nullptr) return number > 0 && number <= count() && members_[number - 1].full;
  return member->queued_bytes + member->delivered_bytes > kFullBytes;
}

bool Hub::IsDelivering(Number number) const {
  const Member* member = Find(number);
  return member != nullptr && member->delivers;
}

}  // namespace tcs::dds
