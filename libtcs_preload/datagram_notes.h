// What the shim notes of datagrams in runs that are recorded (shm/datagram_notes.h).
// Async-signal-safe.
#pragma once

#include <sys/socket.h>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

inline bool NotesDatagrams() { return g_header->notes_datagrams != 0; }

// The thread is about to send one on the socket; null: to its peer. Not of other kinds of sockets.
void NoteDatagram(GuestThread& thread, int fd, const void* address, socklen_t size);
// That has failed.
void TakeBackDatagram(GuestThread& thread, int fd, const void* address, socklen_t size);

// It has received so many from the socket.
void NoteDatagramsReceived(GuestThread& thread, int fd, std::uint32_t count);

}  // namespace tcs::preload
