// closing_at_random OPERATIONS SEED [tcs]: four threads read, each from a file of its own, and four
// others close the descriptor that one of them waits at, or give its number to another file; then
// they write to the file, or close its other end. It goes on until so many descriptors have been
// closed, copied and read. Whoever reads has to find what was written to its file, or its end, and
// nothing of another one; and once it has, the file has to be gone. Who polls is woken by its file,
// and is told of what has the number by then.
//
// Numbers change hands only while their reader is known to wait: natively by what the kernel says
// of the thread; under tcs (third argument) since 50 ms have passed, in which all can come to their
// waits, also where a busy host has some of its time charged to them.
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <semaphore.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <random>
#include <thread>
#include <utility>
#include <vector>

namespace {

constexpr int kLanes = 4;
constexpr long kPoison = 4096;
// For a poll that nothing ends, or nobody knows what: under tcs longer than a closer takes.
constexpr int kPollMs = 500, kPollMsNatively = 50;

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

enum class File { kPipe, kEvent, kStream, kDatagram, kSequence, kTcp, kUdp };
// The first four are for all files, the others for sockets.
enum class Call { kRead, kReadv, kRawRead, kPoll, kRecv, kRecvmsg, kRecvmmsg, kRawRecvfrom };
enum class Fate { kStays, kClosed, kReplaced, kUsedAgain };

// Eight bytes, as an eventfd counts: what is written to it is found in it.
struct Message {
  std::uint32_t round, lane_and_check;
  static Message Of(std::uint32_t lane, std::uint32_t round) {
    return {round, lane << 28 | (~round & 0xfffffff)};
  }
  bool operator==(const Message&) const = default;
};
static_assert(sizeof(Message) == 8);

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
  bool IsFull(int decoy) const { return decoy == pairs_[1][0] || decoy == pairs_[2][0]; }
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
  int stat = -1;  // what the kernel says of it
  sem_t begins, ends;
  // Of this round:
  std::uint32_t round = 0;
  File file{};
  Call call{};
  Fate fate{};
  int reads = -1, writes = -1;
  bool comes_to_end = false;
  int decoy = -1;  // that it is replaced by
  bool has_full_decoy = false;
  std::vector<int> copies;  // of decoys

  template <class... Values>
  [[noreturn]] void Fails(const char* format, Values... values) const {
    fprintf(stderr, "lane %u, round %u, call %d, file %d, fate %d, comes to its end %d: ", number,
            round, static_cast<int>(call), static_cast<int>(file), static_cast<int>(fate),
            comes_to_end);
    Fail(format, values...);
  }
};

bool IsSocket(File file) { return file != File::kPipe && file != File::kEvent; }

bool HasEnd(File file) {
  return file == File::kPipe || file == File::kStream || file == File::kSequence ||
         file == File::kTcp;
}

// One end of a connection over loopback, and the other.
bool Connect(int type, int (&ends)[2]) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const raw = reinterpret_cast<sockaddr*>(&address);
  ends[0] = socket(AF_INET, type, 0);
  ends[1] = socket(AF_INET, type, 0);
  if (ends[0] < 0 || ends[1] < 0) return false;
  if (bind(ends[0], raw, size) != 0 || getsockname(ends[0], raw, &size) != 0) return false;
  if (type == SOCK_STREAM && listen(ends[0], 1) != 0) return false;
  if (connect(ends[1], raw, size) != 0) return false;
  if (type != SOCK_STREAM) return true;
  const int listener = std::exchange(ends[0], accept(ends[0], nullptr, nullptr));
  close(listener);
  return ends[0] >= 0;
}

bool Make(File file, int (&ends)[2]) {
  switch (file) {
    case File::kPipe:
      return pipe(ends) == 0;
    case File::kEvent:
      ends[0] = eventfd(0, 0);
      return ends[0] >= 0 && (ends[1] = dup(ends[0])) >= 0;
    case File::kStream:
      return socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0;
    case File::kDatagram:
      return socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) == 0;
    case File::kSequence:
      return socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) == 0;
    case File::kTcp:
      return Connect(SOCK_STREAM, ends);
    case File::kUdp:
      return Connect(SOCK_DGRAM, ends);
  }
  return false;
}

