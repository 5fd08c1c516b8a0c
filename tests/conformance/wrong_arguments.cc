// Calls with arguments that make no sense: each has the kernel's error, at once.
#include <fcntl.h>
#include <linux/futex.h>
#include <mqueue.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/msg.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/sem.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/timex.h>
#include <sys/uio.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kNobody = 0x3ffffff;  // no process or thread has this number
const timespec kNegative{-1, 0}, kNegativeNs{0, -1}, kTooMany{0, kSecond}, kShort{0, 1'000'000};

void Check(const char* call, long result, int wanted) {
  const int error = result < 0 ? errno : 0;
  EXPECT(error == wanted, "%s: %s instead of %s", call, strerrorname_np(error),
         strerrorname_np(wanted));
}

#define FAILS(error, ...) Check(#__VA_ARGS__, static_cast<long>(__VA_ARGS__), error)
#define WORKS(...) FAILS(0, __VA_ARGS__)
// Of functions that return the error.
#define RETURNS(error, ...) Check(#__VA_ARGS__, (errno = (__VA_ARGS__)) == 0 ? 0 : -1, error)

long Futex(void* word, int operation, std::uint32_t value, const void* timeout = nullptr,
           void* other = nullptr, std::uint32_t last = 0) {
  return syscall(SYS_futex, word, operation, value, timeout, other, last);
}

void Futexes() {
  alignas(8) std::uint32_t word[4] = {};
  char* odd = reinterpret_cast<char*>(word) + 1;
  void* nowhere = reinterpret_cast<void*>(4096);
  void* no_address = reinterpret_cast<void*>(1ul << 63);
  const void* one = reinterpret_cast<void*>(1);
  const void* minus_one = reinterpret_cast<void*>(-1);
  FAILS(ENOSYS, Futex(word, 200, 0));
  FAILS(ENOSYS, Futex(word, FUTEX_FD, 0));
  FAILS(ENOSYS, Futex(word, FUTEX_WAIT | 0x200, 0, &kShort));
  FAILS(ENOSYS, Futex(word, FUTEX_WAKE | 0x400, 1));
  for (const int operation : {FUTEX_WAIT, FUTEX_WAKE, FUTEX_LOCK_PI, FUTEX_REQUEUE}) {
    FAILS(ENOSYS, Futex(word, operation | FUTEX_CLOCK_REALTIME, 0, &kShort, word + 1));
  }
  FAILS(EINVAL, Futex(odd, FUTEX_WAIT, 0, &kShort));
  FAILS(EINVAL, Futex(odd, FUTEX_WAKE, 1));
  FAILS(EINVAL, Futex(odd, FUTEX_WAKE_BITSET, 1, nullptr, nullptr, 1));
  FAILS(EINVAL, Futex(odd, FUTEX_REQUEUE, 1, one, word));
  FAILS(EINVAL, Futex(word, FUTEX_REQUEUE, 1, one, odd));
  FAILS(EINVAL, Futex(word, FUTEX_CMP_REQUEUE, 1, one, odd, 0));
  FAILS(EINVAL, Futex(word, FUTEX_WAKE_OP, 1, one, odd, 0));
  FAILS(EINVAL, Futex(odd, FUTEX_LOCK_PI, 0));
  FAILS(EINVAL, Futex(odd, FUTEX_TRYLOCK_PI, 0));
  FAILS(EPERM, Futex(word, FUTEX_UNLOCK_PI, 0));
  FAILS(EINVAL, Futex(word, FUTEX_WAKE_BITSET, 1));
  FAILS(EINVAL, Futex(word, FUTEX_WAIT_BITSET, 0, &kShort));
  FAILS(EINVAL, Futex(word, FUTEX_REQUEUE, -1u, one, word + 1));
  FAILS(EINVAL, Futex(word, FUTEX_REQUEUE, 1, minus_one, word + 1));
  FAILS(EINVAL, Futex(word, FUTEX_CMP_REQUEUE, 1, minus_one, word + 1, 0));
  FAILS(ENOSYS, Futex(word, FUTEX_WAKE_OP, 1, one, word + 1, FUTEX_OP(0, 0, 15, 0)));
  FAILS(ENOSYS, Futex(word, FUTEX_WAKE_OP, 1, one, word + 1, FUTEX_OP(5, 0, 0, 0)));
  FAILS(EFAULT, Futex(nullptr, FUTEX_WAKE, 1));
  FAILS(EFAULT, Futex(nowhere, FUTEX_WAKE, 1));
  FAILS(EFAULT, Futex(no_address, FUTEX_WAKE_PRIVATE, 1));
  WORKS(Futex(nowhere, FUTEX_WAKE_PRIVATE, 1));
  FAILS(EFAULT, Futex(word, FUTEX_REQUEUE, 1, one, nowhere));
  WORKS(Futex(word, FUTEX_REQUEUE_PRIVATE, 1, one, nowhere));
  FAILS(EFAULT, Futex(word, FUTEX_WAKE_OP, 1, one, nowhere, 0));
  for (const int operation : {FUTEX_LOCK_PI, FUTEX_TRYLOCK_PI, FUTEX_UNLOCK_PI}) {
    FAILS(EFAULT, Futex(nowhere, operation, 0));
  }
  for (const int operation : {FUTEX_WAIT, FUTEX_LOCK_PI}) {
    word[0] = 0;
    for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
      FAILS(EINVAL, Futex(word, operation, 1, &wrong));
    }
    FAILS(EFAULT, Futex(word, operation, 1, nowhere));
  }
  word[0] = kNobody;
  FAILS(ESRCH, Futex(word, FUTEX_LOCK_PI, 0));
  FAILS(EPERM, Futex(word, FUTEX_UNLOCK_PI, 0));
  word[0] = static_cast<std::uint32_t>(gettid());
  FAILS(EDEADLK, Futex(word, FUTEX_LOCK_PI, 0));
  FAILS(EDEADLK, Futex(word, FUTEX_TRYLOCK_PI, 0));
}

