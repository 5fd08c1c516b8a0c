// Devices that always have what they are asked for give all of it, however much that is and whoever
// else has a turn meanwhile: a read of them ends at no page before, as it does where the kernel has
// a signal for the thread, or the processor for somebody else.
#include <fcntl.h>
#include <sys/random.h>
#include <sys/uio.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr std::size_t kZeros = 16 << 20, kDraws = 1 << 20;

template <class Read>
void ReadsAll(const char* what, std::size_t size, int times, Read read) {
  std::vector<char> bytes(size, 1);
  for (int i = 0; i < times; ++i) {
    const ssize_t got = read(bytes.data(), size);
    EXPECT(got == static_cast<ssize_t>(size), "%s: %zd bytes of %zu in read %d", what, got, size,
           i);
  }
  const bool is_zero = std::all_of(bytes.begin(), bytes.end(), [](char c) { return c == 0; });
  EXPECT(is_zero == (size == kZeros), "%s: other bytes than the device's", what);
}

int Open(const char* name, int flags) {
  const int fd = open(name, flags | O_CLOEXEC);
  EXPECT(fd >= 0, "%s: %s", name, strerror(errno));
  return fd;
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  std::atomic<bool> ends{false};
  std::thread other([&ends] {
    while (!ends) usleep(300);
  });
  const int zero = Open("/dev/zero", O_RDONLY), urandom = Open("/dev/urandom", O_RDONLY);
  ReadsAll("/dev/zero", kZeros, 30, [=](char* to, std::size_t n) { return read(zero, to, n); });
  ReadsAll("/dev/urandom", kDraws, 20,
           [=](char* to, std::size_t n) { return read(urandom, to, n); });
  ReadsAll("getrandom", kDraws, 20, [](char* to, std::size_t n) { return getrandom(to, n, 0); });
  const int null = Open("/dev/null", O_RDWR);
  const std::vector<char> bytes(kZeros);
  EXPECT(write(null, bytes.data(), kZeros) == static_cast<ssize_t>(kZeros), "/dev/null");
  char none = 0;
  EXPECT(read(null, &none, 1) == 0, "/dev/null has something");
  ends = true;
  other.join();
}