void Open(Lane& lane, std::mt19937& random, const Decoys& decoys) {
  // What goes over IP takes longer, and is rarer.
  constexpr File kFiles[] = {File::kPipe,     File::kPipe,     File::kEvent,    File::kEvent,
                             File::kStream,   File::kStream,   File::kDatagram, File::kDatagram,
                             File::kSequence, File::kSequence, File::kTcp,      File::kUdp};
  lane.file = kFiles[random() % 12];
  int ends[2];
  if (!Make(lane.file, ends)) lane.Fails("no file: %s", strerror(errno));
  lane.reads = ends[0];
  lane.writes = ends[1];
  lane.fate = static_cast<Fate>(random() % 4);
  lane.call = static_cast<Call>(random() % (IsSocket(lane.file) ? 8 : 4));
  // A read of an eventfd in pieces gets only the first.
  if (lane.file == File::kEvent && lane.call == Call::kReadv) lane.call = Call::kRead;
  lane.comes_to_end = HasEnd(lane.file) && random() % 4 == 0;
  lane.decoy = decoys.Any(random);
  lane.has_full_decoy = decoys.IsFull(lane.decoy);
}

// Milliseconds, -1: no end; a poll that is woken, and finds what it is to find, needs none.
int PollTime(const Lane& lane) {
  const bool finds_decoy = lane.fate == Fate::kReplaced && lane.has_full_decoy;
  return lane.fate == Fate::kStays || finds_decoy ? -1 : g_under_tcs ? kPollMs : kPollMsNatively;
}

long Read(Call call, int fd, Message* message, int poll_time = 0) {
  iovec halves[] = {{&message->round, 4}, {&message->lane_and_check, 4}};
  mmsghdr header{};
  header.msg_hdr.msg_iov = halves;
  header.msg_hdr.msg_iovlen = 2;
  pollfd entry{fd, POLLIN, 0};
  long got = 0;
  switch (call) {
    case Call::kRead:
      return read(fd, message, sizeof *message);
    case Call::kReadv:
      return readv(fd, halves, 2);
    case Call::kRawRead:
      return syscall(SYS_read, fd, message, sizeof *message);
    case Call::kPoll:
      return poll(&entry, 1, poll_time) == 1 ? entry.revents : 0;
    case Call::kRecv:
      return recv(fd, message, sizeof *message, 0);
    case Call::kRecvmsg:
      return recvmsg(fd, &header.msg_hdr, 0);
    case Call::kRecvmmsg:
      got = recvmmsg(fd, &header, 1, 0, nullptr);
      return got == 1 ? header.msg_len : got;
    case Call::kRawRecvfrom:
      return syscall(SYS_recvfrom, fd, message, sizeof *message, 0, nullptr, nullptr);
  }
  return -1;
}

// A poll has said `events`. The number of a closed file may be anybody's by now.
void CheckPoll(const Lane& lane, long events) {
  if (lane.fate == Fate::kReplaced && events != (lane.has_full_decoy ? POLLIN : 0)) {
    lane.Fails("%lx where a decoy that is %s has the number", events,
               lane.has_full_decoy ? "full" : "empty");
  }
  if (lane.fate == Fate::kStays && (events & (POLLIN | POLLHUP)) == 0) {
    lane.Fails("%lx of what has come", events);
  }
}

void CheckRead(const Lane& lane, long got, int error, const Message& message) {
  if (got != (lane.comes_to_end ? 0 : static_cast<long>(sizeof message))) {
    lane.Fails("%ld (%s)", got, strerror(error));
  }
  if (got > 0 && message != Message::Of(lane.number, lane.round)) {
    lane.Fails("bytes of another file");
  }
}

