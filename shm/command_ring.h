// Datagrams that a thread has sent to the coordinator alone (own_receivers.h), and that the
// coordinator has not taken yet. The kernel does not carry them, so that sending wakes nobody: the
// coordinator takes them when the thread has stopped, and before it reads any of its own sockets.
//
//   +--------+-------+------+-----------+------+-----------+----
//   | posted | taken | Head | bytes, 0s | Head | bytes, 0s | ...   (the ring)
//   +--------+-------+------+-----------+------+-----------+----
//
// The thread writes all but `taken`, and `posted` last. `posted` and `taken` are positions: how
// many bytes of the ring have ever been filled, and emptied. The coordinator keeps a position of
// its own, copies what it finds, and checks the copy.
//
// The functions here are async-signal-safe, take no lock and make no system call.
#pragma once

#include <string.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tcs::shm {

struct CommandRing {
  static constexpr std::uint64_t kBytes = 2032;

  struct Head {
    std::int64_t time_ns;    // the time that the thread's clock had shown
    std::int64_t ran_ns;     // how long the thread had run (RunTime)
    std::uint32_t receiver;  // the receiver's place in OwnReceivers
    std::uint32_t size;      // of the datagram, which follows; never 0
  };
  static constexpr std::uint64_t kMostSize = kBytes - sizeof(Head);  // of a datagram

  std::atomic<std::uint64_t> posted;
  std::atomic<std::uint64_t> taken;
  unsigned char bytes[kBytes];
};
static_assert(sizeof(CommandRing::Head) == 24);
static_assert(sizeof(CommandRing) == 2048);
static_assert(offsetof(CommandRing, bytes) == 16);

// The bytes of the ring that a datagram of `size` bytes takes, with its head.
constexpr std::uint64_t RoomFor(std::uint64_t size) {
  constexpr std::uint64_t kUnit = 8;
  return sizeof(CommandRing::Head) + (size + kUnit - 1) / kUnit * kUnit;
}

inline bool HasRoomFor(const CommandRing& ring, std::uint64_t size) {
  const std::uint64_t filled =
      ring.posted.load(std::memory_order_relaxed) - ring.taken.load(std::memory_order_acquire);
  return size > 0 && size <= CommandRing::kMostSize && filled <= CommandRing::kBytes &&
         RoomFor(size) <= CommandRing::kBytes - filled;
}

// `size` is at most kBytes.
inline void CopyIntoRing(CommandRing& ring, std::uint64_t position, const void* from,
                         std::size_t size) {
  const std::uint64_t place = position % CommandRing::kBytes;
  const std::size_t first = std::min<std::size_t>(size, CommandRing::kBytes - place);
  memcpy(ring.bytes + place, from, first);
  memcpy(ring.bytes, static_cast<const unsigned char*>(from) + first, size - first);
}

inline void CopyFromRing(const CommandRing& ring, std::uint64_t position, void* to,
                         std::size_t size) {
  const std::uint64_t place = position % CommandRing::kBytes;
  const std::size_t first = std::min<std::size_t>(size, CommandRing::kBytes - place);
  memcpy(to, ring.bytes + place, first);
  memcpy(static_cast<unsigned char*>(to) + first, ring.bytes, size - first);
}

// Puts a datagram into the ring, which must have room for it. `put(position)` copies its bytes
// there.
template <class Put>
void PostInto(CommandRing& ring, const CommandRing::Head& head, Put put) {
  const std::uint64_t begin = ring.posted.load(std::memory_order_relaxed);
  CopyIntoRing(ring, begin, &head, sizeof head);
  put(begin + sizeof head);
  ring.posted.store(begin + RoomFor(head.size), std::memory_order_release);
}

// The head of the datagram at `position`, where the ring is filled up to `end`. False if no
// datagram can be there; else the datagram's bytes follow the head.
inline bool ReadHead(const CommandRing& ring, std::uint64_t position, std::uint64_t end,
                     CommandRing::Head* head) {
  const std::uint64_t left = end - position;
  if (left < sizeof *head || left > CommandRing::kBytes) return false;
  CopyFromRing(ring, position, head, sizeof *head);
  std::atomic_signal_fence(std::memory_order_seq_cst);  // the values checked are not read again
  return head->size > 0 && head->size <= CommandRing::kMostSize && RoomFor(head->size) <= left;
}

}  // namespace tcs::shm
