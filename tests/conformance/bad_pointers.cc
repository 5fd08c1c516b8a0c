// Pointers to where nothing is: what only the kernel looks at is EFAULT, or whatever else the
// kernel says first, and never a signal.
#include <fcntl.h>
#include <gnu/libc-version.h>
#include <mqueue.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/msg.h>
#include <sys/random.h>
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
#include "tests/conformance/rights.h"

using namespace conformance;

namespace {

// Where nothing can be read, or where something can be read but not written, or only in part.
struct Place {
  const char* name;
  char* at;
};

template <class T>
T* As(const Place& place) {
  return reinterpret_cast<T*>(place.at);
}

// `result` is of a call that leaves its error in errno.
void ExpectError(const Place& place, const char* call, long result, int wanted) {
  EXPECT(result == -1 && errno == wanted, "%s, %s: %ld, %s", call, place.name, result,
         result == -1 ? strerrorname_np(errno) : "no error");
}
void ExpectFault(const Place& place, const char* call, long result) {
  ExpectError(place, call, result, EFAULT);
}

const Place* g_place = nullptr;
#define FAULTS(call) ExpectFault(*g_place, #call, call)
#define FAILS(error, call) ExpectError(*g_place, #call, call, error)

struct Sockets {
  int stream[2], datagram[2];
  Sockets() {
    EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, stream) == 0, "%s", strerror(errno));
    EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, datagram) == 0, "%s", strerror(errno));
  }
};

void OnSignal(int) {}

