#include "coordinator/dds/hub.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

namespace tcs::dds {

namespace {

using shm::DdsKind;
using shm::DdsMessage;

// What may wait for one process. Whoever lets more wait has stopped taking it.
constexpr std::size_t kMostQueuedBytes = std::size_t{256} << 20;
// Some milliseconds' work for who takes it. Cyclone's writers stop at half of that.
constexpr std::size_t kFullBytes = std::size_t{1} << 20;

std::int64_t After(std::int64_t now_ns, std::int64_t ns) {
  return ns < 0 || ns > shm::kNeverNs - now_ns ? shm::kNeverNs : now_ns + ns;
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
  for (const Known& known : known_) Queue(number, now_ns, known.message);
  return number;
}

// Its number is not given again: others may still hear from it. But its memory goes back.
void Hub::Leave(Number number, std::int64_t now_ns) {
  Member* member = Find(number);
  if (member == nullptr) return;
  munmap(member->area, shm::kDdsAreaSize);
  *member = Member{};
  fallocate(fd_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
            static_cast<off_t>((number - 1) * shm::kDdsAreaSize),
            static_cast<off_t>(shm::kDdsAreaSize));
  std::vector<Known> left;
  std::erase_if(known_, [&](const Known& known) {
    if (known.from == number) left.push_back(known);
    return known.from == number;
  });
  // Nobody has said so: others notice when the leases are over.
  for (const Known& known : left) {
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
    memcpy(bytes.data(), &header, sizeof header);
    QueueForOthers(number, due, std::make_shared<const Bytes>(std::move(bytes)));
  }
}

std::string Hub::Send(Number from, std::size_t bytes, std::int64_t now_ns) {
  const Member* member = Find(from);
  if (member == nullptr) return "it has not joined";
  if (bytes > shm::kDdsBoxSize) return "its messages are longer than its outbox";
  member->shown().full.store(0);
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
    memcpy(copy.data(), &header, sizeof header);
    at += header.size;
    Enter(header, std::move(copy));
  }
  return {};
}

void Hub::SendOwn(DdsMessage header, std::span<const std::byte> payload, std::int64_t due_ns) {
  header.payload_size = static_cast<std::uint32_t>(payload.size());
  header.size = shm::DdsMessageSize(header.payload_size);
  header.from = shm::kDdsCoordinator;
  header.time_ns = due_ns;
  Bytes bytes(header.size);
  memcpy(bytes.data(), &header, sizeof header);
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
  if (header.kind == DdsKind::kSample &&
      member->queued_bytes + message->size() > kMostQueuedBytes) {
    ++dropped_;
    if (observer_ != nullptr) observer_->Dropped(header, to);
    return;
  }
  member->queued_bytes += message->size();
  member->queue.emplace(due_ns, message);
  if (header.kind == DdsKind::kSample && IsFull(to)) {
    if (const Member* sender = Find(header.from)) sender->shown().full.store(to);
  }
  member->ShowDue();
}

std::int64_t Hub::DueNs(Number number) const {
  const Member* member = Find(number);
  return member == nullptr || member->queue.empty() ? shm::kNeverNs : member->queue.begin()->first;
}

std::size_t Hub::Deliver(Number number, std::int64_t now_ns) {
  Member* member = Find(number);
  if (member == nullptr) return 0;
  std::size_t filled = 0;
  while (!member->queue.empty() && member->queue.begin()->first <= now_ns) {
    const Bytes& message = *member->queue.begin()->second;
    if (filled + message.size() > shm::kDdsBoxSize) break;
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
  member->delivered_bytes = 0;
  member->shown().delivers.store(0);
}

bool Hub::IsFull(Number number) const {
  const Member* member = Find(number);
  return member != nullptr && member->queued_bytes + member->delivered_bytes > kFullBytes;
}

bool Hub::IsDelivering(Number number) const {
  const Member* member = Find(number);
  return member != nullptr && member->delivers;
}

}  // namespace tcs::dds
