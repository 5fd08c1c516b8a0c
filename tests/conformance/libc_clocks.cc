// Clocks that are read past the C library's symbols: through the kernel's vDSO, as Go's runtime
// does, and by the C library inside itself, for what it waits for and for threads of its own.
#include <aio.h>
#include <arpa/inet.h>
#include <arpa/nameser.h>
#include <dirent.h>
#include <dlfcn.h>
#include <netdb.h>
#include <netinet/in.h>
#include <pthread.h>
#include <resolv.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

bool IsNative() { return g_mode == Mode::kNative; }

template <class F>
F* FromVdso(const char* name) {
  static void* vdso = dlopen("linux-vdso.so.1", RTLD_LAZY | RTLD_NOLOAD);
  return vdso == nullptr ? nullptr : reinterpret_cast<F*>(dlsym(vdso, name));
}

void ExpectBetween(std::int64_t before, std::int64_t now, std::int64_t after, const char* what) {
  EXPECT(before <= now && now <= after, "%s: %lld is not from %lld to %lld", what, (long long)now,
         (long long)before, (long long)after);
}

void TheVdsoAgrees() {
  auto* read = FromVdso<int(clockid_t, timespec*)>("__vdso_clock_gettime");
  if (read == nullptr) return;
  auto* of_day = FromVdso<int(timeval*, void*)>("__vdso_gettimeofday");
  auto* seconds = FromVdso<time_t(time_t*)>("__vdso_time");
  for (const clockid_t clock :
       {CLOCK_REALTIME, CLOCK_MONOTONIC, CLOCK_BOOTTIME, CLOCK_TAI, CLOCK_PROCESS_CPUTIME_ID}) {
    timespec t;
    const std::int64_t before = Now(clock);
    EXPECT(read(clock, &t) == 0, "clock %d", clock);
    ExpectBetween(before, ToNs(t), Now(clock), "the vDSO's clock");
  }
  timeval day;
  const std::int64_t before = Now(CLOCK_REALTIME);
  EXPECT(of_day(&day, nullptr) == 0, "gettimeofday");
  ExpectBetween(before / 1000, day.tv_sec * 1'000'000 + day.tv_usec, Now(CLOCK_REALTIME) / 1000,
                "the vDSO's gettimeofday");
  // The kernel's may be a tick behind.
  ExpectBetween(before / kSecond - 1, seconds(nullptr), Now(CLOCK_REALTIME) / kSecond,
                "the vDSO's time");
  errno = 77;
  timespec t;
  EXPECT(read(9999, &t) == -EINVAL && errno == 77, "errno %d", errno);
  const std::int64_t start = Now();
  timespec first, last;
  read(CLOCK_MONOTONIC, &first);
  usleep(50'000);
  read(CLOCK_MONOTONIC, &last);
  EXPECT(ToNs(last) - ToNs(first) >= 50 * kMs, "a sleep took %lld ns",
         (long long)(ToNs(last) - ToNs(first)));
  ExpectWaited(start, 50 * kMs, 4, "a sleep");
}

void* InThread(void*) {
  TheVdsoAgrees();
  return nullptr;
}

void TheVdsoAgreesEverywhere(char** argv) {
  TheVdsoAgrees();
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, InThread, nullptr) == 0, "pthread_create");
  TheVdsoAgrees();
  pthread_join(thread, nullptr);
  const pid_t pid = fork();
  if (pid == 0) {
    TheVdsoAgrees();
    char again[] = "again";
    char* const arguments[] = {argv[0], argv[1], again, nullptr};
    if (argv[1] != nullptr) execv("/proc/self/exe", arguments);
    _exit(0);
  }
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "the child: %#x", status);
}

// A name server that never answers: the C library waits, and asks once more.
void TheResolverGivesUpInTime() {
  const int server = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT(bind(server, reinterpret_cast<sockaddr*>(&address), size) == 0, "bind");
  EXPECT(getsockname(server, reinterpret_cast<sockaddr*>(&address), &size) == 0, "getsockname");
  struct __res_state state {};
  EXPECT(res_ninit(&state) == 0, "res_ninit");
  state.nscount = 1;
  state.nsaddr_list[0] = address;
  state.retrans = IsNative() ? 1 : 30;
  state.retry = IsNative() ? 1 : 2;
  const std::int64_t wanted = std::int64_t{state.retrans} * state.retry * kSecond;
  unsigned char answer[512];
  const std::int64_t start = Now();
  EXPECT(res_nquery(&state, "nobody.example", C_IN, T_A, answer, sizeof answer) == -1, "answered");
  const std::int64_t passed = Now() - start;
  // It counts in seconds, or in milliseconds.
  const std::int64_t most = IsNative() ? 10 * kSecond : (g_mode == Mode::kFixed ? 10 : 100) * kMs;
  EXPECT(passed >= wanted - 2 * kMs && passed < wanted + most, "%lld ns", (long long)passed);
  res_nclose(&state);
  close(server);
}

int Threads() {
  int count = 0;
  DIR* folder = opendir("/proc/self/task");
  while (const dirent* entry = readdir(folder)) count += entry->d_name[0] != '.';
  closedir(folder);
  return count;
}

// The thread that does the work waits for more for a second, and then ends.
void HelpersEnd() {
  char byte = 0;
  FILE* file = tmpfile();
  EXPECT(file != nullptr, "%s", strerror(errno));
  aiocb request{};
  request.aio_fildes = fileno(file);
  request.aio_buf = &byte;
  request.aio_nbytes = 1;
  EXPECT(aio_write(&request) == 0, "%s", strerror(errno));
  const aiocb* const list[] = {&request};
  while (aio_error(&request) == EINPROGRESS) aio_suspend(list, 1, nullptr);
  EXPECT(aio_return(&request) == 1, "aio_write");
  const int working = Threads();
  EXPECT(working == 2, "%d threads at work", working);
  for (int i = 0; i < 40 && Threads() > 1; ++i) usleep(100'000);
  EXPECT(Threads() == 1, "the thread has not ended");
  fclose(file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2) {
    g_mode = strcmp(argv[1], "fixed") == 0 ? Mode::kFixed : Mode::kMeasured;
    TheVdsoAgrees();
    return 0;
  }
  Begin(argc, argv);
  TheVdsoAgreesEverywhere(argv);
  TheResolverGivesUpInTime();
  HelpersEnd();
}