// The kernel looks at how many it was to wake only when it has woken one.
void WakingNobodyWakesOne() {
  static std::uint32_t word;
  word = 0;
  pthread_t thread;
  const auto wait = [](void*) -> void* {
    return reinterpret_cast<void*>(Futex(&word, FUTEX_WAIT_PRIVATE, 0));
  };
  EXPECT(pthread_create(&thread, nullptr, wait, nullptr) == 0, "pthread_create");
  long woken = 0;
  for (int turn = 0; turn < 500 && woken == 0; ++turn) {
    usleep(5'000);
    woken = Futex(&word, FUTEX_WAKE_PRIVATE, 0);
  }
  EXPECT(woken == 1, "%ld woken", woken);
  pthread_join(thread, nullptr);
}

void Epolls(int socket) {
  const int set = epoll_create1(0), file = open("/proc/self/exe", O_RDONLY);
  epoll_event found[4];
  sigset_t none;
  sigemptyset(&none);
  for (const int most : {0, -1, 0x7fffffff, 0x7fffffff / 12 + 1}) {
    FAILS(EINVAL, epoll_wait(set, found, most, 0));
    FAILS(EINVAL, epoll_wait(set, found, most, -1));
    FAILS(EINVAL, epoll_pwait(set, found, most, -1, &none));
    FAILS(EINVAL, syscall(SYS_epoll_wait, set, found, most, -1));
  }
  for (const int timeout : {0, 100, -1}) {
    FAILS(EBADF, epoll_wait(-1, found, 1, timeout));
    FAILS(EBADF, epoll_wait(999, found, 1, timeout));
    FAILS(EINVAL, epoll_wait(socket, found, 1, timeout));
    FAILS(EINVAL, epoll_wait(file, found, 1, timeout));
    FAILS(EBADF, epoll_pwait(-1, found, 1, timeout, &none));
    FAILS(EBADF, syscall(SYS_epoll_wait, -1, found, 1, timeout));
    FAILS(EINVAL, syscall(SYS_epoll_wait, socket, found, 1, timeout));
    FAILS(EINVAL, syscall(SYS_epoll_pwait, set, found, 1, timeout, &none, 4));
  }
  FAILS(EINVAL, epoll_pwait2(set, found, 1, &kNegative, nullptr));
  FAILS(EINVAL, epoll_pwait2(set, found, 1, &kTooMany, nullptr));
  FAILS(EBADF, epoll_pwait2(-1, found, 1, &kShort, nullptr));
  FAILS(EINVAL, syscall(SYS_epoll_pwait2, set, found, 1, &kNegative, nullptr, 8));
  FAILS(EINVAL, epoll_ctl(set, EPOLL_CTL_ADD, set, found));
  close(file);
  close(set);
}

void Messages(int socket) {
  const int file = open("/proc/self/exe", O_RDONLY);
  char text[8];
  iovec piece{text, sizeof text}, too_long{text, static_cast<std::size_t>(-1)};
  mmsghdr message{};
  message.msg_hdr.msg_iov = &piece;
  message.msg_hdr.msg_iovlen = 1;
  timespec timeout = kNegative;
  FAILS(EINVAL, recvmmsg(socket, &message, 1, 0, &timeout));
  FAILS(EINVAL, recvmmsg(-1, &message, 1, 0, &timeout));
  timeout = kTooMany;
  FAILS(EINVAL, recvmmsg(socket, &message, 1, 0, &timeout));
  for (const unsigned count : {0u, 1u}) {
    FAILS(EBADF, recvmmsg(-1, &message, count, 0, nullptr));
    FAILS(EBADF, sendmmsg(-1, &message, count, 0));
    FAILS(ENOTSOCK, recvmmsg(file, &message, count, 0, nullptr));
    FAILS(ENOTSOCK, sendmmsg(file, &message, count, 0));
  }
  WORKS(recvmmsg(socket, &message, 0, 0, nullptr));
  WORKS(sendmmsg(socket, &message, 0, 0));
  FAILS(EAGAIN, recvmmsg(socket, &message, 1, MSG_DONTWAIT, nullptr));
  message.msg_hdr.msg_iovlen = 2000;
  FAILS(EMSGSIZE, recvmmsg(socket, &message, 1, 0, nullptr));
  FAILS(EMSGSIZE, sendmmsg(socket, &message, 1, 0));
  FAILS(EMSGSIZE, recvmsg(socket, &message.msg_hdr, 0));
  FAILS(EMSGSIZE, sendmsg(socket, &message.msg_hdr, 0));
  for (const int count : {-1, 2000}) {
    FAILS(EINVAL, readv(socket, &piece, count));
    FAILS(EINVAL, writev(socket, &piece, count));
  }
  FAILS(EINVAL, readv(socket, &too_long, 1));
  FAILS(EINVAL, writev(socket, &too_long, 1));
  FAILS(EBADF, accept(-1, nullptr, nullptr));
  FAILS(ENOTSOCK, accept(file, nullptr, nullptr));
  FAILS(EINVAL, accept(socket, nullptr, nullptr));
  FAILS(EINVAL, accept4(socket, nullptr, nullptr, 0xffff));
  FAILS(ENOTSOCK, recv(file, text, 1, 0));
  close(file);
}

void Affinities() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  FAILS(EINVAL, sched_setaffinity(0, sizeof cores, &cores));
  FAILS(EINVAL, sched_setaffinity(0, 0, &cores));
  RETURNS(EINVAL, pthread_setaffinity_np(pthread_self(), sizeof cores, &cores));
  FAILS(EINVAL, syscall(SYS_sched_setaffinity, 0, 8, &cores));
  CPU_SET(1000, &cores);
  FAILS(EINVAL, sched_setaffinity(0, sizeof cores, &cores));
  CPU_SET(63, &cores);
  FAILS(EINVAL, sched_setaffinity(0, sizeof cores, &cores));
  CPU_SET(0, &cores);
  WORKS(sched_setaffinity(0, sizeof cores, &cores));
  WORKS(sched_setaffinity(0, 1, &cores));
  FAILS(ESRCH, sched_setaffinity(kNobody, sizeof cores, &cores));
  FAILS(ESRCH, sched_setaffinity(-1, sizeof cores, &cores));
  for (const std::size_t size : {0, 4, 12}) {
    FAILS(EINVAL, sched_getaffinity(0, size, &cores));
    FAILS(EINVAL, syscall(SYS_sched_getaffinity, 0, size, &cores));
  }
  RETURNS(EINVAL, pthread_getaffinity_np(pthread_self(), 4, &cores));
  FAILS(ESRCH, sched_getaffinity(kNobody, sizeof cores, &cores));
  FAILS(ESRCH, sched_getaffinity(-1, sizeof cores, &cores));
}

