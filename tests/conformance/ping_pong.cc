// Two processes send each other a token through everything that carries one. Nothing arrives before
// it was sent, whoever computes or sleeps meanwhile; with set costs it arrives exactly when the
// sender has nothing left to do but wait.
#include <fcntl.h>
#include <linux/futex.h>
#include <mqueue.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/msg.h>
#include <sys/prctl.h>
#include <sys/sem.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <atomic>
#include <functional>
#include <string>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

int g_cores = 1;
constexpr int kRounds = 6;  // the pinger waits at once in the even ones
constexpr std::int64_t kComputed = 5 * kMs, kSlept = 2 * kMs;
constexpr int kPinger = 0, kPonger = 1;

struct Round {
  std::int64_t sent, got, returned, back;
};
struct Match {
  Round rounds[kRounds];
};

// What carries the token; `side` sends to and receives from the other one.
struct Carrier {
  const char* name;
  std::function<void(int side)> send, receive;
  // Of the receiver: from its waking to its reading of the clock; if it needs not wait.
  int calls_to_wake = 0, calls_to_take = 1;
  bool woken_goes_first = false;  // before the sender's next call, on one core
};

template <class T>
T* Shared() {
  void* at = mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  EXPECT(at != MAP_FAILED, "mmap: %s", strerror(errno));
  return new (at) T{};
}

// Where computing costs nothing, sleeping stands in for it.
void Compute() {
  if (g_mode == Mode::kFixed) {
    usleep(kComputed / 1000);
    return;
  }
  const std::int64_t start = Now(CLOCK_PROCESS_CPUTIME_ID);
  while (Now(CLOCK_PROCESS_CPUTIME_ID) - start < kComputed) {
  }
}

void Ping(const Carrier& carrier, Round* rounds) {
  for (int i = 0; i < kRounds; ++i) {
    Compute();
    rounds[i].sent = Now();
    carrier.send(kPinger);
    if (i % 2 == 1) Compute();
    carrier.receive(kPinger);
    rounds[i].back = Now();
  }
}

void Pong(const Carrier& carrier, Round* rounds) {
  for (int i = 0; i < kRounds; ++i) {
    carrier.receive(kPonger);
    rounds[i].got = Now();
    usleep(kSlept / 1000);
    rounds[i].returned = Now();
    carrier.send(kPonger);
  }
}

void Check(const Carrier& carrier, const Round* rounds) {
  // The sender's send, the receiver's look at the clock, and where they share a core the call that
  // the sender then waits in.
  const bool in_turn = g_cores == 1 && !carrier.woken_goes_first;
  const std::int64_t way = (2 + in_turn + carrier.calls_to_wake) * kCallNs;
  for (int i = 0; i < kRounds; ++i) {
    const Round& r = rounds[i];
    EXPECT(r.got >= r.sent, "%s, round %d: got %lld ns early", carrier.name, i,
           (long long)(r.sent - r.got));
    EXPECT(r.back >= r.returned, "%s, round %d: back %lld ns early", carrier.name, i,
           (long long)(r.returned - r.back));
    EXPECT(r.returned - r.got >= kSlept, "%s, round %d: the partner slept %lld ns", carrier.name, i,
           (long long)(r.returned - r.got));
    // What is found to be stolen is taken out of what the clock has shown already.
    EXPECT(i == 0 || r.sent - rounds[i - 1].back >= kComputed - kMs / 5,
           "%s, round %d: only %lld ns passed", carrier.name, i,
           (long long)(r.sent - rounds[i - 1].back));
    if (g_mode == Mode::kMeasured) {
      // For the first round the partner may have yet to come.
      const std::int64_t most = kComputed + 4 * kMs, first = i == 0 ? MostOfChildren() : 0;
      EXPECT(r.got - r.sent < most + first, "%s, round %d: got after %lld ns", carrier.name, i,
             (long long)(r.got - r.sent));
      EXPECT(r.back - r.returned < most, "%s, round %d: back after %lld ns", carrier.name, i,
             (long long)(r.back - r.returned));
    }
    if (g_mode == Mode::kFixed) {
      EXPECT(r.got - r.sent == way, "%s, round %d: got after %lld ns", carrier.name, i,
             (long long)(r.got - r.sent));
      EXPECT(r.returned - r.got == kSlept + 2 * kCallNs, "%s, round %d: slept %lld ns",
             carrier.name, i, (long long)(r.returned - r.got));
      // In the odd rounds the token is there before it is waited for.
      const int partners = g_cores == 1 && carrier.woken_goes_first ? 2 : 0;
      const int calls = 3 + carrier.calls_to_take + partners;
      const std::int64_t back =
          i % 2 == 0 ? way : r.sent + kComputed + calls * kCallNs - r.returned;
      EXPECT(r.back - r.returned == back, "%s, round %d: back after %lld ns, not %lld",
             carrier.name, i, (long long)(r.back - r.returned), (long long)back);
    }
  }
}

