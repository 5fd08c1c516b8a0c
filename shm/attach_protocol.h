// How a process comes to its slot: one exchange over a SOCK_SEQPACKET socket with an abstract name,
// which the environment variable TCS_SOCKET carries (without the leading NUL). The shim sends
// AttachHello; the coordinator answers AttachReply, with two descriptors: the segment's memfd and
// the write end of the notification pipe. The thread is then stopped at its gate until its first
// dispatch.
#pragma once

#include <cstdint>

#include "shm/layout.h"

namespace tcs::shm {

inline constexpr char kSocketVariable[] = "TCS_SOCKET";

struct AttachHello {
  std::uint64_t magic;
  std::uint32_t version;
  std::int32_t pid;
  std::int32_t tid;
  std::int32_t parent_pid;
};
static_assert(sizeof(AttachHello) == 24);

struct AttachReply {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t slot;     // index
  std::uint32_t refused;  // 1: no slot; text says why
  char text[108];
};
static_assert(sizeof(AttachReply) == 128);

// What a notification puts into the pipe: the index of the slot whose record is filled.
struct PipeMessage {
  std::uint32_t slot;
};
static_assert(sizeof(PipeMessage) == 4);

}  // namespace tcs::shm
