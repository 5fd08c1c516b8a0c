// The shim's notes of datagrams and of DDS samples (shm/datagram_notes.h).
// Async-signal-safe.
#pragma once

#include <sys/socket.h>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

inline bool NotesActivity() { return g_header->notes_activity != 0; }

// The thread is about to send a datagram on the socket; null: to the socket's peer. Other kinds of
// sockets are not noted.
void NoteDatagram(GuestThread& thread, int fd, const void* address, socklen_t size);
// The send that was noted has failed.
void TakeBackDatagram(GuestThread& thread, int fd, const void* address, socklen_t size);

// The thread has received `count` datagrams from the socket, which may be of another kind unless
// `is_datagram`.
void NoteDatagramsReceived(GuestThread& thread, int fd, std::uint32_t count,
                           bool is_datagram = false);

// The thread has taken those DDS samples.
void NoteSamplesTaken(GuestThread& thread, const shm::TakenSamples& samples);

}  // namespace tcs::preload
