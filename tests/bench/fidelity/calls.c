// calls [BATCHES]: what one operation takes, by the program's own clock, for each line of
// operations: NAME ns [ns ...], a value for each batch. Programs that speak to each other are
// processes of one processor.
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static int g_batches = 11;

static int64_t Now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000000000LL + t.tv_nsec;
}

static void Check(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "calls: %s: %s\n", what, strerror(errno));
  exit(1);
}

// So many times `once` in each batch.
static void Measure(const char* name, int times, void (*once)(void)) {
  for (int i = 0; i < times / 10 + 1; ++i) once();
  printf("%s", name);
  for (int batch = 0; batch < g_batches; ++batch) {
    const int64_t start = Now();
    for (int i = 0; i < times; ++i) once();
    printf(" %.1f", (double)(Now() - start) / times);
  }
  printf("\n");
  fflush(stdout);
}

static char g_a[1 << 16], g_b[1 << 16];
static int g_null, g_zero, g_file, g_pipe[2], g_epoll, g_event;
static struct pollfd g_polled;
static pthread_mutex_t g_mutex = PTHREAD_MUTEX_INITIALIZER;

static void GetParent(void) { syscall(SYS_getppid); }
static void Copy(void) {
  memcpy(g_a, g_b, sizeof g_a);
  __asm__ volatile("" ::: "memory");
}
static void Allocate(void) {
  void* volatile p = malloc(1000);
  free(p);
}
static void Lock(void) {
  pthread_mutex_lock(&g_mutex);
  pthread_mutex_unlock(&g_mutex);
}
static void Fault(void) {
  char* p = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  *p = 1;
  munmap(p, 4096);
}
static void WriteNull(void) { Check(write(g_null, g_a, 1) == 1, "write"); }
static void ReadZero(void) { Check(read(g_zero, g_a, 64) == 64, "read"); }
static void WriteFile(void) { Check(pwrite(g_file, g_a, 4096, 0) == 4096, "pwrite"); }
static void ReadFile(void) { Check(pread(g_file, g_a, 4096, 0) == 4096, "pread"); }
static void OwnPipe(void) {
  Check(write(g_pipe[1], g_a, 1) == 1, "write");
  Check(read(g_pipe[0], g_a, 1) == 1, "read");
}
static void OwnEvent(void) {
  uint64_t one = 1;
  Check(write(g_event, &one, 8) == 8, "write");
  Check(read(g_event, &one, 8) == 8, "read");
}
static void Poll(void) { Check(poll(&g_polled, 1, -1) == 1, "poll"); }
static void Epoll(void) {
  struct epoll_event events[10];
  Check(epoll_wait(g_epoll, events, 10, -1) == 10, "epoll_wait");
}
static void Ignore(int signal) { (void)signal; }
static void SignalItself(void) { raise(SIGUSR1); }
static void Yield(void) { sched_yield(); }
static void ForkAndWait(void) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  Check(waitpid(child, NULL, 0) == child, "waitpid");
}
static void Execute(void) {
  static char name[] = "/bin/true";
  static char* const arguments[] = {name, NULL};
  const pid_t child = fork();
  if (child == 0) {
    execv(name, arguments);
    _exit(1);
  }
  Check(waitpid(child, NULL, 0) == child, "waitpid");
}
static void* Nothing(void* argument) { return argument; }
static void Thread(void) {
  pthread_t thread;
  Check(pthread_create(&thread, NULL, Nothing, NULL) == 0, "pthread_create");
  pthread_join(thread, NULL);
}

// A ping-pong with a child that echoes what comes.
static int g_to, g_from;
static size_t g_size = 1;
static void Receive(int from, char* into) {
  for (size_t got = 0; got < g_size;) {
    const ssize_t n = read(from, into + got, g_size - got);
    if (n <= 0) _exit(0);
    got += (size_t)n;
  }
}
static void PingPong(void) {
  Check(write(g_to, g_a, g_size) == (ssize_t)g_size, "write");
  Receive(g_from, g_a);
}
static void WithEcho(const char* name, int times, int to[2], int from[2], size_t size) {
  g_size = size;
  const pid_t child = fork();
  if (child == 0) {
    for (;;) {
      Receive(to[1], g_b);
      Check(write(from[0], g_b, g_size) == (ssize_t)g_size, "echo");
    }
  }
  g_to = to[0];
  g_from = from[1];
  Measure(name, times, PingPong);
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
}

static int Bound(int type) {
  const int fd = socket(AF_INET, type, 0);
  struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  Check(fd >= 0 && bind(fd, (struct sockaddr*)&address, sizeof address) == 0, "bind");
  return fd;
}
static void Connect(int fd, int to) {
  struct sockaddr_in address;
  socklen_t length = sizeof address;
  getsockname(to, (struct sockaddr*)&address, &length);
  Check(connect(fd, (struct sockaddr*)&address, sizeof address) == 0, "connect");
}

