#include "libtcs_preload/datagram_notes.h"

#include <linux/sock_diag.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "shm/clock_page.h"
#include "shm/own_receivers.h"

namespace tcs::preload {

namespace {

using What = shm::DatagramNotes::What;

bool IsDatagramSocket(int fd) {
  int type = 0;
  socklen_t size = sizeof type;
  return RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_TYPE, Arg(&type), Arg(&size)) == 0 &&
         type == SOCK_DGRAM;
}

void Add(GuestThread& thread, shm::DatagramNotes::Note note) {
  const shm::ClockPage& page = thread.slot->clock;
  note.time_ns = shm::ShownTime(page, shm::ReadClock(page));
  note.activation =
      static_cast<std::uint8_t>(thread.slot->receipts.count.load(std::memory_order_relaxed));
  shm::DatagramNotes& notes = thread.slot->datagrams;
  // A handler that comes between overwrites a note.
  const std::uint32_t place = notes.count.load(std::memory_order_relaxed);
  if (place >= shm::DatagramNotes::kMost) return;
  notes.notes[place] = note;
  notes.count.store(place + 1, std::memory_order_release);
  // The list is full: any stop empties it.
  if (place + 1 == shm::DatagramNotes::kMost && thread.depth == 0) {
    Exchange(thread, Request{.kind = shm::NotificationKind::kPassOn});
  }
}

// A note of size 0 has no address that counts.
shm::DatagramNotes::Note NoteOf(const void* address, socklen_t size, What what) {
  const shm::ReceiverAddress of = shm::AddressOf(address, size);
  shm::DatagramNotes::Note note = shm::NoteAbout(of.bytes, of.size);
  note.what = what;
  note.count = 1;
  return note;
}

// Notes how many datagrams the kernel has dropped because the socket was full, and whether more
// wait.
void AddMemory(int fd, shm::DatagramNotes::Note* note) {
  std::uint32_t info[SK_MEMINFO_VARS] = {};
  socklen_t size = sizeof info;
  if (RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_MEMINFO, Arg(info), Arg(&size)) != 0) return;
  note->drops = static_cast<std::uint16_t>(info[SK_MEMINFO_DROPS]);
  note->is_last = info[SK_MEMINFO_RMEM_ALLOC] == 0 ? 1 : 0;
}

void NoteSend(GuestThread& thread, int fd, const void* address, socklen_t size, What what) {
  if (!IsDatagramSocket(fd)) return;
  sockaddr_storage peer;
  if (address == nullptr) {
    size = sizeof peer;
    if (RawSyscall(SYS_getpeername, fd, Arg(&peer), Arg(&size)) != 0) return;
    address = &peer;
  } else if (size > sizeof peer || !CanRead(address, size)) {
    return;
  }
  const shm::DatagramNotes::Note note = NoteOf(address, size, what);
  if (note.size > 0) Add(thread, note);
}

}  // namespace

void NoteDatagram(GuestThread& thread, int fd, const void* address, socklen_t size) {
  NoteSend(thread, fd, address, size, What::kSent);
}

void NoteSamplesTaken(GuestThread& thread, const shm::TakenSamples& samples) {
  shm::DatagramNotes::Note note{};
  note.what = What::kTaken;
  note.size = sizeof samples;
  memcpy(note.bytes, &samples, sizeof samples);
  Add(thread, note);
}

void TakeBackDatagram(GuestThread& thread, int fd, const void* address, socklen_t size) {
  NoteSend(thread, fd, address, size, What::kTakenBack);
}

void NoteDatagramsReceived(GuestThread& thread, int fd, std::uint32_t count, bool is_datagram) {
  sockaddr_storage own;
  socklen_t size = sizeof own;
  if (!is_datagram && !IsDatagramSocket(fd)) return;
  if (RawSyscall(SYS_getsockname, fd, Arg(&own), Arg(&size)) != 0) return;
  shm::DatagramNotes::Note note = NoteOf(&own, size, What::kReceived);
  if (note.size == 0) return;
  note.count = static_cast<std::uint16_t>(count);
  AddMemory(fd, &note);
  Add(thread, note);
}

}  // namespace tcs::preload
