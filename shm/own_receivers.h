// The addresses of datagram sockets at which only the coordinator receives: the commands that
// robots' programs send there. No program sees such a datagram, so its sender does not wait until
// no thread can read at an earlier time any more; the coordinator keeps the datagram until then.
//
// Written by the coordinator before anyone attaches, read by all clients; behind the rest of the
// run's memory (layout.h).
#pragma once

#include <netinet/in.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "shm/layout.h"
#include "shm/local_sockets.h"
#include "shm/outside_files.h"

namespace tcs::shm {

// The bytes that tell an address from others of its kind, and zeros behind them; no bytes where
// there is no receiver, or the kind of address is not known here.
struct ReceiverAddress {
  std::uint16_t size;
  unsigned char bytes[110];
};
static_assert(sizeof(ReceiverAddress) == 112);
static_assert(sizeof(sockaddr_un) <= sizeof(ReceiverAddress::bytes));

struct OwnReceivers {
  static constexpr std::uint32_t kMost = 1024;  // writes to further receivers are held
  std::uint32_t count;
  std::uint32_t reserved;
  // The network namespace that all of them are in, as SO_NETNS_COOKIE has it. From sockets of this
  // namespace the receivers take datagrams in command rings, too (command_ring.h); 0: from none.
  std::uint64_t network;
  ReceiverAddress addresses[kMost];  // in order
};
static_assert(sizeof(OwnReceivers) == 114704);

// `address` has `size` bytes.
inline ReceiverAddress AddressOf(const void* address, std::size_t size) {
  ReceiverAddress of{};
  sa_family_t family = AF_UNSPEC;
  if (size >= sizeof family) memcpy(&family, address, sizeof family);
  if (family == AF_INET && size >= sizeof(sockaddr_in)) {
    size = offsetof(sockaddr_in, sin_zero);
  } else if (family == AF_UNIX && size > offsetof(sockaddr_un, sun_path) &&
             size <= sizeof(sockaddr_un)) {
    const char* path = static_cast<const char*>(address) + offsetof(sockaddr_un, sun_path);
    // An abstract name is as long as it is said to be; a path ends with its first zero.
    if (path[0] != 0) {
      size =
          offsetof(sockaddr_un, sun_path) + strnlen(path, size - offsetof(sockaddr_un, sun_path));
    }
  } else {
    return of;
  }
  of.size = static_cast<std::uint16_t>(size);
  memcpy(of.bytes, address, size);
  return of;
}

inline bool IsBefore(const ReceiverAddress& a, const ReceiverAddress& b) {
  return memcmp(&a, &b, sizeof a) < 0;
}

inline constexpr int kNoReceiver = -1;

// The place of the receiver with the address, or kNoReceiver.
inline int PlaceAmong(const OwnReceivers& receivers, const ReceiverAddress& address) {
  if (address.size == 0) return kNoReceiver;
  const ReceiverAddress* end = receivers.addresses + std::min(receivers.count, OwnReceivers::kMost);
  const ReceiverAddress* found = std::lower_bound(receivers.addresses, end, address, IsBefore);
  if (found == end || IsBefore(address, *found)) return kNoReceiver;
  return static_cast<int>(found - receivers.addresses);
}

// A UNIX socket with a file for a name: only the kernel knows where a path leads.
inline bool HasFile(const ReceiverAddress& address) {
  sa_family_t family;
  memcpy(&family, address.bytes, sizeof family);
  return family == AF_UNIX && address.bytes[offsetof(sockaddr_un, sun_path)] != 0;
}

// The whole of the run's memory.
struct PublishedRun {
  RunMemory run;
  OwnReceivers own_receivers;
  LocalSockets local_sockets;
  OutsideFiles outside_files;
};
static_assert(offsetof(PublishedRun, own_receivers) == 131200);
static_assert(offsetof(PublishedRun, local_sockets) == 245904);
static_assert(offsetof(PublishedRun, outside_files) == 508048);

inline const LocalSockets& LocalSocketsOf(const RunMemory& run) {
  return reinterpret_cast<const PublishedRun&>(run).local_sockets;
}

inline const OutsideFiles& OutsideFilesOf(const RunMemory& run) {
  return reinterpret_cast<const PublishedRun&>(run).outside_files;
}

inline const OwnReceivers& OwnReceiversOf(const RunMemory& run) {
  return reinterpret_cast<const PublishedRun&>(run).own_receivers;
}

}  // namespace tcs::shm
