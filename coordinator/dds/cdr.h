// Messages as the bytes that DDS carries (CDR with its four bytes of encapsulation), by Cyclone's
// own serialiser, without a participant.
//
// Cyclone serialises by a type's table of operations, which the code that idlc generates holds. The
// functions that interpret the table are exported by libddsc and want nothing but it: no domain, no
// threads, no configuration. A ddsi_serdata would want all of these. So the coordinator never
// becomes a DDS participant, and yet its bytes are Cyclone's, to the bit.
//
// Safe to call from any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dds/ddsc/dds_public_impl.h"

namespace tcs::dds {

struct CdrError {
  std::string message;  // the fault in the bytes, as the rest of a sentence about them
};

// The table of a generated message; specialised beside the types (ros_types.h).
template <class Message>
const dds_topic_descriptor_t& DescriptorOf();

namespace internal {

std::vector<std::byte> Serialise(const dds_topic_descriptor_t& type, const void* message);
// Into `message`, which is all zero before; the caller frees the memory that it then points to.
std::variant<std::monostate, CdrError> Deserialise(const dds_topic_descriptor_t& type,
                                                   std::span<const std::byte> cdr, void* message);
void FreeContents(const dds_topic_descriptor_t& type, void* message);

}  // namespace internal

// A generated message and the strings and sequences that it points to, which are Cyclone's to
// allocate (ros_types.h).
template <class Message>
class Owned {
 public:
  Owned() = default;
  Owned(Owned&& other) noexcept : message_(std::exchange(other.message_, Message{})) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(message_, other.message_);
    return *this;
  }
  ~Owned() { internal::FreeContents(DescriptorOf<Message>(), &message_); }

  Message& operator*() { return message_; }
  const Message& operator*() const { return message_; }
  Message* operator->() { return &message_; }
  const Message* operator->() const { return &message_; }

 private:
  Message message_{};
};

// XCDR1, little-endian, as Cyclone and ROS 2 write it.
template <class Message>
[[nodiscard]] std::vector<std::byte> ToCdr(const Owned<Message>& message) {
  return internal::Serialise(DescriptorOf<Message>(), &*message);
}

// The bytes may be any: the result is an error unless they are XCDR1 or XCDR2 in either byte order,
// of exactly this type.
template <class Message>
[[nodiscard]] std::variant<Owned<Message>, CdrError> FromCdr(std::span<const std::byte> cdr) {
  Owned<Message> message;
  auto result = internal::Deserialise(DescriptorOf<Message>(), cdr, &*message);
  if (auto* error = std::get_if<CdrError>(&result)) return std::move(*error);
  return message;
}

}  // namespace tcs::dds