void Waits(const Place& p) {
  siginfo_t info;
  const timespec none{};
  sigset_t set;
  sigemptyset(&set);
  FAULTS(nanosleep(As<timespec>(p), nullptr));
  errno = clock_nanosleep(CLOCK_MONOTONIC, 0, As<timespec>(p), nullptr);
  FAULTS(-(errno != 0));
  FAULTS(sigsuspend(As<sigset_t>(p)));
  FAULTS(sigtimedwait(As<sigset_t>(p), &info, &none));
  FAULTS(sigwaitinfo(As<sigset_t>(p), &info));
  int signal;
  errno = sigwait(As<sigset_t>(p), &signal);
  FAULTS(-(errno != 0));
  FAULTS(signalfd(-1, As<sigset_t>(p), 0));
  FAULTS(poll(As<pollfd>(p), 1, 0));
  FAULTS(poll(As<pollfd>(p), 1, 10));
  FAULTS(ppoll(As<pollfd>(p), 1, &none, nullptr));
  if (p.at == nullptr) return;  // which these take for nothing wanted
  FAULTS(sigtimedwait(&set, &info, As<timespec>(p)));
  FAULTS(ppoll(nullptr, 0, &none, As<sigset_t>(p)));
  FAULTS(pselect(0, nullptr, nullptr, nullptr, &none, As<sigset_t>(p)));
  FAULTS(select(1, As<fd_set>(p), nullptr, nullptr, nullptr));
  timeval limit{0, 10'000};
  FAULTS(select(1, nullptr, As<fd_set>(p), nullptr, &limit));
}

void Epolls(const Place& p) {
  const int set = epoll_create1(0), event = eventfd(1, 0);
  epoll_event wanted{};
  wanted.events = EPOLLIN;
  EXPECT(epoll_ctl(set, EPOLL_CTL_ADD, event, &wanted) == 0, "%s", strerror(errno));
  FAULTS(epoll_wait(set, As<epoll_event>(p), 1, 0));
  FAULTS(epoll_wait(set, As<epoll_event>(p), 1, 10));
  FAULTS(epoll_wait(set, As<epoll_event>(p), 1, -1));
  if (p.at != nullptr) {
    epoll_event found;
    FAULTS(epoll_pwait(set, &found, 1, 0, As<sigset_t>(p)));
    FAULTS(epoll_pwait2(set, &found, 1, As<timespec>(p), nullptr));
  }
  // What could not be handed over is still there.
  EXPECT(epoll_wait(set, &wanted, 1, 0) == 1, "the event is lost");
  close(event);
  close(set);
}

void Sends(const Place& p, const Sockets& s) {
  const int fd = s.stream[0];
  char text[16] = {};
  msghdr message{};
  message.msg_iov = As<iovec>(p);
  message.msg_iovlen = 1;
  mmsghdr messages{message, 0};
  FAULTS(sendmsg(fd, As<msghdr>(p), 0));
  FAULTS(sendmsg(fd, &message, 0));
  FAULTS(sendmmsg(fd, As<mmsghdr>(p), 1, 0));
  FAULTS(sendmmsg(fd, &messages, 1, 0));
  FAULTS(writev(fd, As<iovec>(p), 1));
  iovec piece{p.at, 16};
  message.msg_iov = &piece;
  FAULTS(sendmsg(fd, &message, 0));
  FAULTS(send(fd, p.at, 16, 0));
  FAULTS(write(fd, p.at, 16));
  FAULTS(writev(fd, &piece, 1));
  FAULTS(connect(s.datagram[0], As<sockaddr>(p), 16));
  FAILS(EBADF, sendmsg(-1, As<msghdr>(p), 0));
  FAILS(EBADF, sendmmsg(-1, As<mmsghdr>(p), 1, 0));
  FAILS(EBADF, writev(-1, As<iovec>(p), 1));
  if (p.at == nullptr) return;
  piece.iov_base = text;
  message.msg_name = p.at;
  message.msg_namelen = 16;
  FAULTS(sendmsg(s.datagram[0], &message, 0));
}

void Receives(const Place& p, const Sockets& s) {
  const int fd = s.stream[0];
  msghdr message{};
  message.msg_iov = As<iovec>(p);
  message.msg_iovlen = 1;
  mmsghdr messages{message, 0};
  // With nothing to receive: none of them waits for it.
  FAULTS(recvmsg(fd, As<msghdr>(p), 0));
  FAULTS(recvmsg(fd, &message, 0));
  FAULTS(recvmsg(fd, &message, MSG_WAITALL));
  FAULTS(recvmmsg(fd, As<mmsghdr>(p), 1, 0, nullptr));
  FAULTS(recvmmsg(fd, &messages, 1, 0, nullptr));
  FAULTS(readv(fd, As<iovec>(p), 1));
  if (p.at != nullptr) FAULTS(recvmmsg(fd, &messages, 1, 0, As<timespec>(p)));
}

void ReceivesInto(const Place& p, const Sockets& s) {
  const int fd = s.stream[0];
  EXPECT(write(s.stream[1], "12345678", 8) == 8, "%s", strerror(errno));
  FAULTS(recv(fd, p.at, 4, 0));
  FAULTS(recv(fd, p.at, 4, MSG_WAITALL));
  FAULTS(read(fd, p.at, 4));
  char text[16];
  EXPECT(recv(fd, text, sizeof text, MSG_DONTWAIT) == 8, "something was lost");
}

void Queues(const Place& p) {
  mq_attr attributes{};
  attributes.mq_maxmsg = 2;
  attributes.mq_msgsize = 16;
  char name[40];
  snprintf(name, sizeof name, "/tcs_bad_pointers_%d", getpid());
  const mqd_t queue = mq_open(name, O_RDWR | O_CREAT, 0600, &attributes);
  EXPECT(queue >= 0, "mq_open: %s", strerror(errno));
  mq_unlink(name);
  const int semaphores = semget(IPC_PRIVATE, 1, 0600), messages = msgget(IPC_PRIVATE, 0600);
  char text[16];
  sembuf take{0, -1, 0};
  FAULTS(mq_send(queue, p.at, 2, 0));
  FAULTS(semop(semaphores, As<sembuf>(p), 1));
  FAULTS(msgsnd(messages, p.at, 1, 0));
  if (p.at != nullptr) {
    FAULTS(mq_timedsend(queue, "x", 1, 0, As<timespec>(p)));
    FAULTS(mq_timedreceive(queue, text, 16, nullptr, As<timespec>(p)));
    FAULTS(semtimedop(semaphores, &take, 1, As<timespec>(p)));
  }
  semctl(semaphores, 0, IPC_RMID);
  msgctl(messages, IPC_RMID, nullptr);
  mq_close(queue);
}

// What the calls read.
void Settings(const Place& p) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, 0);
  timer_t timer;
  sigevent none{};
  none.sigev_notify = SIGEV_NONE;
  EXPECT(timer_create(CLOCK_MONOTONIC, &none, &timer) == 0, "%s", strerror(errno));
  FAULTS(timerfd_settime(fd, 0, As<itimerspec>(p), nullptr));
  FAULTS(adjtimex(As<timex>(p)));
  FAULTS(clock_adjtime(CLOCK_REALTIME, As<timex>(p)));
  FAULTS(sched_setaffinity(0, sizeof(cpu_set_t), As<cpu_set_t>(p)));
  errno = pthread_setaffinity_np(pthread_self(), sizeof(cpu_set_t), As<cpu_set_t>(p));
  FAULTS(-(errno != 0));
  const int null_is = p.at == nullptr ? EINVAL : EFAULT;
  FAILS(null_is, timer_settime(timer, 0, As<itimerspec>(p), nullptr));
  FAILS(null_is, sched_setparam(0, As<sched_param>(p)));
  FAILS(null_is, sched_setscheduler(0, SCHED_OTHER, As<sched_param>(p)));
  if (p.at != nullptr) {
    char name[] = "x";
    char* arguments[] = {name, nullptr};
    FAULTS(setitimer(ITIMER_REAL, As<itimerval>(p), nullptr));
    FAULTS(execve("/bin/true", arguments, As<char*>(p)));
    FAULTS(execve("/bin/true", As<char*>(p), environ));
    // A list that is there, of strings that are not.
    char* strings[] = {name, p.at, nullptr};
    FAULTS(execve("/bin/true", arguments, strings));
  }
  timer_delete(timer);
  close(fd);
}