void Play(const Carrier& carrier) {
  Round* rounds = Shared<Match>()->rounds;
  const pid_t child = fork();
  EXPECT(child >= 0, "fork: %s", strerror(errno));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    Pong(carrier, rounds);
    _exit(0);
  }
  Ping(carrier, rounds);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "%s: child %x", carrier.name, status);
  Check(carrier, rounds);
}

// Descriptors: each side reads from one and writes to one.
void PlayDescriptors(const char* name, const int (&in)[2], const int (&out)[2]) {
  Play({name,
        [&](int side) {
          const std::uint64_t one = 1;
          EXPECT(write(out[side], &one, sizeof one) == sizeof one, "%s: %s", name, strerror(errno));
        },
        [&](int side) {
          std::uint64_t one = 0;
          EXPECT(read(in[side], &one, sizeof one) == sizeof one && one == 1, "%s: %s", name,
                 strerror(errno));
        }});
  for (const int fd : {in[0], in[1], out[0], out[1]}) close(fd);
}

void Pipes() {
  int ping[2], pong[2];
  EXPECT(pipe(ping) == 0 && pipe(pong) == 0, "pipe");
  PlayDescriptors("pipes", {pong[0], ping[0]}, {ping[1], pong[1]});
}

void Fifos() {
  char folder[] = "/tmp/conformance.XXXXXX";
  EXPECT(mkdtemp(folder) != nullptr, "mkdtemp");
  int fds[2];
  for (int i = 0; i < 2; ++i) {
    const std::string path = std::string(folder) + "/" + std::to_string(i);
    EXPECT(mkfifo(path.c_str(), 0600) == 0, "mkfifo: %s", strerror(errno));
    fds[i] = open(path.c_str(), O_RDWR);
    unlink(path.c_str());
  }
  rmdir(folder);
  PlayDescriptors("FIFOs", {fds[0], fds[1]}, {fds[1], fds[0]});
}

void EventDescriptors() {
  const int ping = eventfd(0, 0), pong = eventfd(0, EFD_SEMAPHORE);
  PlayDescriptors("eventfds", {pong, ping}, {ping, pong});
}

void SocketPairs() {
  for (const int type : {SOCK_STREAM, SOCK_DGRAM, SOCK_SEQPACKET}) {
    int fds[2];
    EXPECT(socketpair(AF_UNIX, type, 0, fds) == 0, "socketpair");
    PlayDescriptors("a socketpair", {fds[0], fds[1]}, {fds[0], fds[1]});
  }
}

template <class Address>
void Connect(int type, Address address, socklen_t size, int (&ends)[2]) {
  auto* raw = reinterpret_cast<sockaddr*>(&address);
  const int listener = socket(raw->sa_family, type, 0);
  EXPECT(bind(listener, raw, size) == 0 && listen(listener, 1) == 0, "bind: %s", strerror(errno));
  size = sizeof address;
  getsockname(listener, raw, &size);
  ends[0] = socket(raw->sa_family, type, 0);
  EXPECT(connect(ends[0], raw, size) == 0, "connect: %s", strerror(errno));
  ends[1] = accept(listener, nullptr, nullptr);
  EXPECT(ends[1] >= 0, "accept: %s", strerror(errno));
  close(listener);
}

sockaddr_in Loopback() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

