// Files by which programs meet what is outside of the run: connected sockets whose peer is outside,
// devices (GPUs, accelerators, cameras), and files that the scenario names. Data that comes by such
// a file takes real time, and is to be seen at the virtual time that this real time stands for
// (coordinator/calls/outside_waits.h).
//
// Written by the coordinator, read by all clients at any time; behind the rest of the run's memory
// (own_receivers.h). A place is free again once its file is closed.
#pragma once

#include <sys/stat.h>

#include <atomic>
#include <cstdint>

namespace tcs::shm {

// The event that the thread names in args[0] of NotificationKind::kOutside; args[1] is a
// descriptor.
enum class OutsideEvent : std::int64_t {
  kConnects = 1,  // the file has been connected, or is being connected; or it is a device, and open
                  // now; args[2]: the TSC before that; args[3]: 1: the file is still being
                  // connected
  kAsks = 2,     // the thread has sent by the file; args[2]: the TSC before that; args[3]: 1: there
                 // was something to be taken then
  kLooks = 3,    // the thread is about to look whether something is there: go on as with kRead
  kTakes = 4,    // the thread has taken what was there
  kCloses = 5,   // the thread is about to close the file
  kReturns = 6,  // an ioctl that waits for such a file is over; args[1]: -1
};

struct OutsideFiles {
  static constexpr std::uint32_t kPlaces = 128;
  struct Place {
    std::atomic<std::uint64_t> key;  // 0: free
    // The time on the robots' clock from which data that has come is to be seen; kOutsideUnknown:
    // the time is not known yet; kOutsideRests: no data is waited for, and a thread that looks
    // begins to wait; 0: at once.
    std::atomic<std::int64_t> seen_from_ns;
    // 1: a connection that is being made, which shows by that there is room to write.
    std::atomic<std::uint32_t> is_connecting;
    std::uint32_t reserved;
  };
  std::atomic<std::uint32_t> used;  // places; 0 as long as there is nothing outside
  std::uint32_t reserved;
  Place places[kPlaces];
};

inline constexpr std::int64_t kOutsideRests = INT64_MAX, kOutsideUnknown = INT64_MAX - 1;

inline constexpr std::uint64_t kOutsideSocket = std::uint64_t{1} << 63;
inline constexpr std::uint64_t kOutsideDevice = std::uint64_t{1} << 62;
inline constexpr std::uint64_t kOutsideKeyMask = kOutsideDevice - 1;

// Never 0. Every wait for such a file is for what is outside, but for sockets: a socket counts once
// the program has sent something by it.
inline std::uint64_t OutsideKeyOf(const struct stat& status) {
  if (S_ISSOCK(status.st_mode)) return kOutsideSocket | (status.st_ino & kOutsideKeyMask);
  if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) {
    return kOutsideDevice | (status.st_rdev & kOutsideKeyMask);
  }
  // Files of one device differ: neighbours often have the next number.
  const std::uint64_t mixed =
      ((status.st_dev * 0x9e3779b97f4a7c15) ^ status.st_ino) & kOutsideKeyMask;
  return mixed != 0 ? mixed : kOutsideKeyMask;
}

// The key of no file, but of what the thread waits for within a call, by its number on the host.
inline constexpr std::uint64_t kOutsideCall = kOutsideSocket | kOutsideDevice;
inline std::uint64_t OutsideCallKey(std::int32_t tid) {
  return kOutsideCall | static_cast<std::uint32_t>(tid);
}
inline bool IsOutsideCall(std::uint64_t key) { return (key & kOutsideCall) == kOutsideCall; }

// The place of the file; null: the file has none.
template <class Files>
auto* OutsidePlaceOf(Files& files, std::uint64_t key) {
  const std::uint32_t used = files.used.load(std::memory_order_acquire);
  for (std::uint32_t i = 0; i < used && i < OutsideFiles::kPlaces; ++i) {
    if (files.places[i].key.load(std::memory_order_acquire) == key) return &files.places[i];
  }
  return static_cast<decltype(&files.places[0])>(nullptr);
}

}  // namespace tcs::shm