// From 2.41 on the C library draws by code of the kernel's that runs in the program (the vDSO), and
// ends it by SIGSEGV where it cannot write.
bool KernelDraws() {
  return g_mode != Mode::kNative || strverscmp(gnu_get_libc_version(), "2.41") < 0;
}

// What the calls write.
void Answers(const Place& p) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, 0);
  timer_t timer;
  sigevent none{};
  none.sigev_notify = SIGEV_NONE;
  EXPECT(timer_create(CLOCK_MONOTONIC, &none, &timer) == 0, "%s", strerror(errno));
  FAULTS(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, As<timespec>(p)));
  FAULTS(clock_gettime(CLOCK_THREAD_CPUTIME_ID, As<timespec>(p)));
  FAULTS(getrusage(RUSAGE_SELF, As<rusage>(p)));
  FAULTS(getitimer(ITIMER_REAL, As<itimerval>(p)));
  FAULTS(timerfd_gettime(fd, As<itimerspec>(p)));
  FAULTS(timer_gettime(timer, As<itimerspec>(p)));
  FAULTS(sched_rr_get_interval(0, As<timespec>(p)));
  FAULTS(sched_getaffinity(0, sizeof(cpu_set_t), As<cpu_set_t>(p)));
  errno = pthread_getaffinity_np(pthread_self(), sizeof(cpu_set_t), As<cpu_set_t>(p));
  FAULTS(-(errno != 0));
  FAULTS(syscall(SYS_getrandom, p.at, 16, 0));
  if (KernelDraws()) {
    FAULTS(getrandom(p.at, 16, 0));
    FAULTS(getentropy(p.at, 16));
  }
  FAILS(p.at == nullptr ? EINVAL : EFAULT, sched_getparam(0, As<sched_param>(p)));
  if (p.at != nullptr) {
    const itimerval no_value{};
    const itimerspec no_time{};
    FAULTS(setitimer(ITIMER_REAL, &no_value, As<itimerval>(p)));
    FAULTS(timerfd_settime(fd, 0, &no_time, As<itimerspec>(p)));
    FAULTS(timer_settime(timer, 0, &no_time, As<itimerspec>(p)));
    const itimerval soon{{0, 0}, {0, 100'000}};
    const timespec later{3, 0};
    setitimer(ITIMER_REAL, &soon, nullptr);
    FAULTS(nanosleep(&later, As<timespec>(p)));
  }
  timer_delete(timer);
  close(fd);
}

void AnswersOfOthers(const Place& p) {
  sigset_t user;
  sigemptyset(&user);
  sigaddset(&user, SIGUSR1);
  sigprocmask(SIG_BLOCK, &user, nullptr);
  raise(SIGUSR1);
  const timespec none{};
  FAULTS(sigtimedwait(&user, As<siginfo_t>(p), &none));
  sigtimedwait(&user, nullptr, &none);
  sigprocmask(SIG_UNBLOCK, &user, nullptr);
  const pid_t child = fork();
  if (child == 0) _exit(0);
  FAULTS(waitid(P_PID, static_cast<id_t>(child), As<siginfo_t>(p), WEXITED | WNOWAIT));
  FAULTS(waitpid(child, As<int>(p), 0));
}

// The same, made raw.
void Raw(const Place& p, bool writable) {
  FAULTS(syscall(SYS_poll, p.at, 1, 10));
  FAULTS(syscall(SYS_clock_gettime, CLOCK_MONOTONIC, p.at));
  FAULTS(syscall(SYS_sched_getaffinity, 0, 8, p.at));
  FAULTS(syscall(SYS_sched_rr_get_interval, 0, p.at));
  FAILS(p.at == nullptr ? EINVAL : EFAULT, syscall(SYS_sched_getparam, 0, p.at));
  FAILS(p.at == nullptr ? EINVAL : EFAULT, syscall(SYS_sched_getattr, 0, p.at, 48, 0));
  if (p.at != nullptr) FAULTS(syscall(SYS_gettimeofday, p.at, nullptr));
  if (p.at != nullptr) FAULTS(syscall(SYS_select, 1, p.at, nullptr, nullptr, nullptr));
  if (writable) return;
  FAULTS(syscall(SYS_nanosleep, p.at, nullptr));
  FAULTS(syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, p.at, nullptr));
  FAULTS(syscall(SYS_sched_setaffinity, 0, 8, p.at));
  FAILS(p.at == nullptr ? EINVAL : EFAULT, syscall(SYS_sched_setscheduler, 0, 0, p.at));
  if (!AreRealTimeCallsFiltered()) {
    FAILS(p.at == nullptr ? EINVAL : EFAULT, syscall(SYS_sched_setattr, 0, p.at, 0));
  }
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  struct sigaction action {};
  action.sa_handler = OnSignal;
  sigaction(SIGALRM, &action, nullptr);
  const long size = sysconf(_SC_PAGESIZE);
  auto* pages = static_cast<char*>(mmap(nullptr, static_cast<std::size_t>(2 * size), PROT_READ,
                                        MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  EXPECT(pages != MAP_FAILED, "%s", strerror(errno));
  EXPECT(mprotect(pages + size, static_cast<std::size_t>(size), PROT_NONE) == 0, "mprotect");
  const Sockets sockets;
  // The last begins in a page that can be read and ends in one that cannot.
  const Place nowhere[] = {{"null", nullptr},
                           {"address 1", reinterpret_cast<char*>(1)},
                           {"no address", reinterpret_cast<char*>(1ul << 63)},
                           {"a closed page", pages + size},
                           {"the end of a page", pages + size - 1}};
  for (const Place& place : nowhere) {
    g_place = &place;
    Waits(place);
    Epolls(place);
    Sends(place, sockets);
    Receives(place, sockets);
    ReceivesInto(place, sockets);
    Queues(place);
    Settings(place);
    Answers(place);
    if (place.at != nullptr) AnswersOfOthers(place);
    Raw(place, false);
  }
  const Place read_only{"a read-only page", pages + 64};
  g_place = &read_only;
  Epolls(read_only);
  ReceivesInto(read_only, sockets);
  Answers(read_only);
  AnswersOfOthers(read_only);
  Raw(read_only, true);
}
