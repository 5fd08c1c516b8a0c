#include "tests/dds/support/peer.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "tests/dds/support/events.h"

namespace dds_test {

namespace {
constexpr std::size_t kStepSize = 32;
}

void Peer::Reached(const char* step) {
  char name[kStepSize] = {};
  if (strlen(step) >= sizeof name) Fail("the step's name '%s' is too long", step);
  strcpy(name, step);
  Write(name, sizeof name);
}

void Peer::Await(const char* step) {
  char name[kStepSize];
  Read(name, sizeof name);
  if (strncmp(name, step, sizeof name) != 0) Fail("waited for '%s', heard '%.32s'", step, name);
}

void Peer::Write(const void* bytes, std::size_t size) {
  // A datagram's worth: the kernel takes it whole.
  if (write(socket_, bytes, size) != static_cast<ssize_t>(size))
    Fail("the other process cannot be told: %s", strerror(errno));
}

void Peer::Read(void* bytes, std::size_t size) {
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got = read(socket_, static_cast<char*>(bytes) + have, size - have);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) Fail("the other process has gone");
    have += static_cast<std::size_t>(got);
  }
}

}  // namespace dds_test
