#include "libtcs_preload/dds/held_messages.h"

#include <algorithm>

namespace tcs::dds {
namespace {

bool IsLost(const shm::DdsMessage& message) {
  return message.kind == shm::DdsKind::kLiveliness ||
         (message.kind == shm::DdsKind::kSample && (message.flags & shm::kDdsUnreliable) != 0);
}

bool IsReplaced(const shm::DdsMessage& earlier, const shm::DdsMessage& later) {
  return earlier.kind == shm::DdsKind::kSample && earlier.status_info == 0 &&
         earlier.instance == later.instance && earlier.to == later.to &&
         GuidAt(earlier.subject) == GuidAt(later.subject) &&
         GuidAt(earlier.other) == GuidAt(later.other);
}

}  // namespace

void HeldMessages::Add(const shm::DdsMessage& message, const void* payload, std::size_t size) {
  if (IsLost(message)) return;
  MakeRoom(message);
  const auto* bytes = static_cast<const std::byte*>(payload);
  all_.push_back({message, Payload(bytes, bytes + size)});
}

void HeldMessages::MakeRoom(const shm::DdsMessage& message) {
  if (message.kind != shm::DdsKind::kSample || message.keep_last == 0 || message.status_info != 0) {
    return;
  }
  const auto is_replaced = [&](const HeldMessage& one) { return IsReplaced(one.message, message); };
  if (std::ranges::count_if(all_, is_replaced) < std::int64_t{message.keep_last}) return;
  all_.erase(std::ranges::find_if(all_, is_replaced));
}

std::size_t HeldMessages::SizeOf(const Guid& writer) const {
  std::size_t size = 0;
  for (const HeldMessage& one : all_) {
    if (one.message.kind == shm::DdsKind::kSample && GuidAt(one.message.subject) == writer) {
      size += one.payload.size();
    }
  }
  return size;
}

}  // namespace tcs::dds
