// What the shim notes of datagrams and of DDS samples (shm/datagram_notes.h).
// Async-signal-safe.
#pragma once

#include <sys/socket.h>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

inline bool NotesActivity() { return g_header->notes_activity != 0; }

// The thread is about to send one on the socket; null: to its peer. Not of other kinds of sockets.
void NoteDatagram(GuestThread& thread, int fd, const void* address, socklen_t size);
// That has failed.
void TakeBackDatagram(GuestThread& thread, int fd, const void* address, socklen_t size);

// It has received so many from the socket, which may be of another kind unless `is_datagram`.
void NoteDatagramsReceived(GuestThread& thread, int fd, std::uint32_t count,
                           bool is_datagram = false);

// It has taken those DDS samples.
void NoteSamplesTaken(GuestThread& thread, const shm::TakenSamples& samples);

}  // namespace tcs::preload
