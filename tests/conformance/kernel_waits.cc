// Waits that the kernel carries out where nobody sees them but by the thread not going on: they
// must end, however long they take.
#include <fcntl.h>
#include <mqueue.h>
#include <pthread.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <string>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

std::string g_folder;

// A child does `later` after a while, while the parent is in `wait`.
template <class Later, class Wait>
void Meanwhile(const char* what, Later later, Wait wait) {
  const pid_t parent = getpid();
  const pid_t pid = fork();
  EXPECT(pid >= 0, "fork");
  if (pid == 0) {
    usleep(50'000);
    later(parent);
    _exit(0);
  }
  wait();
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "%s: child status %x", what, status);
}

void Files() {
  const std::string fifo = g_folder + "/fifo", file = g_folder + "/file";
  EXPECT(mkfifo(fifo.c_str(), 0600) == 0, "mkfifo");
  Meanwhile(
      "open", [&](pid_t) { EXPECT(open(fifo.c_str(), O_WRONLY) >= 0, "open to write"); },
      [&] { EXPECT(open(fifo.c_str(), O_RDONLY) >= 0, "open to read"); });

  // The parent's lock ends with this descriptor; the child has its own.
  const int locked = open(file.c_str(), O_RDWR | O_CREAT, 0600);
  EXPECT(flock(locked, LOCK_EX) == 0, "flock");
  const std::int64_t start = Now();
  const pid_t pid = fork();
  if (pid == 0) {
    close(locked);
    const int own = open(file.c_str(), O_RDWR);
    _exit(flock(own, LOCK_EX) == 0 ? 0 : 1);
  }
  usleep(50'000);
  EXPECT(flock(locked, LOCK_UN) == 0, "flock");
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "flock: child status %x", status);
  ExpectSoonAfter(start, 50 * kMs, "a lock", 100 * kMs);
}

void SystemV() {
  const int semaphore = semget(IPC_PRIVATE, 1, 0600), queue = msgget(IPC_PRIVATE, 0600);
  EXPECT(semaphore >= 0 && queue >= 0, "semget, msgget");
  sembuf up{0, 1, 0}, down{0, -1, 0};
  Meanwhile(
      "semop", [&](pid_t) { EXPECT(semop(semaphore, &up, 1) == 0, "semop"); },
      [&] { EXPECT(semop(semaphore, &down, 1) == 0, "semop"); });
  struct {
    long type;
    char text[4];
  } message{1, "abc"};
  Meanwhile(
      "msgrcv", [&](pid_t) { EXPECT(msgsnd(queue, &message, 4, 0) == 0, "msgsnd"); },
      [&] { EXPECT(msgrcv(queue, &message, 4, 0, 0) == 4, "msgrcv"); });
  semctl(semaphore, 0, IPC_RMID);
  msgctl(queue, IPC_RMID, nullptr);
}

void Queues() {
  const std::string name = "/tcs_conformance_" + std::to_string(getpid());
  mq_attr attributes{};
  attributes.mq_maxmsg = 2;
  attributes.mq_msgsize = 8;
  const mqd_t queue = mq_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600, &attributes);
  EXPECT(queue >= 0, "mq_open: %s", strerror(errno));
  mq_unlink(name.c_str());
  char text[8];
  Meanwhile(
      "mq_receive", [&](pid_t) { EXPECT(mq_send(queue, "ab", 2, 0) == 0, "mq_send"); },
      [&] { EXPECT(mq_receive(queue, text, sizeof text, nullptr) == 2, "mq_receive"); });
}

// A process made without the C library's fork.
void Clones() {
  static char stack[64 * 1024];
  const std::int64_t start = Now();
  const pid_t pid =
      clone([](void*) { return usleep(50'000); }, stack + sizeof stack, SIGCHLD, nullptr);
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "clone: %x", status);
  ExpectSoonAfter(start, 50 * kMs, "a cloned child", 50 * kMs);
}

// A mutex with priority inheritance, and one more thread that wants it.
void Inheritance() {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  static pthread_mutex_t mutex;
  pthread_mutex_init(&mutex, &attributes);
  pthread_mutex_lock(&mutex);
  pthread_t thread;
  pthread_create(
      &thread, nullptr,
      [](void*) -> void* {
        EXPECT(pthread_mutex_lock(&mutex) == 0, "pthread_mutex_lock");
        pthread_mutex_unlock(&mutex);
        return nullptr;
      },
      nullptr);
  usleep(50'000);
  pthread_mutex_unlock(&mutex);
  EXPECT(pthread_join(thread, nullptr) == 0, "pthread_join");
}

// The kernel has the child wait until the parent, to whom it sends a signal, gives up its lease: at
// once by the clocks of both, though the parent would wait for five seconds.
void Leases() {
  const std::string path = g_folder + "/leased";
  const int fd = open(path.c_str(), O_RDWR | O_CREAT, 0600);
  sigset_t set, before;
  sigemptyset(&set);
  sigaddset(&set, SIGIO);
  sigprocmask(SIG_BLOCK, &set, &before);
  if (fcntl(fd, F_SETLEASE, F_WRLCK) == 0) {  // not every file system has leases
    for (int i = 0; i < 3; ++i) {
      const std::int64_t start = Now();
      const pid_t child = fork();
      if (child == 0) {
        usleep(50'000);
        const std::int64_t opens = Now();
        const int own = open(path.c_str(), O_WRONLY);
        _exit(own >= 0 && (Now() - opens < kSecond || g_mode == Mode::kNative) ? 0 : 1);
      }
      const timespec most{5, 0};
      EXPECT(sigtimedwait(&set, nullptr, &most) == SIGIO, "no word of a lease: %s",
             strerror(errno));
      const std::int64_t waited = Now() - start;
      EXPECT(waited >= 50 * kMs && (waited < kSecond || g_mode == Mode::kNative), "%lld ns",
             (long long)waited);
      EXPECT(fcntl(fd, F_SETLEASE, F_UNLCK) == 0, "lease: %s", strerror(errno));
      int status = 0;
      EXPECT(waitpid(child, &status, 0) == child && status == 0, "lease: child status %x", status);
      EXPECT(fcntl(fd, F_SETLEASE, F_WRLCK) == 0, "lease: %s", strerror(errno));
    }
  }
  sigprocmask(SIG_SETMASK, &before, nullptr);
  close(fd);
  unlink(path.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  char folder[] = "/tmp/tcs_conformance_XXXXXX";
  EXPECT(mkdtemp(folder) != nullptr, "mkdtemp");
  g_folder = folder;
  Files();
  SystemV();
  Queues();
  Inheritance();
  Clones();
  Leases();
  unlink((g_folder + "/fifo").c_str());
  unlink((g_folder + "/file").c_str());
  rmdir(folder);
}
