// What a thread notes of the datagrams that it sends and receives, in runs that are recorded
// (RunHeader::notes_datagrams): when, and at which address they are received. The coordinator makes
// of it who received what from whom, for the kernel hands datagrams of one address out in the order
// in which they were sent.
//
// Written by the thread, emptied by the coordinator when it has stopped, which trusts nothing in
// it.
#pragma once

#include <string.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tcs::shm {

struct DatagramNotes {
  static constexpr std::uint32_t kMost = 32;
  static constexpr std::size_t kMostBytes = 38;

  // A send is noted before it is made, for the receiver may be the next to run; and taken back
  // where it has failed.
  enum class What : std::uint16_t { kSent = 0, kReceived = 1, kTakenBack = 2 };

  struct Note {
    std::int64_t time_ns;  // the thread's clock
    std::uint64_t hash;    // of all bytes of the address, as AddressOf has them
    std::uint32_t count;   // of datagrams
    What what;
    std::uint16_t size;  // of what follows, which is the beginning of a long address
    unsigned char bytes[kMostBytes];
    unsigned char padding[2];
  };

  std::atomic<std::uint32_t> count;
  std::uint32_t padding;
  Note notes[kMost];
};
static_assert(sizeof(DatagramNotes::Note) == 64);
static_assert(sizeof(DatagramNotes) == 8 + 64 * DatagramNotes::kMost);

// A note about an address of so many bytes.
inline DatagramNotes::Note NoteAbout(const unsigned char* bytes, std::size_t size) {
  DatagramNotes::Note note{};
  note.hash = 0xcbf29ce484222325;  // FNV-1a
  for (std::size_t i = 0; i < size; ++i) note.hash = (note.hash ^ bytes[i]) * 0x100000001b3;
  note.size = static_cast<std::uint16_t>(std::min(size, DatagramNotes::kMostBytes));
  memcpy(note.bytes, bytes, note.size);
  return note;
}

}  // namespace tcs::shm
