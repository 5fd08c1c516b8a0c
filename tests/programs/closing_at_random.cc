// closing_at_random OPERATIONS SEED [tcs]: four threads read, each from a file of its own, and four
// others close the descriptor that one of them waits at, or give its number to another file; then
// they write to the file, or close its other end. It goes on until so many descriptors have been
// closed, copied and read. Whoever reads has to find what was written to its file, or its end, and
// nothing of another one; and once it has, the file has to be gone.
//
// Numbers change hands only while their reader is known to wait: natively by what the kernel says
// of the thread; under tcs (third argument) since 5 ms have passed, in which all can come to their
// waits.
#include <errno.h>
#include <fcntl.h>
#include <semaphore.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <random>
#include <thread>
#include <vector>

namespace {

constexpr int kLanes = 4;
constexpr long kPoison = 4096;

bool g_under_tcs = false;
std::atomic<long> g_left{0}, g_rounds{0};

template <class... Values>
[[noreturn]] void Fail(const char* format, Values... values) {
  fprintf(stderr, format, values...);
  fputc('\n', stderr);
  _exit(1);
}

void Count(long operations) { g_left.fetch_sub(operations); }

void Close(int fd) {
  Count(1);
  if (close(fd) != 0) Fail("close %d: %s", fd, strerror(errno));
}

enum class File { kPipe, kStream, kDatagram, kSequence };
enum class Call { kRead, kReadv, kRecv, kRecvmsg, kRawRead, kRawRecvfrom };
enum class Fate { kStays, kClosed, kReplaced, kUsedAgain };

struct Message {
  std::uint32_t lane, round, check;
  bool IsOf(std::uint32_t of_lane, std::uint32_t of_round) const {
    return lane == of_lane && round == of_round && check == ~round;
  }
};

// Files that get the numbers of others. Nobody reads or writes any.
class Decoys {
 public:
  Decoys() {
    for (int* pair : pairs_) {
      const bool is_pipe = pair == pairs_[0] || pair == pairs_[1];
      if ((is_pipe ? pipe(pair) : socketpair(AF_UNIX, SOCK_STREAM, 0, pair)) != 0) {
        Fail("no decoys: %s", strerror(errno));
      }
    }
    const std::vector<char> poison(kPoison, 'P');
    for (int* pair : {pairs_[1], pairs_[2]}) {
      if (write(pair[1], poison.data(), kPoison) != kPoison) Fail("no poison");
    }
  }
  int Any(std::mt19937& random) const { return pairs_[random() % 4][0]; }
  void Check() const {
    for (int i = 0; i < 4; ++i) {
      const int wanted = i == 1 || i == 2 ? kPoison : 0;
      int found = -1;
      ioctl(pairs_[i][0], FIONREAD, &found);
      if (found != wanted) Fail("%d bytes in decoy %d instead of %d", found, i, wanted);
    }
  }