void Policies() {
  sched_param param{0};
  timespec interval;
  FAILS(EINVAL, sched_setscheduler(0, -1, &param));
  FAILS(EINVAL, sched_setscheduler(-1, SCHED_OTHER, &param));
  FAILS(EINVAL, sched_setscheduler(0, 99, &param));
  FAILS(EINVAL, sched_getscheduler(-1));
  FAILS(ESRCH, sched_getscheduler(kNobody));
  FAILS(EINVAL, sched_getparam(-1, &param));
  FAILS(EINVAL, sched_rr_get_interval(-1, &interval));
  FAILS(ESRCH, sched_rr_get_interval(kNobody, &interval));
  param.sched_priority = 5;
  FAILS(EINVAL, sched_setscheduler(0, SCHED_OTHER, &param));
  FAILS(EINVAL, sched_setparam(0, &param));
  RETURNS(EINVAL, pthread_setschedparam(pthread_self(), 99, &param));
  RETURNS(EINVAL, pthread_setschedprio(pthread_self(), 5));
}

void SettingClocks() {
  struct timezone zone {};
  timeval now{};
  WORKS(gettimeofday(&now, &zone));
  for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
    FAILS(EINVAL, clock_settime(CLOCK_REALTIME, &wrong));
  }
  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_BOOTTIME, CLOCK_TAI, CLOCK_REALTIME_COARSE,
                                CLOCK_PROCESS_CPUTIME_ID, CLOCK_THREAD_CPUTIME_ID, 77, -5}) {
    FAILS(EINVAL, clock_settime(clock, &kShort));
  }
  FAILS(EINVAL, settimeofday(&now, &zone));
  for (const timeval& wrong : {timeval{-1, 0}, timeval{0, -1}, timeval{0, 1'000'000}}) {
    FAILS(EINVAL, settimeofday(&wrong, nullptr));
  }
  timex adjustment{};
  for (const unsigned modes : {0u, 0xffffu}) {
    adjustment.modes = modes;
    FAILS(EINVAL, clock_adjtime(77, &adjustment));
    FAILS(EOPNOTSUPP, clock_adjtime(CLOCK_MONOTONIC, &adjustment));
  }
}