static void PingPongs(void) {
  int to[2], from[2];
  Check(pipe(to) == 0 && pipe(from) == 0, "pipe");
  int there[2] = {to[1], to[0]}, back[2] = {from[1], from[0]};
  WithEcho("pipe_ping_pong", 2000, there, back, 1);
  int pair[2];
  Check(socketpair(AF_UNIX, SOCK_DGRAM, 0, pair) == 0, "socketpair");
  int here[2] = {pair[0], pair[1]}, other[2] = {pair[1], pair[0]};
  WithEcho("unix_datagram_ping_pong", 2000, here, other, 64);
  const int a = Bound(SOCK_DGRAM), b = Bound(SOCK_DGRAM);
  Connect(a, b);
  Connect(b, a);
  int udp[2] = {a, b}, udp_back[2] = {b, a};
  WithEcho("udp_ping_pong_64", 2000, udp, udp_back, 64);
  WithEcho("udp_ping_pong_8K", 2000, udp, udp_back, 8192);
  const int listener = Bound(SOCK_STREAM);
  Check(listen(listener, 1) == 0, "listen");
  const int c = socket(AF_INET, SOCK_STREAM, 0);
  Connect(c, listener);
  const int d = accept(listener, NULL, NULL), yes = 1;
  Check(d >= 0, "accept");
  setsockopt(c, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  setsockopt(d, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  int tcp[2] = {c, d}, tcp_back[2] = {d, c};
  WithEcho("tcp_ping_pong", 2000, tcp, tcp_back, 64);
}

// Two threads and a condition variable.
static pthread_cond_t g_turned = PTHREAD_COND_INITIALIZER;
static int g_turn, g_over;
static void* Other(void* argument) {
  pthread_mutex_lock(&g_mutex);
  while (!g_over) {
    while (g_turn != 1 && !g_over) pthread_cond_wait(&g_turned, &g_mutex);
    g_turn = 0;
    pthread_cond_signal(&g_turned);
  }
  pthread_mutex_unlock(&g_mutex);
  return argument;
}
static void Turn(void) {
  pthread_mutex_lock(&g_mutex);
  g_turn = 1;
  pthread_cond_signal(&g_turned);
  while (g_turn != 0) pthread_cond_wait(&g_turned, &g_mutex);
  pthread_mutex_unlock(&g_mutex);
}
static void* Yields(void* argument) {
  while (!__atomic_load_n(&g_over, __ATOMIC_RELAXED)) sched_yield();
  return argument;
}
static void Threads(void) {
  pthread_t thread;
  pthread_create(&thread, NULL, Other, NULL);
  Measure("condition_ping_pong", 2000, Turn);
  pthread_mutex_lock(&g_mutex);
  g_over = 1;
  pthread_cond_signal(&g_turned);
  pthread_mutex_unlock(&g_mutex);
  pthread_join(thread, NULL);
  g_over = 0;
  pthread_create(&thread, NULL, Yields, NULL);
  Measure("yield_between_two", 5000, Yield);
  g_over = 1;
  pthread_join(thread, NULL);
}

int main(int argc, char** argv) {
  if (argc > 1) g_batches = atoi(argv[1]);
  g_null = open("/dev/null", O_WRONLY);
  g_zero = open("/dev/zero", O_RDONLY);
  g_file = open(".", O_TMPFILE | O_RDWR, 0600);
  g_event = eventfd(0, 0);
  Check(g_null >= 0 && g_zero >= 0 && g_file >= 0 && g_event >= 0 && pipe(g_pipe) == 0, "open");
  signal(SIGUSR1, Ignore);
  Measure("getppid", 20000, GetParent);
  Measure("memcpy_64K", 2000, Copy);
  Measure("malloc", 100000, Allocate);
  Measure("mutex", 100000, Lock);
  Measure("page_fault", 5000, Fault);
  Measure("write_file_4K", 5000, WriteFile);
  Measure("read_file_4K", 5000, ReadFile);
  Measure("write_null", 20000, WriteNull);
  Measure("read_zero_64", 20000, ReadZero);
  Measure("own_pipe", 10000, OwnPipe);
  Measure("own_eventfd", 10000, OwnEvent);
  Check(write(g_pipe[1], g_a, 1) == 1, "write");
  g_polled = (struct pollfd){.fd = g_pipe[0], .events = POLLIN};
  Measure("poll", 10000, Poll);
  g_epoll = epoll_create1(0);
  for (int i = 0; i < 10; ++i) {
    int fds[2];
    Check(pipe(fds) == 0 && write(fds[1], g_a, 1) == 1, "pipe");
    struct epoll_event event = {.events = EPOLLIN};
    Check(epoll_ctl(g_epoll, EPOLL_CTL_ADD, fds[0], &event) == 0, "epoll_ctl");
  }
  Measure("epoll_of_10", 5000, Epoll);
  Measure("signal_itself", 5000, SignalItself);
  PingPongs();
  Threads();
  Measure("fork_and_wait", 50, ForkAndWait);
  Measure("fork_exec_wait", 20, Execute);
  Measure("thread", 300, Thread);
  return 0;
}
