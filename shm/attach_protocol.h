// How a process comes to its slot: one exchange over a SOCK_SEQPACKET socket with an abstract name,
// which the environment variable TCS_SOCKET carries (without the leading NUL). The shim sends
// AttachHello; the coordinator answers AttachReply, with the descriptors that were asked for. The
// thread is then stopped at its gate until its first dispatch; but not where it asked for its area
// of DDS only.
#pragma once

#include <cstdint>

#include "shm/layout.h"

namespace tcs::shm {

inline constexpr char kSocketVariable[] = "TCS_SOCKET";
// Files that programs find under another name, a line each: the file, a space, the name.
inline constexpr char kAliasesVariable[] = "TCS_ALIASES";

enum class AttachWants : std::uint32_t {
  kSlot = 0,  // of a further thread
  // A slot, and three descriptors: the run's memory, which cannot be written; the process's; and
  // the write end of the pipe for its notifications. Where processes have brokers a fourth: the
  // socket that its broker answers at.
  kAll = 1,
  kDdsArea = 2,  // the descriptor of its area (dds_exchange.h), for a process that has joined
};

struct AttachHello {
  std::uint64_t magic;
  std::uint32_t version;
  std::int32_t pid;
  std::int32_t tid;
  std::int32_t parent_pid;
  AttachWants wants;
  std::uint32_t reserved;
  // The word of the C library's that the kernel clears when this thread has ended, and where it
  // then wakes a thread that joins; 0: the kernel does not tell.
  std::uint64_t end_word;
};
static_assert(sizeof(AttachHello) == 40);

inline constexpr int kMostAttachFds = 4;

struct AttachReply {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t slot;     // index
  std::uint32_t refused;  // 1: no slot; text says why
  char text[108];
};
static_assert(sizeof(AttachReply) == 128);

// The message that a notification puts into the process's pipe: the index of the slot whose record
// is filled.
struct PipeMessage {
  std::uint32_t slot;
  // 1: the thread tells that a handler ends its wait (kInterrupted). Should its gate have been
  // opened before this is read, the thread has gone on, and the record may be of anything by now.
  std::uint32_t ends_wait;
};
static_assert(sizeof(PipeMessage) == 8);

// Where the kernel lets the coordinator copy no descriptors of clients (RunHeader::has_brokers)
// each process has a broker: a process beside it that shares its table of descriptors, and sends
// the coordinator copies of the descriptors that it asks for. The broker sends one answer for each
// request, over a SOCK_SEQPACKET socket, with the copy beside it. The broker's first message is an
// answer with the serial 0: the kernel says which process sent it, and that is the broker.
struct BrokerRequest {
  std::int32_t number;
  std::uint32_t serial;  // never 0
};
static_assert(sizeof(BrokerRequest) == 8);

struct BrokerAnswer {
  std::int32_t error;  // an errno; 0: the copy has come with the answer
  std::uint32_t serial;
};
static_assert(sizeof(BrokerAnswer) == 8);

}  // namespace tcs::shm