void Polls() {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  static pollfd fds[101];
  for (pollfd& fd : fds) fd.fd = -1;
  const rlimit low{100, limit.rlim_max};
  EXPECT(setrlimit(RLIMIT_NOFILE, &low) == 0, "setrlimit");
  for (const int timeout : {0, 10, -1}) {
    FAILS(EINVAL, poll(fds, 101, timeout));
    FAILS(EINVAL, syscall(SYS_poll, fds, 101, timeout));
  }
  FAILS(EINVAL, ppoll(fds, 101, &kShort, nullptr));
  WORKS(poll(fds, 100, 1));
  setrlimit(RLIMIT_NOFILE, &limit);
  sigset_t none;
  sigemptyset(&none);
  for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
    FAILS(EINVAL, ppoll(fds, 1, &wrong, nullptr));
    FAILS(EINVAL, pselect(0, nullptr, nullptr, nullptr, &wrong, nullptr));
    FAILS(EINVAL, syscall(SYS_ppoll, fds, 1, &wrong, nullptr, 8));
  }
  FAILS(EINVAL, syscall(SYS_ppoll, fds, 1, &kShort, &none, 4));
  for (timeval wrong : {timeval{-1, 0}, timeval{0, -1}}) {
    FAILS(EINVAL, select(0, nullptr, nullptr, nullptr, &wrong));
    FAILS(EINVAL, syscall(SYS_select, 0, nullptr, nullptr, nullptr, &wrong));
  }
  FAILS(EINVAL, select(-1, nullptr, nullptr, nullptr, nullptr));
  FAILS(EINVAL, syscall(SYS_select, -1, nullptr, nullptr, nullptr, nullptr));
  FAILS(EINVAL, pselect(-1, nullptr, nullptr, nullptr, &kShort, nullptr));
}

