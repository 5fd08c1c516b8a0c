#include "coordinator/dds/hub.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <new>
#include <utility>

namespace tcs::dds {

namespace {

using shm::DdsKind;
using shm::DdsMessage;

// What may wait for one process. Whoever lets more wait has stopped taking it.
constexpr std::size_t kMostQueuedBytes = std::size_t{256} << 20;
// Full beyond that: some milliseconds' work for who takes it. Cyclone's writers stop at half of it.
constexpr std::size_t kFullBytes = std::size_t{1} << 20;

// Who has been missed is found again that much later. Over a network that takes as long as the next
// announcement; Cyclone needs some of it to collect what it knew under the same GUID.
constexpr std::int64_t kRediscoveryNs = 100'000'000;

std::int64_t After(std::int64_t now_ns, std::int64_t ns) {
  return ns < 0 || ns > shm::kNeverNs - now_ns ? shm::kNeverNs : now_ns + ns;
}

// A writer that keeps the last ones has room for it at the cost of an earlier one. What ends an
// instance is not replaced, and does not replace.
bool IsReplaceable(const DdsMessage& header) {
  return header.kind == DdsKind::kSample && header.keep_last > 0 && header.status_info == 0 &&
         !IsAddressed(header);
}

bool IsKnownKind(DdsKind kind) {
  return kind >= DdsKind::kParticipant && kind <= DdsKind::kLiveliness;
}

}  // namespace

Hub::~Hub() {
  for (const Member& member : members_) {
    if (member.area != nullptr) munmap(member.area, shm::kDdsAreaSize);
  }
  if (fd_ >= 0) close(fd_);
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
  if (fd_ < 0) {
    fd_ = memfd_create("tcs-dds", MFD_CLOEXEC);
    if (fd_ < 0 || fchmod(fd_, 0600) != 0) return 0;
  }
  if (members_.size() == shm::kDdsMostProcesses) {
    errno = ENOSPC;
    return 0;
  }
  const auto start = static_cast<off_t>(members_.size() * shm::kDdsAreaSize);
  if (ftruncate(fd_, start + static_cast<off_t>(shm::kDdsAreaSize)) != 0) return 0;
  void* at = mmap(nullptr, shm::kDdsAreaSize, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, start);
  if (at == MAP_FAILED) return 0;
  Member& member = members_.emplace_back();
  member.area = static_cast<char*>(at);
  const Number number = count();
  auto* area = new (at) shm::DdsArea{};
  area->process = number;
  member.ShowDue();
  for (Number other = 1; other < number; ++other) {
    if (members_[other - 1].full && Find(other) != nullptr) member.ShowFull(other, true);
  }
  for (const Known& known : known_) Queue(number, now_ns, known.message);
  return number;
}

// Its number is not given again: others may still hear from it. But its memory goes back.
void Hub::Leave(Number number, std::int64_t now_ns) {
  Member* member = Find(number);
  if (member == nullptr) return;
  munmap(member->area, shm::kDdsAreaSize);
  const bool was_full = member->full, was_stopped = member->stopped;
  *member = Member{};
  // Who waits for it goes on when others miss it.
  member->full = was_full;
  fallocate(fd_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
            static_cast<off_t>((number - 1) * shm::kDdsAreaSize),
            static_cast<off_t>(shm::kDdsAreaSize));
  std::vector<Known> left;
  std::erase_if(known_, [&](const Known& known) {
    if (known.from == number) left.push_back(known);
    return known.from == number;
  });
  // If it was stopped, its leases run out as they do already.
  if (!was_stopped) EndLeases(number, left, now_ns);
}

// Nobody says so: others notice.
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

// As if it had gone and come back.
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

std::string Hub::Send(Number from, std::size_t bytes, std::int64_t now_ns) {
  const Member* member = Find(from);
  if (member == nullptr) return "it has not joined";
  if (bytes > shm::kDdsBoxSize) return "its messages are longer than its outbox";
  const char* at = member->outbox();
  const char* const end = at + bytes;
  while (at != end) {
    const std::span left{at, end};
    if (left.size() < sizeof(DdsMessage)) return "a message is cut off";
    DdsMessage header = HeaderOf(std::as_bytes(left));
    if (header.size > left.size() || header.payload_size > shm::kDdsMostPayload ||
        header.size != shm::DdsMessageSize(header.payload_size)) {
      return fmt::format("a message has a wrong size, {}", header.size);
    }
    if (!IsKnownKind(header.kind)) {
      return fmt::format("a message has an unknown kind, {}", static_cast<int>(header.kind));
    }
    header.from = from;
    header.time_ns = now_ns;
    const auto* bytes_at = reinterpret_cast<const std::byte*>(at);
    Bytes copy(bytes_at, bytes_at + header.size);
    PutHeader(header, copy);
    at += header.size;
    Enter(header, std::move(copy));
  }
  GiveBack(from, shm::kDdsHeaderSize, bytes);
  return {};
}

// Of a box of which so many bytes have been used.
void Hub::GiveBack(Number number, std::size_t box, std::size_t bytes) const {
  if (bytes <= shm::kDdsUsualSize) return;
  fallocate(fd_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
            static_cast<off_t>((number - 1) * shm::kDdsAreaSize + box + shm::kDdsUsualSize),
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

std::optional<Hub::Bytes> Hub::TakeOwn(std::int64_t now_ns) {
  if (own_.empty() || own_.begin()->first > now_ns) return std::nullopt;
  const Message message = own_.begin()->second;
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
    QueueForOthers(header.from, header.time_ns, message);
  } else {
    Queue(header.to, header.time_ns, message);
  }
}

void Hub::Remember(const DdsMessage& header, const Message& message) {
  if (header.kind != DdsKind::kParticipant && header.kind != DdsKind::kEndpoint) return;
  const Guid subject = GuidAt(header.subject);
  if ((header.flags & shm::kDdsGone) != 0) {
    std::erase_if(known_, [&](const Known& known) {
      return known.from == header.from &&
             (known.subject == subject || known.participant == subject);
    });
    return;
  }
  Known now{header.from,  header.kind,     subject, GuidAt(header.other),
            header.flags, header.lease_ns, message};
  const auto before = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
    return known.from == header.from && known.subject == subject;
  });
  if (before != known_.end()) {
    *before = std::move(now);
  } else {
    known_.push_back(std::move(now));
  }
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
    if (member->queued_bytes + message->size() > kMostQueuedBytes) {
      return Drop(header, to, drops_.lost);
    }
  }
  member->queued_bytes += message->size();
  const auto place = member->queue.emplace(due_ns, message);
  ShowFull(to);
  if (member->full) Replace(to, place);
  member->ShowDue();
}

void Hub::Drop(const DdsMessage& header, Number to, std::uint64_t& count) {
  ++count;
  if (observer_ != nullptr) observer_->Dropped(header, to);
}

// A full process has one message more; if it is of a writer that keeps the last, those are kept.
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

// In all areas, when it has changed.
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

std::size_t Hub::Deliver(Number number, std::int64_t now_ns) {
  Member* member = Find(number);
  if (member == nullptr) return 0;
  std::size_t filled = 0;
  member->replaceable.clear();  // it refers to the queue's begin
  while (!member->queue.empty() && member->queue.begin()->first <= now_ns) {
    const Bytes& message = *member->queue.begin()->second;
    const bool fits = filled + message.size() <= shm::kDdsUsualSize;
    if (!fits && (filled > 0 || message.size() > shm::kDdsBoxSize)) break;
    memcpy(member->inbox() + filled, message.data(), message.size());
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
  GiveBack(number, shm::kDdsHeaderSize + shm::kDdsBoxSize, member->delivered_bytes);
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
