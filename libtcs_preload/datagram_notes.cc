#include "libtcs_preload/datagram_notes.h"

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

void Note(GuestThread& thread, const void* address, socklen_t size, What what,
          std::uint32_t count) {
  const shm::ReceiverAddress of = shm::AddressOf(address, size);
  if (of.size == 0) return;
  shm::DatagramNotes::Note note = shm::NoteAbout(of.bytes, of.size);
  const shm::ClockPage& page = thread.slot->clock;
  note.time_ns = shm::ShownTime(page, shm::ReadClock(page));
  note.count = count;
  note.what = what;
  shm::DatagramNotes& notes = thread.slot->datagrams;
  // A handler that comes between overwrites one.
  const std::uint32_t place = notes.count.load(std::memory_order_relaxed);
  if (place >= shm::DatagramNotes::kMost) return;
  notes.notes[place] = note;
  notes.count.store(place + 1, std::memory_order_release);
  // Full: any stop empties it.
  if (place + 1 == shm::DatagramNotes::kMost && thread.depth == 0) {
    Exchange(thread, Request{.kind = shm::NotificationKind::kPassOn});
  }
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
  Note(thread, address, size, what, 1);
}

}  // namespace

void NoteDatagram(GuestThread& thread, int fd, const void* address, socklen_t size) {
  NoteSend(thread, fd, address, size, What::kSent);
}

void TakeBackDatagram(GuestThread& thread, int fd, const void* address, socklen_t size) {
  NoteSend(thread, fd, address, size, What::kTakenBack);
}

void NoteDatagramsReceived(GuestThread& thread, int fd, std::uint32_t count) {
  sockaddr_storage own;
  socklen_t size = sizeof own;
  if (!IsDatagramSocket(fd) || RawSyscall(SYS_getsockname, fd, Arg(&own), Arg(&size)) != 0) return;
  Note(thread, &own, size, What::kReceived, count);
}

}  // namespace tcs::preload