constexpr clockid_t CpuClock(int number, int kind) {
  return static_cast<clockid_t>(~static_cast<unsigned>(number) << 3) | kind;
}
constexpr int kOfProcess = 2, kOfThread = 6, kOfDescriptor = 3;

void Sleeps() {
  for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
    FAILS(EINVAL, nanosleep(&wrong, nullptr));
    RETURNS(EINVAL, clock_nanosleep(CLOCK_MONOTONIC, 0, &wrong, nullptr));
    RETURNS(EINVAL, clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wrong, nullptr));
  }
  for (const clockid_t clock :
       {77, 10, 12, -1, CLOCK_THREAD_CPUTIME_ID, CpuClock(kNobody, kOfProcess),
        CpuClock(kNobody, kOfThread), CpuClock(0, kOfThread), CpuClock(gettid(), kOfThread)}) {
    RETURNS(EINVAL, clock_nanosleep(clock, 0, &kShort, nullptr));
  }
  for (const clockid_t clock :
       {CLOCK_MONOTONIC_RAW, CLOCK_MONOTONIC_COARSE, CLOCK_REALTIME_COARSE}) {
    RETURNS(EOPNOTSUPP, clock_nanosleep(clock, 0, &kShort, nullptr));
  }
  const sigset_t none{};
  FAILS(EINVAL, sigtimedwait(&none, nullptr, &kNegative));
  FAILS(EINVAL, sigtimedwait(&none, nullptr, &kTooMany));
}

void ProcessorClocks() {
  timespec found;
  clockid_t clock;
  for (const clockid_t wrong :
       {77, 10, 12, -1, CpuClock(kNobody, kOfProcess), CpuClock(kNobody, kOfThread),
        CpuClock(getppid(), kOfThread), CpuClock(getpid(), kOfDescriptor),
        CpuClock(getpid(), kOfDescriptor | 4)}) {
    FAILS(EINVAL, clock_gettime(wrong, &found));
    FAILS(EINVAL, clock_getres(wrong, &found));
    FAILS(EINVAL, clock_getres(wrong, nullptr));
  }
  RETURNS(ESRCH, clock_getcpuclockid(kNobody, &clock));
  RETURNS(0, clock_getcpuclockid(getppid(), &clock));
  WORKS(clock_gettime(clock, &found));
  WORKS(clock_getres(clock, &found));
  // Of a thread that has ended.
  pthread_t thread;
  const auto report = [](void* clock) -> void* {
    pthread_getcpuclockid(pthread_self(), static_cast<clockid_t*>(clock));
    return nullptr;
  };
  EXPECT(pthread_create(&thread, nullptr, report, &clock) == 0, "pthread_create");
  pthread_join(thread, nullptr);
  FAILS(EINVAL, clock_gettime(clock, &found));
  FAILS(EINVAL, clock_getres(clock, &found));
  RETURNS(EINVAL, clock_nanosleep(clock, 0, &kShort, nullptr));
}

