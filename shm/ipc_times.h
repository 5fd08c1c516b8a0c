// The virtual times at which System V objects were changed and used: the times that the kernel
// keeps are the host's. The table is zero at first; all clients read it and only the coordinator
// writes it. A thread notes in its slot what it has done, and the coordinator takes that over when
// the thread stops.
//
// A place belongs to an object from its first use on. The places of removed objects are used again,
// in no particular order, once all places that an object may have are taken.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tcs::shm {

enum class IpcKind : std::uint32_t { kMessages = 1, kSemaphores = 2, kMemory = 3 };

// The event that a time is of; the kernel has up to three times of each object.
enum class IpcEvent : std::uint32_t {
  kChanged = 0,  // made, or its properties set
  kPut = 1,      // a message sent, semaphores operated on, memory attached
  kTaken = 2,    // a message received, memory detached
  kRemoved = 3,  // the object is no more
};

struct IpcPlace {
  std::atomic<std::uint64_t> object;   // kind and number; 0: free
  std::atomic<std::int64_t> at_ns[3];  // by IpcEvent: CLOCK_REALTIME; 0: never
};
static_assert(sizeof(IpcPlace) == 32);

struct IpcTimes {
  static constexpr std::uint32_t kPlaces = 4096, kTried = 32;
  static constexpr std::uint64_t kRemoved = 1;
  IpcPlace places[kPlaces];
};
static_assert(sizeof(IpcTimes) == 131072);

constexpr std::uint64_t IpcObject(IpcKind kind, std::int32_t id) {
  return static_cast<std::uint64_t>(kind) << 32 | static_cast<std::uint32_t>(id);
}

// The object's place; null if it has none.
inline const IpcPlace* FindIpcPlace(const IpcTimes& times, std::uint64_t object) {
  const std::uint64_t first = object * 0x9e3779b97f4a7c15 >> 40;
  for (std::uint32_t i = 0; i < IpcTimes::kTried; ++i) {
    const IpcPlace& place = times.places[(first + i) % IpcTimes::kPlaces];
    const std::uint64_t holder = place.object.load(std::memory_order_acquire);
    if (holder == object) return &place;
    if (holder == 0) return nullptr;
  }
  return nullptr;
}

// The object's place, made if the object has none; null if there is no room.
inline IpcPlace* TakeIpcPlace(IpcTimes& times, std::uint64_t object) {
  if (const IpcPlace* place = FindIpcPlace(times, object); place != nullptr) {
    return const_cast<IpcPlace*>(place);
  }
  const std::uint64_t first = object * 0x9e3779b97f4a7c15 >> 40;
  for (std::uint32_t i = 0; i < IpcTimes::kTried; ++i) {
    IpcPlace& place = times.places[(first + i) % IpcTimes::kPlaces];
    if (place.object.load(std::memory_order_relaxed) > IpcTimes::kRemoved) continue;
    for (auto& at : place.at_ns) at.store(0, std::memory_order_relaxed);
    place.object.store(object, std::memory_order_release);
    return &place;
  }
  return nullptr;
}

}  // namespace tcs::shm