// Closes the end that was written to. Thousands of connections would leave their ports in
// TIME_WAIT, but for those whose reader has closed first.
void CloseWriter(const Lane& lane) {
  const linger at_once{1, 0};
  if (lane.file == File::kTcp && !lane.comes_to_end) {
    setsockopt(lane.writes, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  }
  Close(lane.writes);
}

// Nobody has the file's other end any more.
void CheckGone(const Lane& lane) {
  if (!HasEnd(lane.file) && lane.file != File::kDatagram) return;
  if (lane.file == File::kTcp) {
    pollfd entry{lane.writes, POLLRDHUP, 0};
    if (poll(&entry, 1, 1000) != 1) lane.Fails("still open");
    return;
  }
  const ssize_t n = write(lane.writes, "x", 1);
  if (n != -1 ||
      (errno != EPIPE && errno != ECONNREFUSED && errno != ECONNRESET && errno != ENOTCONN)) {
    lane.Fails("still open: %zd (%s)", n, strerror(errno));
  }
}

void BeReader(Lane& lane, unsigned seed, const Decoys& decoys) {
  std::mt19937 random(seed);
  char path[64];
  snprintf(path, sizeof path, "/proc/self/task/%d/stat", static_cast<int>(gettid()));
  lane.stat = open(path, O_RDONLY | O_CLOEXEC);
  while (g_left > 0) {
    ++lane.round;
    Open(lane, random, decoys);
    Message message{};
    sem_post(&lane.begins);
    long got = Read(lane.call, lane.reads, &message, PollTime(lane));
    Count(1);
    int error = errno;
    sem_wait(&lane.ends);
    if (lane.call == Call::kPoll) {
      CheckPoll(lane, got);
      if (lane.fate == Fate::kStays) {
        got = Read(Call::kRead, lane.reads, &message);
        error = errno;
        Count(1);
      }
    }
    if (lane.call != Call::kPoll || lane.fate == Fate::kStays) {
      CheckRead(lane, got, error, message);
    }
    if (lane.fate == Fate::kStays || lane.fate == Fate::kReplaced) Close(lane.reads);
    if (!lane.comes_to_end) {
      CheckGone(lane);
      CloseWriter(lane);
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
    usleep(50'000);
    return;
  }
  // Once a poll's time is over the reader waits until this lane's round ends.
  while (!Sleeps(lane)) usleep(10);
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
      if (dup2(lane.decoy, lane.reads) != lane.reads) Fail("dup2: %s", strerror(errno));
    }
    for (unsigned more = lane.fate == Fate::kUsedAgain ? 1 + random() % 3 : 0; more > 0; --more) {
      Count(1);
      lane.copies.push_back(dup(decoys.Any(random)));
      if (lane.copies.back() < 0) Fail("dup: %s", strerror(errno));
    }
    if (random() % 8 == 0) usleep(100);
    if (lane.comes_to_end) {
      CloseWriter(lane);
    } else {
      const Message message = Message::Of(lane.number, lane.round);
      const ssize_t n = write(lane.writes, &message, sizeof message);
      // On a busy host a poll's time may be over before its file is closed.
      const bool may_be_gone = lane.call == Call::kPoll && lane.fate != Fate::kStays;
      if (n != sizeof message && !(n == -1 && may_be_gone && !g_under_tcs)) {
        lane.Fails("write: %zd (%s)", n, strerror(errno));
      }
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
    threads.emplace_back(BeReader, std::ref(lanes[i]), seed + 2 * i, std::cref(decoys));
    threads.emplace_back(BeCloser, std::ref(lanes[i]), seed + 2 * i + 1, std::cref(decoys));
  }
  for (std::thread& thread : threads) thread.join();
  decoys.Check();
  printf("%ld rounds, %ld operations\n", g_rounds.load(), atol(argv[1]) - g_left.load());
}