void IntervalTimers() {
  for (const timeval& wrong : {timeval{-1, 0}, timeval{0, -1}, timeval{0, 1'000'000}}) {
    const itimerval first{{0, 0}, wrong}, interval{wrong, {0, 0}};
    FAILS(EINVAL, setitimer(ITIMER_REAL, &first, nullptr));
    FAILS(EINVAL, setitimer(ITIMER_REAL, &interval, nullptr));
  }
  itimerval value{};
  for (const int which : {3, -1}) {
    FAILS(EINVAL, setitimer(static_cast<__itimer_which_t>(which), &value, nullptr));
    FAILS(EINVAL, getitimer(static_cast<__itimer_which_t>(which), &value));
  }
}

int CreateTimer(clockid_t clock, int notify, int signal, pid_t tid = 0) {
  sigevent event{};
  event.sigev_notify = notify;
  event.sigev_signo = signal;
  event._sigev_un._tid = tid;
  timer_t timer;
  const int result = timer_create(clock, &event, &timer);
  if (result == 0) timer_delete(timer);
  return result;
}

void PosixTimers() {
  FAILS(EINVAL, CreateTimer(CLOCK_MONOTONIC, 77, SIGUSR1));
  for (const int signal : {0, 65, -1}) {
    FAILS(EINVAL, CreateTimer(CLOCK_MONOTONIC, SIGEV_SIGNAL, signal));
  }
  FAILS(EINVAL, CreateTimer(CLOCK_MONOTONIC, SIGEV_THREAD_ID, SIGUSR1, kNobody));
  FAILS(EINVAL, CreateTimer(CLOCK_MONOTONIC, SIGEV_THREAD_ID, SIGUSR1, getppid()));
  WORKS(CreateTimer(CLOCK_MONOTONIC, SIGEV_NONE, 999));
  for (const clockid_t clock : {77, 10, CpuClock(kNobody, kOfProcess), CpuClock(kNobody, kOfThread),
                                CpuClock(getppid(), kOfThread)}) {
    FAILS(EINVAL, CreateTimer(clock, SIGEV_NONE, 0));
  }
  FAILS(EOPNOTSUPP, CreateTimer(CLOCK_MONOTONIC_RAW, SIGEV_NONE, 0));
  FAILS(EOPNOTSUPP, CreateTimer(CLOCK_MONOTONIC_COARSE, SIGEV_NONE, 0));
  timer_t timer;
  WORKS(timer_create(CLOCK_MONOTONIC, nullptr, &timer));
  for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
    const itimerspec first{{0, 0}, wrong}, interval{wrong, {0, 0}};
    FAILS(EINVAL, timer_settime(timer, 0, &first, nullptr));
    FAILS(EINVAL, timer_settime(timer, 0, &interval, nullptr));
  }
  const itimerspec off{};
  itimerspec found;
  WORKS(timer_settime(timer, 0xff, &off, nullptr));
  WORKS(timer_delete(timer));
  FAILS(EINVAL, timer_delete(timer));
  FAILS(EINVAL, timer_settime(timer, 0, &off, nullptr));
  FAILS(EINVAL, timer_gettime(timer, &found));
  FAILS(EINVAL, timer_getoverrun(timer));
}

void TimerDescriptors(int socket) {
  for (const int clock : {77, CLOCK_TAI, CLOCK_PROCESS_CPUTIME_ID, -1}) {
    FAILS(EINVAL, timerfd_create(clock, 0));
  }
  FAILS(EINVAL, timerfd_create(CLOCK_MONOTONIC, 1));
  const int fd = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  const itimerspec off{};
  itimerspec found;
  for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
    const itimerspec first{{0, 0}, wrong}, interval{wrong, {0, 0}};
    FAILS(EINVAL, timerfd_settime(fd, 0, &first, nullptr));
    FAILS(EINVAL, timerfd_settime(fd, 0, &interval, nullptr));
  }
  FAILS(EINVAL, timerfd_settime(fd, 99, &off, nullptr));
  FAILS(EBADF, timerfd_settime(-1, 0, &off, nullptr));
  FAILS(EINVAL, timerfd_settime(socket, 0, &off, nullptr));
  FAILS(EBADF, timerfd_gettime(-1, &found));
  FAILS(EINVAL, timerfd_gettime(socket, &found));
  std::uint64_t count = 1;
  FAILS(EINVAL, read(fd, &count, 4));
  FAILS(EAGAIN, read(fd, &count, 8));
  FAILS(EINVAL, write(fd, &count, 8));
  FAILS(EAGAIN, read(fd, &count, 8));
  close(fd);
}

