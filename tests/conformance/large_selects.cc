// select beyond FD_SETSIZE: with sets of the program's own size, and with a number of descriptors
// that says more than there can be.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/syscall.h>

#include <thread>
#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kHigh = 3000, kHigher = 3100, kCount = 4000;

class Set {
 public:
  explicit Set(std::initializer_list<int> fds) {
    for (const int fd : fds) words_[fd / 64] |= 1ul << (fd % 64);
  }
  fd_set* get() { return reinterpret_cast<fd_set*>(words_.data()); }
  bool Has(int fd) const { return (words_[fd / 64] >> (fd % 64) & 1) != 0; }

 private:
  std::vector<unsigned long> words_ = std::vector<unsigned long>(kCount / 64 + 1);
};

int Move(int fd, int to) {
  EXPECT(dup2(fd, to) == to, "dup2: %s", strerror(errno));
  close(fd);
  return to;
}

template <class Select>
void Waits(const char* what, int writer, Select select) {
  char byte;
  {
    Set read{kHigh}, write{kHigh};
    const std::int64_t start = Now();
    EXPECT(select(kCount, read.get(), nullptr, 30 * kMs) == 0, "%s found something", what);
    ExpectWaited(start, 30 * kMs, 2, what);
    EXPECT(!read.Has(kHigh), "%s left what is not ready", what);
  }
  {
    Set read{kHigh};
    const std::int64_t start = Now();
    std::thread later([&] {
      usleep(20'000);
      EXPECT(write(writer, "x", 1) == 1, "%s", strerror(errno));
    });
    EXPECT(select(kCount, read.get(), nullptr, -1) == 1, "%s", what);
    const std::int64_t passed = Now() - start;
    EXPECT(read.Has(kHigh), "%s does not say which", what);
    EXPECT(passed >= 20 * kMs, "%s: %lld ns", what, (long long)passed);
    const std::int64_t most = (g_mode == Mode::kFixed ? 25 : 35) * kMs;
    if (g_mode != Mode::kNative) EXPECT(passed < most, "%s: %lld ns", what, (long long)passed);
    later.join();
  }
  {
    Set read{kHigh}, write{kHigher};
    EXPECT(select(kCount, read.get(), write.get(), -1) == 2, "%s of two", what);
    EXPECT(read.Has(kHigh) && write.Has(kHigher), "%s of two does not say which", what);
  }
  EXPECT(read(kHigh, &byte, 1) == 1, "%s", strerror(errno));
  Set nobody{kHigh + 1};
  EXPECT(select(kCount, nobody.get(), nullptr, 0) == -1 && errno == EBADF, "%s of no descriptor",
         what);
  EXPECT(nobody.Has(kHigh + 1), "%s changes the sets when it fails", what);
}

// The kernel looks at no more than the process's table of descriptors holds, and touches no more of
// the program's memory.
void MoreThanThereAre() {
  struct {
    unsigned long set[4096 / 64];  // as many as the table has grown to
    unsigned long behind[64];
  } memory{};
  for (unsigned long& word : memory.behind) word = ~0ul;
  timeval none{0, 10'000};
  const std::int64_t start = Now();
  auto* set = reinterpret_cast<fd_set*>(memory.set);
  memory.set[kHigh / 64] = 1ul << (kHigh % 64);
  EXPECT(select(1'000'000, set, nullptr, nullptr, &none) == 0, "%s", strerror(errno));
  ExpectWaited(start, 10 * kMs, 2, "select of a million");
  for (const unsigned long word : memory.behind) EXPECT(word == ~0ul, "it wrote behind the set");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur < kCount) {
    limit.rlim_cur = kCount;
    EXPECT(setrlimit(RLIMIT_NOFILE, &limit) == 0, "RLIMIT_NOFILE: %s", strerror(errno));
  }
  int ends[2];
  EXPECT(pipe(ends) == 0, "%s", strerror(errno));
  Move(ends[0], kHigh);
  const int writer = Move(ends[1], kHigher);
  Waits("select", writer, [](int n, fd_set* r, fd_set* w, std::int64_t ns) {
    timeval limit{ns / kSecond, ns % kSecond / 1000};
    return select(n, r, w, nullptr, ns < 0 ? nullptr : &limit);
  });
  Waits("pselect", writer, [](int n, fd_set* r, fd_set* w, std::int64_t ns) {
    const timespec limit = ToTimespec(ns);
    return pselect(n, r, w, nullptr, ns < 0 ? nullptr : &limit, nullptr);
  });
  Waits("raw select", writer, [](int n, fd_set* r, fd_set* w, std::int64_t ns) {
    timeval limit{ns / kSecond, ns % kSecond / 1000};
    return static_cast<int>(syscall(SYS_select, n, r, w, nullptr, ns < 0 ? nullptr : &limit));
  });
  MoreThanThereAre();
}
