// A program that does to tcs what it can: `hostile SEED`. What, the seed decides; it knows where in
// its memory tcs is, and stops for nothing.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <random>
#include <span>

#include "shm/attach_protocol.h"
#include "shm/clock_page.h"
#include "shm/command_ring.h"
#include "shm/dds_exchange.h"
#include "shm/layout.h"

namespace {

using namespace tcs::shm;

std::mt19937_64 g_dice;

std::uint64_t Below(std::uint64_t n) { return g_dice() % n; }

// Values at the edges of what is stored.
std::uint64_t Odd() {
  constexpr std::uint64_t kOdd[] = {
      0, 1, 2, 4096, UINT32_MAX, INT64_MAX, 1ul << 63, 1ul << 47, ~0ul, 1'000'000'000'000'000'000};
  return Below(2) == 0 ? kOdd[Below(std::size(kOdd))] : g_dice();
}

struct Mapping {
  char* at = nullptr;
  std::size_t size = 0;
};

Mapping FindMapping(const char* name) {
  FILE* maps = fopen("/proc/self/maps", "re");
  char line[512];
  Mapping found;
  while (maps != nullptr && fgets(line, sizeof line, maps) != nullptr) {
    unsigned long start, end;
    if (strstr(line, name) == nullptr || sscanf(line, "%lx-%lx", &start, &end) != 2) continue;
    found = {reinterpret_cast<char*>(start), end - start};
  }
  if (maps != nullptr) fclose(maps);
  return found;
}

ThreadSlot* Slots() {
  return reinterpret_cast<ThreadSlot*>(FindMapping("/memfd:tcs (deleted)").at);
}

// The write end of the pipe to the coordinator.
int NotifyFd() {
  for (int fd = 1023; fd > 2; --fd) {
    char link[64], name[64] = {};
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    if (readlink(link, name, sizeof name - 1) > 0 && strncmp(name, "pipe:", 5) == 0) return fd;
  }
  return -1;
}

long Own(long number, long a = 0, long b = 0, long c = 0) {
  return syscall(number, a, b, c, 0, 0, long{kOwnCallMark});
}

void Notify(std::uint32_t slot) {
  const PipeMessage message{slot, 0};
  Own(SYS_write, NotifyFd(), reinterpret_cast<long>(&message), sizeof message);
}

void Pass(std::int64_t ms) { usleep(static_cast<useconds_t>(ms * 1000)); }

// Its own slots.

void ScribbleBytes() {
  char* slots = reinterpret_cast<char*>(Slots());
  for (int i = 0; i < 200; ++i) slots[Below(2 * sizeof(ThreadSlot))] = static_cast<char>(g_dice());
}

void ScribbleWords() {
  auto* words = reinterpret_cast<std::uint64_t*>(Slots());
  for (std::uint64_t i = 1 + Below(6); i > 0; --i) words[Below(sizeof(ThreadSlot) / 8)] = Odd();
}

void ScribbleOverAll() {
  memset(static_cast<void*>(Slots()), static_cast<int>(g_dice()), kProcessMemorySize);
}

void TakePagesAway() { madvise(Slots(), kProcessMemorySize, MADV_REMOVE); }

void LieAboutTime() {
  ClockPage& page = Slots()->clock;
  const auto odd = static_cast<std::int64_t>(Odd());
  switch (Below(8)) {
    case 0:
      page.executed_adjust.store(PackAdjust(page.executed_adjust.load(), odd));
      break;
    case 1:
      page.waited_adjust.store(PackAdjust(page.waited_adjust.load(), odd));
      break;
    case 2:
      page.last_shown_ns.store(odd);
      break;
    case 3:
      page.staleness_ns.store(1'000'000'000'000'000'000);
      break;
    case 4:
      page.stolen_ns.store(1'000'000'000'000'000'000);
      break;
    case 5:
      page.last_check_tsc.store(Odd());
      break;
    case 6:
      page.host_cpu_origin_ns = odd;
      break;
    default:
      page.base_tsc -= std::uint64_t{1} << 60;
  }
}

void NotifyNonsense() {
  ThreadSlot& slot = *Slots();
  slot.note.kind = static_cast<NotificationKind>(Below(40));
  slot.note.fd_count = Below(3) == 0 ? static_cast<std::uint32_t>(Odd()) : 0;
  slot.note.deadline_ns = static_cast<std::int64_t>(Odd());
  slot.note.time_ns = static_cast<std::int64_t>(Odd());
  for (std::int64_t& arg : slot.note.args) arg = static_cast<std::int64_t>(Odd());
  Notify(0);
}

// As if it waited at its gate; but it computes on.
void NotifyAndSpin() {
  Slots()->note.kind = NotificationKind::kYield;
  Notify(0);
  for (volatile int i = 0; i < 300'000'000;) i = i + 1;
}

void NoteIpcNonsense() {
  ThreadSlot& slot = *Slots();
  for (IpcNote& note : slot.ipc_notes) {
    note = {Odd(), static_cast<std::int64_t>(Odd()), static_cast<IpcEvent>(Below(6)), 0};
  }
  slot.ipc_count.store(static_cast<std::uint32_t>(Below(12)));
}

// Some of it is a datagram, and a few of those are commands.
void PostNonsense() {
  constexpr char kCommands[][32] = {R"({"force": [1e3, -1e-300, 1.50]})",
                                    "{\"force\": [nan, 1e999, \xff ! 1 }"};
  constexpr std::uint32_t kSize = sizeof kCommands[0] - 1;
  CommandRing& ring = Slots()->command_ring;
  for (std::uint64_t i = 1 + Below(60); i > 0 && HasRoomFor(ring, kSize); --i) {
    const bool is_odd = Below(200) == 0;
    const CommandRing::Head head{static_cast<std::int64_t>(Odd()), static_cast<std::int64_t>(Odd()),
                                 is_odd ? static_cast<std::uint32_t>(Odd()) : 0,
                                 is_odd ? static_cast<std::uint32_t>(Odd()) : kSize};
    PostInto(ring, head,
             [&](std::uint64_t at) { CopyIntoRing(ring, at, kCommands[Below(2)], kSize); });
  }
  if (Below(3) != 0) return;
  if (Below(2) == 0) ring.posted.store(Below(2) == 0 ? Odd() : ring.posted.load() + Below(9));
  if (Below(2) == 0) ring.taken.store(Odd());
  for (int i = 0; i < 20; ++i)
    ring.bytes[Below(CommandRing::kBytes)] = static_cast<std::uint8_t>(Odd());
}

// What is the run's.
void WriteIntoHeader() {
  const Mapping run = FindMapping("/memfd:tcs-run");
  mprotect(run.at, run.size, PROT_READ | PROT_WRITE);
  char path[64];
  snprintf(path, sizeof path, "/proc/self/map_files/%lx-%lx", reinterpret_cast<long>(run.at),
           reinterpret_cast<long>(run.at) + static_cast<long>(run.size));
  const int fd = open(path, O_RDWR | O_CLOEXEC);
  void* at =
      fd < 0 ? MAP_FAILED : mmap(nullptr, run.size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (at != MAP_FAILED) {
    memset(at, 0xff, run.size);
    puts("the header can be written");
  }
  if (fd >= 0 && (ftruncate(fd, 0) == 0 || write(fd, "x", 1) == 1)) puts("and cut off");
}

// The pipe.

void SendGarbage() {
  std::uint32_t garbage[512];
  for (std::uint32_t& word : garbage) word = static_cast<std::uint32_t>(Odd());
  Own(SYS_write, NotifyFd(), reinterpret_cast<long>(garbage),
      static_cast<long>(1 + Below(sizeof garbage)));
}

void Flood() {
  for (int i = 0; i < 20'000; ++i) Notify(static_cast<std::uint32_t>(Below(4)));
}

void Fill() {
  const int fd = NotifyFd();
  fcntl(fd, F_SETFL, O_NONBLOCK);
  char zeros[4096] = {};
  for (int i = 0; i < 64; ++i) {
    Own(SYS_write, fd, reinterpret_cast<long>(zeros), sizeof zeros);
  }
}

void Steal() {
  char path[64];
  snprintf(path, sizeof path, "/proc/self/fd/%d", NotifyFd());
  const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  char bytes[4096];
  for (int i = 0; i < 100; ++i) {
    Notify(0);
    if (read(fd, bytes, sizeof bytes) < 0 && errno != EAGAIN) break;
  }
}

void CloseIt() { syscall(SYS_close, NotifyFd()); }

void ReplaceIt() {
  const int other = Below(2) == 0 ? open("/dev/null", O_RDWR) : eventfd(0, 0);
  syscall(SYS_dup2, other, NotifyFd());
}

void CloseAll() { syscall(SYS_close_range, 3, ~0u, 0); }

// Timers of what is none, and full pipes for them.
void GiveOtherDescriptors() {
  int ends[2];
  if (pipe2(ends, O_NONBLOCK) != 0) return;
  char zeros[4096] = {};
  while (write(ends[1], zeros, sizeof zeros) > 0) {
  }
  fcntl(ends[1], F_SETFL, 0);
  const int counter = eventfd(0, 0);
  const std::uint64_t most = UINT64_MAX - 1;
  if (write(counter, &most, sizeof most) < 0) return;
  for (const int fd : {ends[1], counter, 0, 1, 2, -7, NotifyFd()}) {
    ThreadSlot& slot = *Slots();
    slot.gate.store(kGateClosed);
    slot.note.kind = NotificationKind::kTimerCreate;
    memset(slot.note.args, 0, sizeof slot.note.args);
    slot.note.args[0] = fd;
    Notify(0);
    while (slot.gate.load() != kGateOpen) sched_yield();
  }
  const int timer = timerfd_create(CLOCK_MONOTONIC, 0);
  const itimerspec each{{0, 1'000'000}, {0, 1'000'000}};
  timerfd_settime(timer, 0, &each, nullptr);
  for (int i = 0; i < 50; ++i) {
    if (write(timer, &most, sizeof most) > 0) puts("a timer has been written to");
    Pass(1);
  }
  dup2(ends[1], timer);
  Pass(5);
}

// Processes and threads.

void NameOthers() {
  for (int i = 0; i < 20; ++i) {
    const auto pid = static_cast<pid_t>(Below(3) == 0 ? Odd() : 1 + Below(32768));
    sched_param param{50};
    // Whatever is natively its right it may do to its own; those of the host are not.
    syscall(SYS_sched_setscheduler, pid, SCHED_FIFO, &param);
    ThreadSlot& slot = *Slots();
    slot.note.kind = NotificationKind::kSpawned;
    slot.note.args[0] = pid;
    slot.note.fd_count = 0;
    Notify(0);
  }
}

void* SpinForEver(void*) {
  for (;;) {
  }
}

// A thread that tcs is told nothing of.
void SpinBare() {
  constexpr std::size_t kStack = 65'536;
  char* stack = static_cast<char*>(
      mmap(nullptr, kStack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  clone(
      [](void*) -> int {
        SpinForEver(nullptr);
        return 0;
      },
      stack + kStack,
      CLONE_VM | CLONE_FS | CLONE_FILES | CLONE_SIGHAND | CLONE_THREAD | CLONE_SYSVSEM, nullptr);
}

void SpinInBareChild() {
  if (syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr) == 0) SpinForEver(nullptr);
}

void HaveChildren(int count) {
  for (int i = 0; i < count; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      if (i % 3 == 0) ScribbleWords();
      if (i % 5 == 0) abort();
      _exit(i % 7);
    }
    if (child < 0) break;
  }
  while (waitpid(-1, nullptr, WNOHANG) > 0) {
  }
}

void StopAChild() {
  const pid_t child = fork();
  if (child == 0) {
    raise(SIGSTOP);
    _exit(0);
  }
  Pass(3);
  if (Below(2) == 0) kill(child, SIGCONT);
}

void HaveTinyStacks() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, 16'384);
  for (int i = 0; i < 20; ++i) {
    pthread_t thread;
    const auto sleeper = [](void*) -> void* {
      Pass(1);
      return nullptr;
    };
    if (pthread_create(&thread, &attributes, sleeper, nullptr) == 0) pthread_detach(thread);
  }
}

void BlockAllSignals() {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, nullptr);
  const itimerval each{{0, 500}, {0, 500}};
  setitimer(ITIMER_REAL, &each, nullptr);
  kill(getpid(), SIGTERM);
  Pass(20);
}

// The socket that programs register at.

int Connect() {
  const char* name = getenv(kSocketVariable);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name == nullptr) return -1;
  strncpy(address.sun_path + 1, name, sizeof address.sun_path - 2);
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  connect(fd, reinterpret_cast<sockaddr*>(&address),
          static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + strlen(name)));
  return fd;
}

