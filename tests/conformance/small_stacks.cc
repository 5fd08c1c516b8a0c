// How much of a thread's stack waits, and programs that are executed, take: threads may have 16
// KiB, and some libraries start programs on 4 KiB within a frame of their own.
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/select.h>
#include <sys/sem.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <x86intrin.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr std::size_t kStack = 256 << 10;
constexpr unsigned char kUnused = 0xa5;
// What the C library needs, and the kernel's frame for a signal with all registers, which may come
// at the deepest place.
constexpr std::size_t kLibrary = 3 << 10, kFrame = 4 << 10;

int g_pipe[2], g_epoll = -1, g_semaphores = -1;

unsigned char* g_stack;

void Paint() { memset(g_stack, kUnused, kStack); }

std::size_t Used() {
  std::size_t unused = 0;
  while (unused < kStack && g_stack[unused] == kUnused) ++unused;
  return kStack - unused;
}

std::size_t UsedBy(void (*call)()) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  EXPECT(pthread_attr_setstack(&attributes, g_stack, kStack) == 0, "pthread_attr_setstack");
  Paint();
  pthread_t thread;
  EXPECT(pthread_create(
             &thread, &attributes,
             [](void* what) -> void* {
               reinterpret_cast<void (*)()>(what)();
               return nullptr;
             },
             reinterpret_cast<void*>(call)) == 0,
         "pthread_create");
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  return Used();
}

timespec Soon(clockid_t clock) { return ToTimespec(Now(clock) + kMs); }

struct Wait {
  const char* name;
  void (*call)();
};

constexpr Wait kWaits[] = {
    {"nanosleep",
     [] {
       const timespec t = ToTimespec(kMs);
       nanosleep(&t, nullptr);
     }},
    {"select",
     [] {
       fd_set sets[3];
       for (fd_set& set : sets) FD_ZERO(&set);
       FD_SET(g_pipe[0], &sets[0]);
       timeval t{0, 1000};
       select(FD_SETSIZE, &sets[0], &sets[1], &sets[2], &t);
     }},
    {"pselect",
     [] {
       fd_set set;
       FD_ZERO(&set);
       FD_SET(g_pipe[0], &set);
       const timespec t = ToTimespec(kMs);
       pselect(g_pipe[0] + 1, &set, nullptr, nullptr, &t, nullptr);
     }},
    {"poll",
     [] {
       pollfd fd{g_pipe[0], POLLIN, 0};
       poll(&fd, 1, 1);
     }},
    {"epoll_wait",
     [] {
       epoll_event event;
       epoll_wait(g_epoll, &event, 1, 1);
     }},
    {"sem_timedwait",
     [] {
       sem_t semaphore;
       sem_init(&semaphore, 0, 0);
       const timespec t = Soon(CLOCK_REALTIME);
       sem_timedwait(&semaphore, &t);
     }},
    {"pthread_cond_timedwait",
     [] {
       pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
       pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
       pthread_mutex_lock(&mutex);
       const timespec t = Soon(CLOCK_REALTIME);
       pthread_cond_timedwait(&condition, &mutex, &t);
       pthread_mutex_unlock(&mutex);
     }},
    {"semtimedop",
     [] {
       sembuf take{0, -1, 0};
       const timespec t = ToTimespec(kMs);
       semtimedop(g_semaphores, &take, 1, &t);
     }},
    {"sigtimedwait",
     [] {
       sigset_t set;
       sigemptyset(&set);
       sigaddset(&set, SIGUSR2);
       const timespec t = ToTimespec(kMs);
       sigtimedwait(&set, nullptr, &t);
     }},
    {"clock_gettime",
     [] {
       for (int i = 0; i < 100; ++i) Now();
     }},
    {"rdtsc",
     [] {
       for (int i = 0; i < 20'000; ++i) __rdtsc();
     }},
};

char kTrue[] = "true";
char* const kArguments[] = {kTrue, nullptr};
// Without what tcs needs: it has to be added.
char kOwnEntry[] = "PATH=/usr/bin:/bin";
char* const kEnvironment[] = {kOwnEntry, nullptr};

constexpr Wait kExecs[] = {
    {"execv", [] { execv("/bin/true", kArguments); }},
    {"execve", [] { execve("/bin/true", kArguments, kEnvironment); }},
    {"execl", [] { execl("/bin/true", kTrue, nullptr); }},
};

// In a child that shares this process's memory, which waits for it.
std::size_t UsedByChild(const Wait& exec) {
  Paint();
  const pid_t child = clone(
      [](void* what) -> int {
        static_cast<const Wait*>(what)->call();
        _exit(3);
      },
      g_stack + kStack, CLONE_VM | CLONE_VFORK | SIGCHLD, const_cast<Wait*>(&exec));
  EXPECT(child > 0, "clone");
  int status = -1;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "%s: status %x", exec.name, status);
  return Used();
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  void* stack = mmap(nullptr, kStack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  EXPECT(stack != MAP_FAILED, "mmap");
  g_stack = static_cast<unsigned char*>(stack);
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, g_pipe) == 0, "socketpair");
  g_epoll = epoll_create1(0);
  epoll_event interest{};
  interest.events = EPOLLIN;
  EXPECT(epoll_ctl(g_epoll, EPOLL_CTL_ADD, g_pipe[0], &interest) == 0, "epoll_ctl");
  g_semaphores = semget(IPC_PRIVATE, 1, 0600);
  EXPECT(g_semaphores >= 0, "semget");
  // A thread's own things are there, too.
  const std::size_t nothing = UsedBy([] {});
  for (const Wait& wait : kWaits) {
    wait.call();  // names are looked up once, by the linker, on whatever stack there is
    const std::size_t used = UsedBy(wait.call) - nothing;
    EXPECT(used <= kLibrary + kFrame, "%s took %zu bytes of the stack", wait.name, used);
  }
  for (const Wait& exec : kExecs) {
    const std::size_t used = UsedByChild(exec);
    EXPECT(used <= 4096 - 256, "%s took %zu bytes of the stack", exec.name, used);
  }
  semctl(g_semaphores, 0, IPC_RMID);
}