void Streams() {
  int ends[2];
  Connect(SOCK_STREAM, Loopback(), sizeof(sockaddr_in), ends);
  const int one = 1;
  for (const int end : ends) setsockopt(end, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
  PlayDescriptors("TCP", {ends[0], ends[1]}, {ends[0], ends[1]});
  sockaddr_un local{};
  local.sun_family = AF_UNIX;
  Connect(SOCK_STREAM, local, sizeof local.sun_family, ends);  // a name that the kernel chooses
  PlayDescriptors("a UNIX stream", {ends[0], ends[1]}, {ends[0], ends[1]});
}

void Datagrams() {
  int fds[2];
  sockaddr_in addresses[2] = {Loopback(), Loopback()};
  for (int i = 0; i < 2; ++i) {
    fds[i] = socket(AF_INET, SOCK_DGRAM, 0);
    auto* raw = reinterpret_cast<sockaddr*>(&addresses[i]);
    socklen_t size = sizeof addresses[i];
    EXPECT(bind(fds[i], raw, size) == 0, "bind: %s", strerror(errno));
    getsockname(fds[i], raw, &size);
  }
  Play({"UDP",
        [&](int side) {
          EXPECT(sendto(fds[side], "x", 1, 0, reinterpret_cast<sockaddr*>(&addresses[1 - side]),
                        sizeof addresses[0]) == 1,
                 "sendto: %s", strerror(errno));
        },
        [&](int side) {
          char c;
          EXPECT(recvfrom(fds[side], &c, 1, 0, nullptr, nullptr) == 1, "recvfrom: %s",
                 strerror(errno));
        }});
  for (const int fd : fds) close(fd);
}

void MessageQueues() {
  mq_attr attributes{};
  attributes.mq_maxmsg = 1;
  attributes.mq_msgsize = 8;
  mqd_t queues[2];
  for (mqd_t& queue : queues) {
    const std::string name = "/conformance." + std::to_string(getpid());
    queue = mq_open(name.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600, &attributes);
    EXPECT(queue >= 0 && mq_unlink(name.c_str()) == 0, "mq_open: %s", strerror(errno));
  }
  Play({"message queues",
        [&](int side) {
          EXPECT(mq_send(queues[1 - side], "x", 1, 0) == 0, "mq_send: %s", strerror(errno));
        },
        [&](int side) {
          char text[8];
          EXPECT(mq_receive(queues[side], text, sizeof text, nullptr) == 1, "mq_receive: %s",
                 strerror(errno));
        }});
  for (const mqd_t queue : queues) mq_close(queue);
}

void SharedSemaphores() {
  struct Two {
    sem_t semaphores[2];
  };
  auto* two = Shared<Two>();
  for (sem_t& semaphore : two->semaphores) sem_init(&semaphore, 1, 0);
  Play({"shared semaphores", [=](int side) { sem_post(&two->semaphores[1 - side]); },
        [=](int side) {
          EXPECT(sem_wait(&two->semaphores[side]) == 0, "sem_wait: %s", strerror(errno));
        },
        0, 0});
}

void SharedConditions() {
  struct Table {
    pthread_mutex_t mutex;
    pthread_cond_t conditions[2];
    bool tokens[2];
  };
  auto* table = Shared<Table>();
  pthread_mutexattr_t mutex;
  pthread_mutexattr_init(&mutex);
  pthread_mutexattr_setpshared(&mutex, PTHREAD_PROCESS_SHARED);
  pthread_mutex_init(&table->mutex, &mutex);
  pthread_condattr_t condition;
  pthread_condattr_init(&condition);
  pthread_condattr_setpshared(&condition, PTHREAD_PROCESS_SHARED);
  for (pthread_cond_t& c : table->conditions) pthread_cond_init(&c, &condition);
  Play({"shared conditions",
        [=](int side) {
          pthread_mutex_lock(&table->mutex);
          table->tokens[1 - side] = true;
          pthread_mutex_unlock(&table->mutex);
          pthread_cond_signal(&table->conditions[1 - side]);
        },
        [=](int side) {
          pthread_mutex_lock(&table->mutex);
          while (!table->tokens[side]) pthread_cond_wait(&table->conditions[side], &table->mutex);
          table->tokens[side] = false;
          // One who has waited does not know that nobody else does, and wakes them.
          pthread_mutex_unlock(&table->mutex);
        },
        1, 0});
}

void RawFutexes() {
  struct Words {
    std::atomic<int> words[2];
  };
  auto* words = Shared<Words>();
  Play({"futexes",
        [=](int side) {
          words->words[1 - side] = 1;
          syscall(SYS_futex, &words->words[1 - side], FUTEX_WAKE, 1, nullptr, nullptr, 0);
        },
        [=](int side) {
          std::atomic<int>& word = words->words[side];
          while (word.exchange(0) == 0)
            syscall(SYS_futex, &word, FUTEX_WAIT, 0, nullptr, nullptr, 0);
        },
        0, 0});
}

void SystemVSemaphores() {
  const int id = semget(IPC_PRIVATE, 2, 0600);
  EXPECT(id >= 0, "semget: %s", strerror(errno));
  auto operate = [id](int number, int change) {
    sembuf operation{static_cast<unsigned short>(number), static_cast<short>(change), 0};
    EXPECT(semop(id, &operation, 1) == 0, "semop: %s", strerror(errno));
  };
  Play({"System V semaphores", [=](int side) { operate(1 - side, 1); },
        [=](int side) { operate(side, -1); }, 0, 1, true});
  semctl(id, 0, IPC_RMID);
}

void SystemVMessages() {
  const int id = msgget(IPC_PRIVATE, 0600);
  EXPECT(id >= 0, "msgget: %s", strerror(errno));
  Play({"System V messages",
        [=](int side) {
          const long message = 2 - side;  // its type, and no text
          EXPECT(msgsnd(id, &message, 0, 0) == 0, "msgsnd: %s", strerror(errno));
        },
        [=](int side) {
          long message = 0;
          EXPECT(msgrcv(id, &message, 0, 1 + side, 0) == 0 && message == 1 + side, "msgrcv: %s",
                 strerror(errno));
        },
        0, 1, true});
  msgctl(id, IPC_RMID, nullptr);
}

std::int64_t g_handled_ns;
volatile sig_atomic_t g_handled = 0;
void Handle(int) {
  g_handled_ns = Now();
  g_handled = 1;
}

void Signals() {
  struct sigaction action {};
  action.sa_handler = Handle;
  sigaction(SIGUSR1, &action, nullptr);
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGUSR1);
  sigprocmask(SIG_BLOCK, &blocked, &before);
  struct Pids {
    std::atomic<pid_t> pids[2];
  };
  auto* pids = Shared<Pids>();
  pids->pids[kPinger] = getpid();
  Play({"signals",
        [=](int side) {
          while (pids->pids[1 - side] == 0) usleep(100);  // the partner has still to come
          EXPECT(kill(pids->pids[1 - side], SIGUSR1) == 0, "kill: %s", strerror(errno));
        },
        [=](int side) {
          pids->pids[side] = getpid();
          while (!g_handled) sigsuspend(&before);
          g_handled = 0;
          const std::int64_t now = Now();
          EXPECT(g_handled_ns <= now && g_handled_ns + kMs >= now,
                 "a handler's clock shows %lld ns more", (long long)(g_handled_ns - now));
        },
        2, 3});
  sigprocmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (argc > 2) g_cores = atoi(argv[2]);
  const struct {
    const char* name;
    void (*play)();
  } kCases[] = {{"pipes", Pipes},
                {"fifos", Fifos},
                {"eventfds", EventDescriptors},
                {"socketpairs", SocketPairs},
                {"streams", Streams},
                {"datagrams", Datagrams},
                {"semaphores", SharedSemaphores},
                {"conditions", SharedConditions},
                {"futexes", RawFutexes},
                {"semop", SystemVSemaphores},
                {"msgsnd", SystemVMessages},
                {"mqueues", MessageQueues},
                {"signals", Signals}};
  for (const auto& c : kCases) {
    if (argc < 4 || strcmp(argv[3], c.name) == 0) c.play();
  }
}