void SystemVAndQueues(int socket) {
  const int semaphores = semget(IPC_PRIVATE, 2, 0600), messages = msgget(IPC_PRIVATE, 0600);
  sembuf take{0, -1, 0}, beyond{7, -1, 0};
  FAILS(EINVAL, semop(semaphores, &take, 0));
  FAILS(EINVAL, semop(-1, &take, 1));
  FAILS(EFBIG, semop(semaphores, &beyond, 1));
  FAILS(E2BIG, semtimedop(semaphores, &take, 501, &kShort));
  for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
    FAILS(EINVAL, semtimedop(semaphores, &take, 1, &wrong));
  }
  FAILS(EAGAIN, semtimedop(semaphores, &take, 1, &kShort));
  struct {
    long type = 0;
    char text[4] = {};
  } message;
  FAILS(EINVAL, msgsnd(messages, &message, 1, 0));
  FAILS(EINVAL, msgrcv(messages, &message, static_cast<std::size_t>(-1), 0, 0));
  FAILS(EINVAL, msgrcv(-1, &message, 4, 0, 0));
  semctl(semaphores, 0, IPC_RMID);
  msgctl(messages, IPC_RMID, nullptr);
  mq_attr attributes{};
  attributes.mq_maxmsg = 2;
  attributes.mq_msgsize = 8;
  char name[40];
  snprintf(name, sizeof name, "/tcs_wrong_arguments_%d", getpid());
  const mqd_t queue = mq_open(name, O_RDWR | O_CREAT, 0600, &attributes);
  mq_unlink(name);
  char text[16] = {};
  for (const timespec& wrong : {kNegative, kNegativeNs, kTooMany}) {
    FAILS(EINVAL, mq_timedreceive(queue, text, 8, nullptr, &wrong));
    FAILS(EINVAL, mq_timedsend(queue, text, 1, 0, &wrong));
  }
  FAILS(EMSGSIZE, mq_timedreceive(queue, text, 4, nullptr, &kShort));
  FAILS(EBADF, mq_timedreceive(-1, text, 8, nullptr, &kShort));
  FAILS(EMSGSIZE, mq_timedsend(queue, text, 9, 0, &kShort));
  FAILS(EINVAL, mq_timedsend(queue, text, 8, 99'999, &kShort));
  FAILS(EBADF, mq_receive(socket, text, 8, nullptr));
  FAILS(ETIMEDOUT, mq_timedreceive(queue, text, 8, nullptr, &kShort));
  mq_close(queue);
}

void Children() {
  siginfo_t info;
  FAILS(ECHILD, waitpid(-1, nullptr, 0));
  for (const bool has_child : {false, true}) {
    const pid_t child = has_child ? fork() : -1;
    if (child == 0) {
      usleep(100'000);
      _exit(0);
    }
    FAILS(ECHILD, waitpid(kNobody, nullptr, 0));
    FAILS(EINVAL, wait4(0, nullptr, 0x1000, nullptr));
    FAILS(EINVAL, waitid(P_ALL, 0, &info, 0));
    FAILS(EINVAL, waitid(static_cast<idtype_t>(9), 0, &info, WEXITED));
    FAILS(EINVAL, waitid(P_PID, 0, &info, WEXITED));
  }
  WORKS(wait(nullptr));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  int ends[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0, "socketpair");
  Futexes();
  WakingNobodyWakesOne();
  Epolls(ends[0]);
  Messages(ends[0]);
  Affinities();
  Policies();
  SettingClocks();
  Polls();
  Sleeps();
  ProcessorClocks();
  IntervalTimers();
  PosixTimers();
  TimerDescriptors(ends[0]);
  SystemVAndQueues(ends[0]);
  Children();
}
