// The sockets that only programs of one robot, and the coordinator, can send to: UNIX datagram
// sockets with an abstract name, as long as no program of another robot has sent to a socket of
// that robot or connected to it. A thread that reads there and finds nothing need not wait until
// other robots have come as far.
//
//   bind      the coordinator is told before the kernel is: the name and the socket are the robot's
//   look      a socket that is here, and of the own robot: ClockPage::local_read_safe_ns is enough
//   send, connect to a name that is here, of another robot: the coordinator is told before
//             (NotificationKind::kReaches). The coordinator takes that robot's names and sockets
//             out of here, for good, and the sender goes on once it is as far as that robot has
//             looked.
//
// A descriptor that leaves its robot (SCM_RIGHTS, pidfd_getfd) takes out the sockets of its robot,
// too. Sockets that are not here are treated as any other descriptor: sockets bound by calls that
// the shim does not see, and sockets for which there was no room.
//
// Written by the coordinator, read by all clients at any time; behind the rest of the run's memory
// (own_receivers.h). Entries are never moved, so that a look needs no lock.
#pragma once

#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tcs::shm {

// The numbers of robots, in the order of the scenario.
inline constexpr std::uint32_t kNoRobot = 0;
inline constexpr std::uint32_t kFirstRobot = 1;

// A table of numbers other than 0, and the robot that each belongs to.
struct RobotByNumber {
  static constexpr std::uint32_t kPlaces = 8192;  // a power of two
  static constexpr std::uint32_t kMost = kPlaces / 2;
  struct Place {
    std::atomic<std::uint64_t> number;  // 0: free
    std::atomic<std::uint32_t> robot;   // kNoRobot: no robot's any more
    std::uint32_t reserved;
  };
  Place places[kPlaces];
};
static_assert(sizeof(RobotByNumber) == 131072);

// The place of the number, or the free one where it would be. Null only in a table that is full.
template <class Table>
auto* PlaceOf(Table& table, std::uint64_t number) {
  const std::uint64_t mixed = number * 0x9e3779b97f4a7c15;
  for (std::uint32_t i = 0; i < RobotByNumber::kPlaces; ++i) {
    auto& place = table.places[((mixed >> 32) + i) & (RobotByNumber::kPlaces - 1)];
    const std::uint64_t there = place.number.load(std::memory_order_acquire);
    if (there == number || there == 0) return &place;
  }
  return static_cast<decltype(&table.places[0])>(nullptr);
}

inline std::uint32_t RobotOf(const RobotByNumber& table, std::uint64_t number) {
  const RobotByNumber::Place* place = PlaceOf(table, number);
  if (place == nullptr || place->number.load(std::memory_order_acquire) == 0) return kNoRobot;
  return place->robot.load(std::memory_order_acquire);
}

struct LocalSockets {
  RobotByNumber by_cookie;  // SO_COOKIE, which the kernel gives to one socket ever
  RobotByNumber by_name;    // NumberOfName
};

// The hash of an abstract name; 0 for any other address. Names with the same hash are taken for one
// name: the sockets of two robots then belong to neither, and a send seems to reach a robot that it
// does not concern. Both mistakes are safe.
inline std::uint64_t HashOfName(const void* address, std::size_t size) {
  constexpr std::size_t kBegin = offsetof(sockaddr_un, sun_path);
  sa_family_t family = AF_UNSPEC;
  const auto* bytes = static_cast<const unsigned char*>(address);
  if (size <= kBegin || size > sizeof(sockaddr_un)) return 0;
  memcpy(&family, bytes, sizeof family);
  if (family != AF_UNIX || bytes[kBegin] != 0) return 0;
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (std::size_t i = kBegin; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3;
  return hash == 0 ? 1 : hash;
}

// The number of a name, given its hash, for a program of the robot. Where robots have names of
// their own (RunHeader::names_by_robot) a name that two of them use is two names.
inline std::uint64_t NumberOfName(std::uint64_t hash, std::uint32_t robot, bool is_by_robot) {
  if (hash == 0 || !is_by_robot) return hash;
  hash = (hash ^ robot) * 0x100000001b3;
  return hash == 0 ? 1 : hash;
}

}  // namespace tcs::shm