void RegisterFalsely() {
  for (int i = 0; i < 40; ++i) {
    AttachHello hello{kMagic, kVersion, getpid(), 0, 0, AttachWants{}, 0, 0};
    hello.tid = static_cast<std::int32_t>(Below(2) == 0 ? 2 + Below(32768) : Odd());
    hello.parent_pid = static_cast<std::int32_t>(Odd());
    hello.wants = static_cast<AttachWants>(Below(5));
    if (Below(4) == 0) hello.pid = static_cast<std::int32_t>(Odd());
    const int fd = Connect();
    send(fd, &hello, 1 + Below(sizeof hello), MSG_NOSIGNAL);
    if (Below(2) == 0) send(fd, &hello, sizeof hello, MSG_NOSIGNAL);
    if (Below(2) == 0) close(fd);
  }
}

void ConnectInSilence() {
  for (int i = 0; i < 600; ++i) Connect();
}

// Registers once more, while another thread of its computes.
void RegisterAgain() {
  pthread_t thread;
  pthread_create(&thread, nullptr, SpinForEver, nullptr);
  Pass(1);
  const AttachHello hello{kMagic, kVersion, getpid(), getpid(), getppid(), AttachWants::kAll, 0, 0};
  send(Connect(), &hello, sizeof hello, MSG_NOSIGNAL);
  Pass(1);
  _exit(0);
}