 private:
  int pairs_[4][2];  // an empty pipe, a full one, a full socket, an empty one
};

struct Lane {
  std::uint32_t number = 0;
  std::atomic<pid_t> reader{0};
  int stat = -1;  // what the kernel says of it
  sem_t begins, ends;
  // Of this round:
  std::uint32_t round = 0;
  File file{};
  Fate fate{};
  int reads = -1, writes = -1;
  bool comes_to_end = false;
  std::vector<int> copies;  // of decoys
};

void Open(Lane& lane, std::mt19937& random) {
  lane.file = static_cast<File>(random() % 4);
  int ends[2];
  const int type = lane.file == File::kStream     ? SOCK_STREAM
                   : lane.file == File::kDatagram ? SOCK_DGRAM
                                                  : SOCK_SEQPACKET;
  const int made = lane.file == File::kPipe ? pipe(ends) : socketpair(AF_UNIX, type, 0, ends);
  if (made != 0) Fail("no file: %s", strerror(errno));
  lane.reads = ends[0];
  lane.writes = ends[1];
  lane.fate = static_cast<Fate>(random() % 4);
  // Datagrams have no end.
  lane.comes_to_end = lane.file != File::kDatagram && random() % 4 == 0;
}

long Read(Call call, int fd, Message* message) {
  iovec halves[] = {{message, 4}, {reinterpret_cast<char*>(message) + 4, sizeof *message - 4}};
  msghdr header{};
  header.msg_iov = halves;
  header.msg_iovlen = 2;
  switch (call) {
    case Call::kRead:
      return read(fd, message, sizeof *message);
    case Call::kReadv:
      return readv(fd, halves, 2);
    case Call::kRecv:
      return recv(fd, message, sizeof *message, 0);
    case Call::kRecvmsg:
      return recvmsg(fd, &header, 0);
    case Call::kRawRead:
      return syscall(SYS_read, fd, message, sizeof *message);
    case Call::kRawRecvfrom:
      return syscall(SYS_recvfrom, fd, message, sizeof *message, 0, nullptr, nullptr);
  }
  return -1;
}

void BeReader(Lane& lane, unsigned seed) {
  std::mt19937 random(seed);
  char path[64];
  snprintf(path, sizeof path, "/proc/self/task/%d/stat", static_cast<int>(gettid()));
  lane.stat = open(path, O_RDONLY | O_CLOEXEC);
  while (g_left > 0) {
    ++lane.round;
    Open(lane, random);
    const bool is_pipe = lane.file == File::kPipe;
    constexpr Call kOfPipes[] = {Call::kRead, Call::kReadv, Call::kRawRead};
    const Call call = is_pipe ? kOfPipes[random() % 3] : static_cast<Call>(random() % 6);
    Message message{};
    lane.reader = gettid();
    sem_post(&lane.begins);
    const long got = Read(call, lane.reads, &message);
    Count(1);
    const int error = errno;
    lane.reader = 0;
    sem_wait(&lane.ends);
    const char* what = lane.comes_to_end ? "the end" : "a message";
    if (got != (lane.comes_to_end ? 0 : static_cast<long>(sizeof message))) {
      Fail("lane %u, round %u, call %d, file %d, fate %d: %ld (%s) instead of %s", lane.number,
           lane.round, static_cast<int>(call), static_cast<int>(lane.file),
           static_cast<int>(lane.fate), got, strerror(error), what);
    }
    if (got > 0 && !message.IsOf(lane.number, lane.round)) {
      Fail("lane %u, round %u, call %d, file %d, fate %d: bytes of another file", lane.number,
           lane.round, static_cast<int>(call), static_cast<int>(lane.file),
           static_cast<int>(lane.fate));
    }
    if (lane.fate == Fate::kStays || lane.fate == Fate::kReplaced) Close(lane.reads);
    if (!lane.comes_to_end) {
      // Nobody has its other end any more.
      const ssize_t n = write(lane.writes, "x", 1);
      if (n != -1 || (errno != EPIPE && errno != ECONNREFUSED && errno != ECONNRESET)) {
        Fail("lane %u, round %u, file %d, fate %d: still open: %zd (%s)", lane.number, lane.round,
             static_cast<int>(lane.file), static_cast<int>(lane.fate), n, strerror(errno));
      }
      Close(lane.writes);
    }
    for (const int copy : lane.copies) Close(copy);
    lane.copies.clear();
    ++g_rounds;
  }
  lane.round = 0;  // that was all
  sem_post(&lane.begins);
}

bool Sleeps(const Lane& lane) {
  char line[256];
  const ssize_t n = pread(lane.stat, line, sizeof line - 1, 0);
  line[n > 0 ? n : 0] = '\0';
  const char* name_end = strrchr(line, ')');
  return name_end != nullptr && strncmp(name_end, ") S", 3) == 0;
}

void AwaitReader(const Lane& lane) {
  if (g_under_tcs) {
    usleep(5000);
    return;
  }
  while (lane.reader == 0 || !Sleeps(lane)) usleep(10);
}

void BeCloser(Lane& lane, unsigned seed, const Decoys& decoys) {
  std::mt19937 random(seed);
  for (;;) {
    sem_wait(&lane.begins);
    if (lane.round == 0) return;
    AwaitReader(lane);
    if (lane.fate == Fate::kClosed || lane.fate == Fate::kUsedAgain) Close(lane.reads);
    if (lane.fate == Fate::kReplaced) {
      Count(1);
      if (dup2(decoys.Any(random), lane.reads) != lane.reads) Fail("dup2: %s", strerror(errno));
    }
    for (unsigned more = lane.fate == Fate::kUsedAgain ? 1 + random() % 3 : 0; more > 0; --more) {
      Count(1);
      lane.copies.push_back(dup(decoys.Any(random)));
      if (lane.copies.back() < 0) Fail("dup: %s", strerror(errno));
    }
    if (random() % 8 == 0) usleep(100);
    if (lane.comes_to_end) {
      Close(lane.writes);
    } else {
      const Message message{lane.number, lane.round, ~lane.round};
      const ssize_t n = write(lane.writes, &message, sizeof message);
      if (n != sizeof message) Fail("write: %zd (%s)", n, strerror(errno));
    }
    sem_post(&lane.ends);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  g_left = atol(argv[1]);
  g_under_tcs = argc > 3;
  const auto seed = static_cast<unsigned>(atol(argv[2]));
  signal(SIGPIPE, SIG_IGN);
  const Decoys decoys;
  static Lane lanes[kLanes];
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < kLanes; ++i) {
    lanes[i].number = i + 1;
    sem_init(&lanes[i].begins, 0, 0);
    sem_init(&lanes[i].ends, 0, 0);
    threads.emplace_back(BeReader, std::ref(lanes[i]), seed + 2 * i);
    threads.emplace_back(BeCloser, std::ref(lanes[i]), seed + 2 * i + 1, std::cref(decoys));
  }
  for (std::thread& thread : threads) thread.join();
  decoys.Check();
  printf("%ld rounds, %ld operations\n", g_rounds.load(), atol(argv[1]) - g_left.load());
}
