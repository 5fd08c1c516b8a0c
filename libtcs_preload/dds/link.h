// The functions of the shim for the part that knows Cyclone DDS (libtcs_dds.so), which the shim
// loads when a program creates its first participant. The part has nothing else of the shim's.
#pragma once

#include <sys/uio.h>

#include <cstddef>
#include <cstdint>

#include "shm/datagram_notes.h"

namespace tcs::dds {

struct Link {
  // The process's number (shm/dds_exchange.h), after the process has been given its area. Once per
  // process; 0: not under tcs, or there is no room for the process.
  std::uint32_t (*join)();

  // Sends one whole message, its DdsMessage header first. The message has been sent, at the calling
  // thread's virtual time, when this returns; more urgent threads that the message wakes have run
  // by then. No two threads may send at the same time. False: the message is larger than the
  // outbox, and was not sent.
  bool (*send)(const iovec* parts, int count);

  // Whether any process is full (shm/dds_exchange.h), which costs next to nothing to ask, and
  // whether that process is.
  bool (*any_is_full)();
  bool (*is_full)(std::uint32_t process);
  // Waits until that process is not full, or has left, or it is `until_ns`. Not for the deliverer.
  // False: the run is over.
  bool (*await_room)(std::uint32_t process, std::int64_t until_ns);

  // For the deliverer, a thread that makes itself known by calling this first: waits until messages
  // are due. The messages stand one after another at `*messages`, until the next call. Returns
  // their bytes together; 0: the run is over, and the thread has to end.
  std::size_t (*wait)(const std::byte** messages);

  // Before the calling thread looks at what has come: returns once all that was sent before its
  // own time is in Cyclone's hands. Nothing for the deliverer. Not with a lock that the deliverer
  // or its listeners need.
  void (*sync)();

  // As sync, for messages that are due by now: does not wait for messages that others may still
  // send for an earlier time.
  void (*settle)();

  // The calling thread has taken these samples, which may be the beginning of an activation.
  void (*taken)(const shm::TakenSamples& samples);

  // How much earlier than others of its process, on other cores, the calling thread may be at most.
  std::int64_t (*behind_ns)();

  // The calling thread's virtual time, ns since the run's start.
  std::int64_t (*now)();

  // dlsym, which leads programs that look up libddsc's functions to the shim's.
  void* (*look_up)(void* library, const char* name);
};

// A function of libddsc (calls.h) that libtcs_dds.so does otherwise. A table of hooks ends with
// nulls.
struct Hook {
  const char* name;
  void* function;
};

// The function that libtcs_dds.so exports: called once per process, before anything else of the
// library. Null and one line on stderr if the library cannot work here (another version of
// Cyclone): the program then uses sockets. Null and no line outside tcs.
inline constexpr char kStartSymbol[] = "tcs_dds_start";
using Start = const Hook* (*)(const Link& link);

}  // namespace tcs::dds
