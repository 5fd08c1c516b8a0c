// The notes of a thread about the datagrams that it sends and receives (RunHeader::notes_activity):
// when, and the address at which they are received. From the notes the coordinator works out who
// received what from whom, because the kernel hands out the datagrams of one address in the order
// in which they were sent.
//
// The thread writes the notes. The coordinator empties them when the thread has stopped, and trusts
// nothing in them.
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

  // A send is noted before it is made, for the receiver may be the next to run; and the note is
  // taken back where the send has failed.
  // kTaken is of DDS samples, and has no address (SamplesOf).
  enum class What : std::uint16_t { kSent = 0, kReceived = 1, kTakenBack = 2, kTaken = 3 };

  struct Note {
    std::int64_t time_ns;  // the thread's clock
    std::uint64_t hash;    // of all bytes of the address, as AddressOf has them
    std::uint16_t count;   // of datagrams
    std::uint16_t drops;   // datagrams that the kernel dropped at the receiving socket, modulo 2^16
    What what;
    std::uint16_t size;  // of the address in `bytes`, which is the beginning of a long one
    unsigned char bytes[kMostBytes];
    // Of what is received: how many receipts (receipts.h) the thread had noted by then. The last of
    // these receipts began the activation that this note belongs to.
    std::uint8_t activation;
    std::uint8_t is_last;  // 1: no more datagrams waited there, as far as the kernel says
  };

  std::atomic<std::uint32_t> count;
  std::uint32_t padding;
  Note notes[kMost];
};
static_assert(sizeof(DatagramNotes::Note) == 64);
static_assert(sizeof(DatagramNotes) == 8 + 64 * DatagramNotes::kMost);

// DDS samples that a thread has taken with one call.
struct TakenSamples {
  std::int64_t oldest_ns, newest_ns;  // source timestamps
  std::int32_t reader;                // the entity that the program has named
  std::int32_t padding;
};
static_assert(sizeof(TakenSamples) <= DatagramNotes::kMostBytes);

inline TakenSamples SamplesOf(const DatagramNotes::Note& note) {
  TakenSamples samples;
  memcpy(&samples, note.bytes, sizeof samples);
  return samples;
}

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