// DDS, without its library.
void CorruptDds() {
  ThreadSlot& slot = *Slots();
  const auto ask = [&slot](NotificationKind kind, std::int64_t argument) {
    slot.gate.store(kGateClosed);
    slot.note.kind = kind;
    slot.note.fd_count = 0;
    slot.note.args[0] = argument;
    Notify(0);
    while (slot.gate.load() != kGateOpen) sched_yield();
  };
  ask(NotificationKind::kDdsJoin, 0);
  const int socket = Connect();
  const AttachHello hello{kMagic, kVersion, getpid(), getpid(), getppid(), AttachWants::kDdsArea,
                          0,      0};
  send(socket, &hello, sizeof hello, MSG_NOSIGNAL);
  AttachReply reply;
  iovec iov{&reply, sizeof reply};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  int fd = -1;
  if (recvmsg(socket, &message, 0) > 0 && CMSG_FIRSTHDR(&message) != nullptr) {
    memcpy(&fd, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof fd);
  }
  void* at = mmap(nullptr, kDdsAreaSize, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (at == MAP_FAILED) return;
  auto* words = static_cast<std::uint64_t*>(at);
  for (int i = 0; i < 30; ++i) {
    for (std::size_t j = 0; j < kDdsHeaderSize / 8 + 64; ++j) words[j] = Odd();
    ask(NotificationKind::kDdsSend, static_cast<std::int64_t>(Below(2) == 0 ? Below(8192) : Odd()));
  }
  if (fallocate(fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, kDdsAreaSize) != 0) return;
  ask(NotificationKind::kDdsSend, 4096);
}

void HaveManyChildren() { HaveChildren(300); }
void HaveSomeChildren() { HaveChildren(20); }
void StopItself() { kill(getpid(), SIGSTOP); }
void Crash() { abort(); }

struct Deed {
  const char* name;
  void (*run)();
};
constexpr Deed kDeeds[] = {
    {"scribbles bytes", ScribbleBytes},
    {"scribbles words", ScribbleWords},
    {"scribbles over all", ScribbleOverAll},
    {"takes pages away", TakePagesAway},
    {"lies about time", LieAboutTime},
    {"notifies nonsense", NotifyNonsense},
    {"notifies and spins", NotifyAndSpin},
    {"notes nonsense of System V objects", NoteIpcNonsense},
    {"posts nonsense", PostNonsense},
    {"writes into the header", WriteIntoHeader},
    {"sends garbage", SendGarbage},
    {"floods the pipe", Flood},
    {"fills the pipe", Fill},
    {"steals from the pipe", Steal},
    {"closes the pipe", CloseIt},
    {"replaces the pipe", ReplaceIt},
    {"closes all", CloseAll},
    {"gives other descriptors", GiveOtherDescriptors},
    {"names others", NameOthers},
    {"spins in a bare thread", SpinBare},
    {"spins in a bare child", SpinInBareChild},
    {"has some children", HaveSomeChildren},
    {"has 300 children", HaveManyChildren},
    {"stops a child", StopAChild},
    {"stops itself", StopItself},
    {"has tiny stacks", HaveTinyStacks},
    {"blocks all signals", BlockAllSignals},
    {"registers falsely", RegisterFalsely},
    {"connects in silence", ConnectInSilence},
    {"registers again", RegisterAgain},
    {"corrupts DDS", CorruptDds},
    {"crashes", Crash},
};

}  // namespace

int main(int argc, char** argv) {
  const unsigned long seed = argc > 1 ? strtoul(argv[1], nullptr, 10) : 0;
  g_dice.seed(seed);
  // In turn, so that few rounds do them all; then a second one, as the dice say.
  const Deed& first = kDeeds[seed % std::size(kDeeds)];
  const Deed& second = kDeeds[Below(std::size(kDeeds))];
  printf("%lu: %s, %s\n", seed, first.name, second.name);
  fflush(stdout);
  if (Slots() == nullptr) return 3;
  Pass(2);
  for (int i = 0; i < 3; ++i) {
    first.run();
    Pass(1);
  }
  second.run();
  for (int i = 0; i < 20; ++i) Pass(1);
}
