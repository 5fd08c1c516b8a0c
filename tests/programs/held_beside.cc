// One thread is held by the kernel again and again, in state D, for as long as it takes somebody
// outside to write a byte into the FIFO that is named. The others of its process have just been
// sent a signal, or were stopped halfway in a call: none of them may run meanwhile, in real time
// however long. Says what the first thread has seen of them after each time.
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>

namespace {

std::atomic<int> g_handled{0}, g_written{0};
pthread_mutex_t g_mutex = PTHREAD_MUTEX_INITIALIZER;
pthread_cond_t g_never = PTHREAD_COND_INITIALIZER;
int g_outside, g_nowhere, g_empty[2], g_halfway[2];

void OnSignal(int) { ++g_handled; }

// Not by functions of the C library, which may be tcs's.
__attribute__((always_inline)) inline long Kernel(long number, long a, long b = 0, long c = 0,
                                                  long d = 0, long e = 0, long f = 0) {
  register long r10 __asm__("r10") = d, r8 __asm__("r8") = e, r9 __asm__("r9") = f;
  long result = 0;
  __asm__ volatile("syscall"
                   : "=a"(result)
                   : "a"(number), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8), "r"(r9)
                   : "rcx", "r11", "memory");
  return result;
}

// As vfork does it: the thread is in state D until the child has ended, which takes a byte from
// outside.
__attribute__((noinline)) void BeHeld() {
  constexpr long kVfork = 0x4000 | 0x100;  // CLONE_VFORK and CLONE_VM
  if (Kernel(SYS_clone, kVfork | SIGCHLD, 0) == 0) {
    Kernel(SYS_splice, g_outside, 0, g_nowhere, 0, 1);
    Kernel(SYS_exit_group, 0);
  }
}

void* WaitForThread(void*) {
  pthread_mutex_lock(&g_mutex);
  for (;;) pthread_cond_wait(&g_never, &g_mutex);
}
void* Sleep(void*) {
  for (;;) sleep(1000);
}
void* Suspend(void*) {
  sigset_t none;
  sigemptyset(&none);
  for (;;) sigsuspend(&none);
}
void* Poll(void*) {
  pollfd nothing{g_empty[0], POLLIN, 0};
  for (;;) poll(&nothing, 1, -1);
}
void* Read(void*) {
  char byte = 0;
  for (;;) {
    if (syscall(SYS_read, g_empty[0], &byte, 1) == 1) abort();
  }
}

// Wakes the first thread, which is more urgent: so it is stopped in the middle of its call.
void* Write(void*) {
  for (;;) {
    usleep(500);
    const char byte = 'x';
    if (write(g_halfway[1], &byte, 1) != 1) abort();
    ++g_written;
  }
}

long long Now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  setvbuf(stdout, nullptr, _IOLBF, 0);
  g_outside = open(argv[1], O_RDWR);
  g_nowhere = open("/dev/null", O_WRONLY);
  if (g_outside < 0 || g_nowhere < 0 || pipe(g_empty) != 0 || pipe(g_halfway) != 0) return 1;
  struct sigaction action {};
  action.sa_handler = OnSignal;
  sigaction(SIGUSR1, &action, nullptr);
  const struct {
    const char* name;
    void* (*waits)(void*);
  } kinds[] = {{"a thread", WaitForThread}, {"a time", Sleep}, {"a signal", Suspend},
               {"a descriptor", Poll},      {"a byte", Read},  {nullptr, Write}};
  constexpr int kKinds = 5;
  pthread_t threads[kKinds + 1];
  for (int i = 0; i <= kKinds; ++i) pthread_create(&threads[i], nullptr, kinds[i].waits, nullptr);
  const sched_param urgent{10};
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &urgent) != 0) return 1;
  usleep(100);
  // From here on somebody writes now and then.
  if (close(creat(argv[2], 0600)) != 0) return 1;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < kKinds; ++i) {
      const int before = g_handled;
      pthread_kill(threads[i], SIGUSR1);
      BeHeld();
      const int early = g_handled - before;
      usleep(100);
      printf("waits for %s: %d early, %d later, %lld\n", kinds[i].name, early,
             g_handled - before - early, Now());
    }
    char byte = 0;
    if (read(g_halfway[0], &byte, 1) != 1) return 1;
    const int written = g_written;
    BeHeld();
    const int early = g_written - written;
    usleep(100);
    printf("was writing: %d early, %d later, %lld\n", early, g_written - written - early, Now());
  }
  fflush(stdout);
  _exit(0);
}
