// What a program reads of its computer agrees, however it opens the files: the processors that
// there are and those that it may use, how long the computer is on, and what processes and threads
// have computed since they began.
#include <ctype.h>
#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>
#include <new>
#include <string>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

using namespace conformance;

namespace {

constexpr std::int64_t kTick = 10 * kMs;  // in which the kernel counts
constexpr const char* kOnline = "/sys/devices/system/cpu/online";

std::string ReadFrom(int fd, const char* what) {
  EXPECT(fd >= 0, "%s: %s", what, strerror(errno));
  std::string text;
  char piece[4096];
  for (ssize_t size = 0; (size = read(fd, piece, sizeof piece)) > 0;) {
    text.append(piece, static_cast<std::size_t>(size));
  }
  return text;
}

std::string TextOf(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  std::string text = ReadFrom(fd, path.c_str());
  close(fd);
  return text;
}

int CountOf(const std::string& text, const char* part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

// "0-2,5" are four.
int CountOfList(const std::string& list) {
  int count = 0;
  for (const char* at = list.c_str(); isdigit(*at) != 0;) {
    char* end = nullptr;
    const long first = strtol(at, &end, 10);
    const long last = *end == '-' ? strtol(end + 1, &end, 10) : first;
    count += static_cast<int>(last - first + 1);
    at = *end == ',' ? end + 1 : end;
  }
  return count;
}

std::string Value(const std::string& text, const char* name) {
  const std::size_t at = text.find(name);
  EXPECT(at != std::string::npos, "there is no %s", name);
  const std::size_t begin = text.find_first_not_of(" \t", at + strlen(name));
  return text.substr(begin, text.find('\n', begin) - begin);
}

// By the manual's number, from 1 on.
long long Field(const std::string& stat, int field) {
  const char* at = stat.c_str() + stat.rfind(')') + 2;
  for (int skip = 3; skip < field; ++skip) at = strchr(at, ' ') + 1;
  return atoll(at);
}
std::int64_t ComputedIn(const std::string& stat) {
  return (Field(stat, 14) + Field(stat, 15)) * kTick;
}
std::int64_t StartIn(const std::string& stat) { return Field(stat, 22) * kTick; }

void Compute(std::int64_t ns) {
  const std::int64_t until = Now(CLOCK_THREAD_CPUTIME_ID) + ns;
  while (Now(CLOCK_THREAD_CPUTIME_ID) < until) {
  }
}

int AllowedTo(pid_t thread) {
  cpu_set_t set;
  EXPECT(sched_getaffinity(thread, sizeof set, &set) == 0, "%s", strerror(errno));
  return CPU_COUNT(&set);
}

int CountOfFolders(const char* folder) {
  DIR* listed = opendir(folder);
  EXPECT(listed != nullptr, "%s: %s", folder, strerror(errno));
  int count = 0;
  while (const dirent* entry = readdir(listed)) {
    count += strncmp(entry->d_name, "cpu", 3) == 0 && isdigit(entry->d_name[3]) != 0 ? 1 : 0;
  }
  closedir(listed);
  return count;
}

void ProcessorsAgree() {
  const int online = CountOfList(TextOf(kOnline));
  EXPECT(online >= 1, "no processor");
  const int table = CountOf(TextOf("/proc/cpuinfo"), "processor\t");
  EXPECT(table == online, "/proc/cpuinfo has %d, %d are online", table, online);
  const int counted = CountOf(TextOf("/proc/stat"), "\ncpu");
  EXPECT(counted == online, "/proc/stat has %d, %d are online", counted, online);
  const int present = CountOfList(TextOf("/sys/devices/system/cpu/present"));
  const int folders = CountOfFolders("/sys/devices/system/cpu");
  EXPECT(folders == present && present >= online, "%d folders, %d", folders, present);
  const std::string status = TextOf("/proc/thread-self/status");
  const int allowed = CountOfList(Value(status, "\nCpus_allowed_list:"));
  EXPECT(allowed == AllowedTo(0), "%d and %d may be used", allowed, AllowedTo(0));
  const std::string mask = Value(status, "\nCpus_allowed:");
  int bits = 0;
  for (const char digit : mask) {
    if (digit != ',')
      bits += __builtin_popcountl(strtoul(std::string(1, digit).c_str(), nullptr, 16));
  }
  EXPECT(bits == allowed, "the mask %s", mask.c_str());
  const char* siblings = "/sys/devices/system/cpu/cpu0/topology/core_siblings_list";
  if (access(siblings, R_OK) == 0) EXPECT(CountOfList(TextOf(siblings)) <= online, "siblings");
  if (g_mode == Mode::kNative) return;
  EXPECT(online == sysconf(_SC_NPROCESSORS_ONLN) && allowed == online, "%d, %d", online, allowed);
  EXPECT(CountOfList(TextOf(siblings)) == online, "siblings");
  const std::string last = "/sys/devices/system/cpu/cpu" + std::to_string(online - 1);
  const std::string none = "/sys/devices/system/cpu/cpu" + std::to_string(online);
  struct stat found;
  EXPECT(stat(last.c_str(), &found) == 0 && S_ISDIR(found.st_mode), "%s", last.c_str());
  EXPECT(access((last + "/topology/core_id").c_str(), R_OK) == 0, "%s", last.c_str());
  EXPECT(stat(none.c_str(), &found) == -1 && errno == ENOENT, "%s", none.c_str());
  EXPECT(access(none.c_str(), F_OK) == -1 && errno == ENOENT, "%s", none.c_str());
  EXPECT(open(none.c_str(), O_RDONLY) == -1 && errno == ENOENT, "%s", none.c_str());
  if (access("/sys/devices/system/node/node0", F_OK) == 0) {
    const int of_node = CountOfList(TextOf("/sys/devices/system/node/node0/cpulist"));
    EXPECT(of_node == online, "the node has %d", of_node);
  }
  if (online < 2) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(1, &set);
  EXPECT(sched_setaffinity(0, sizeof set, &set) == 0, "%s", strerror(errno));
  EXPECT(Value(TextOf("/proc/self/status"), "\nCpus_allowed_list:") == "1", "where it may run");
  EXPECT(Field(TextOf("/proc/self/stat"), 39) == 1, "where it runs");
}

// No limit of a control group of the host's is one of the robot's.
void Groups() {
  for (const char* path : {"/sys/fs/cgroup/cpu.max", "/sys/fs/cgroup/cpu/cpu.cfs_quota_us"}) {
    if (g_mode == Mode::kNative || access(path, R_OK) != 0) continue;
    const std::string quota = TextOf(path);
    EXPECT(quota == "-1\n" || quota.rfind("max ", 0) == 0, "%s: %s", path, quota.c_str());
  }
}

void EveryOpenFindsTheSame() {
  const std::string wanted = TextOf(kOnline);
  const auto by = [&](int fd, const char* what) {
    const std::string text = ReadFrom(fd, what);
    EXPECT(text == wanted, "%s: %s", what, text.c_str());
    close(fd);
  };
  by(static_cast<int>(syscall(SYS_openat, AT_FDCWD, kOnline, O_RDONLY)), "openat, raw");
  by(static_cast<int>(syscall(SYS_open, kOnline, O_RDONLY)), "open, raw");
  by(open("//sys/devices/../devices/system/./cpu//online", O_RDONLY), "another spelling");
  by(openat(-1, kOnline, O_RDONLY), "openat");
  const int root = open("/", O_RDONLY | O_DIRECTORY);
  by(openat(root, "sys/devices/system/cpu/online", O_RDONLY), "from the root");
  by(static_cast<int>(syscall(SYS_openat, root, kOnline + 1, O_RDONLY)), "from the root, raw");
  const int folder = open("/sys/devices/system/cpu", O_RDONLY | O_DIRECTORY);
  by(openat(folder, "online", O_RDONLY), "from the folder");
  const int above = open("/sys/devices/system", O_RDONLY | O_DIRECTORY);
  by(openat(above, "cpu/online", O_RDONLY), "from the folder above");
  for (const int fd : {root, folder, above}) close(fd);
  FILE* stream = fopen(kOnline, "r");
  EXPECT(stream != nullptr, "fopen: %s", strerror(errno));
  by(dup(fileno(stream)), "fopen");
  stream = freopen(kOnline, "r", stream);
  EXPECT(stream != nullptr, "freopen: %s", strerror(errno));
  by(dup(fileno(stream)), "freopen");
  fclose(stream);
  char before[512];
  EXPECT(getcwd(before, sizeof before) != nullptr && chdir("/proc/self") == 0, "the folder");
  const int relative = open("stat", O_RDONLY);
  EXPECT(Field(ReadFrom(relative, "stat"), 22) == Field(TextOf("/proc/self/stat"), 22), "stat");
  close(relative);
  EXPECT(chdir(before) == 0, "%s", before);
}

void Descriptors() {
  const int kept = open("/proc/uptime", O_RDONLY),
            closed = open("/proc/uptime", O_RDONLY | O_CLOEXEC);
  EXPECT(fcntl(kept, F_GETFD) == 0 && fcntl(closed, F_GETFD) == FD_CLOEXEC, "on exec");
  EXPECT((fcntl(kept, F_GETFL) & O_ACCMODE) == O_RDONLY, "for reading only");
  char byte = 0;
  EXPECT(write(kept, &byte, 1) == -1 && errno == EBADF, "written");
  close(kept);
  close(closed);
  EXPECT(open("/proc/uptime", O_RDONLY | O_DIRECTORY) == -1 && errno == ENOTDIR, "no folder");
  EXPECT(open("/proc/self/nothing", O_RDONLY) == -1 && errno == ENOENT, "nothing");
  const char* volatile nowhere = reinterpret_cast<const char*>(1);
  EXPECT(open(nowhere, O_RDONLY) == -1 && errno == EFAULT, "no name");
  EXPECT(syscall(SYS_openat, AT_FDCWD, nowhere, O_RDONLY) == -1 && errno == EFAULT, "no name");
}

void ExpectTimeBetween(std::int64_t before, std::int64_t shown, std::int64_t after,
                       const char* what) {
  EXPECT(shown >= before - kTick && shown <= after + kTick, "%s: %lld not in %lld to %lld", what,
         (long long)shown, (long long)before, (long long)after);
}

std::int64_t UptimeIn(const std::string& text) {
  return static_cast<std::int64_t>(atof(text.c_str()) * 100 + 0.5) * kTick;
}

void Uptime() {
  const std::int64_t before = Now(CLOCK_BOOTTIME);
  const int fd = open("/proc/uptime", O_RDONLY);
  const std::string first = ReadFrom(fd, "/proc/uptime");
  ExpectTimeBetween(before, UptimeIn(first), Now(CLOCK_BOOTTIME), "/proc/uptime");
  const std::int64_t boot = atoll(Value(TextOf("/proc/stat"), "\nbtime").c_str());
  const std::int64_t since = Now(CLOCK_REALTIME) - Now(CLOCK_BOOTTIME);
  EXPECT(boot >= since / kSecond - 1 && boot <= since / kSecond + 1, "on since %lld, not %lld",
         (long long)boot, (long long)(since / kSecond));
  // Read from its beginning, it tells of now.
  const std::int64_t start = Now();
  usleep(300'000);
  EXPECT(lseek(fd, 0, SEEK_SET) == 0, "lseek: %s", strerror(errno));
  const std::int64_t passed = UptimeIn(ReadFrom(fd, "/proc/uptime")) - UptimeIn(first);
  EXPECT(passed >= 290 * kMs && passed <= Now() - start + 30 * kMs, "%lld ns", (long long)passed);
  close(fd);
}

void* InThread(void* argument) {
  Compute(60 * kMs);
  const std::string own = TextOf("/proc/thread-self/stat");
  const std::string by_number = TextOf("/proc/self/task/" + std::to_string(gettid()) + "/stat");
  const std::int64_t computed = ComputedIn(own);
  EXPECT(computed >= 40 * kMs && (g_mode == Mode::kNative || computed <= 70 * kMs),
         "the thread has computed %lld ns", (long long)computed);
  EXPECT(StartIn(own) == StartIn(by_number), "its start");
  *static_cast<std::int64_t*>(argument) = StartIn(own);
  return nullptr;
}

void Threads() {
  const std::int64_t before = Now(CLOCK_BOOTTIME);
  std::int64_t start = 0;
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, InThread, &start) == 0, "pthread_create");
  pthread_join(thread, nullptr);
  ExpectTimeBetween(before, start, Now(CLOCK_BOOTTIME), "the thread's start");
  EXPECT(start > StartIn(TextOf("/proc/self/stat")), "its process began before it");
}

void Processes() {
  const std::int64_t own_start = StartIn(TextOf("/proc/self/stat"));
  EXPECT(own_start <= Now(CLOCK_BOOTTIME) - 200 * kMs, "this process's start");
  Compute(50 * kMs);
  const std::int64_t computed = Now(CLOCK_PROCESS_CPUTIME_ID);
  const std::string own = TextOf("/proc/self/stat");
  // The kernel's are of its last tick, and a thread's own clock may be ahead of what it was
  // charged.
  const std::int64_t slack = g_mode == Mode::kNative ? 8 * kTick : 2 * kTick;
  EXPECT(ComputedIn(own) >= computed - slack && ComputedIn(own) <= computed + slack,
         "%lld ns instead of %lld", (long long)ComputedIn(own), (long long)computed);
  const std::int64_t scheduled = atoll(TextOf("/proc/self/schedstat").c_str());
  EXPECT(g_mode == Mode::kNative || (scheduled >= computed && scheduled < computed + 20 * kMs),
         "schedstat: %lld", (long long)scheduled);
  EXPECT(own[own.rfind(')') + 2] == 'R', "it runs: %s", own.c_str());
  const std::int64_t before = Now(CLOCK_BOOTTIME);
  const pid_t child = fork();
  if (child == 0) {
    pause();
    _exit(0);
  }
  usleep(200'000);
  NativelyUntil([=] { return Sleeps(child); });
  const std::string of_child = TextOf("/proc/" + std::to_string(child) + "/stat");
  ExpectTimeBetween(before, StartIn(of_child), Now(CLOCK_BOOTTIME) - 200 * kMs, "a child's start");
  EXPECT(ComputedIn(of_child) <= 50 * kMs, "what it has computed");
  EXPECT(of_child[of_child.rfind(')') + 2] == 'S', "it sleeps: %s", of_child.c_str());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  // One from before the run, on the host.
  const std::string first = TextOf("/proc/1/stat");
  EXPECT(StartIn(first) <= StartIn(own), "the first process began at %lld ns, this one at %lld",
         (long long)StartIn(first), (long long)StartIn(own));
}

// A process that is seen to sleep has come to its wait, and a signal ends that.
void SleepersWait() {
  void* const shared =
      mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  EXPECT(shared != MAP_FAILED, "mmap: %s", strerror(errno));
  auto* const has_begun = new (shared) std::atomic<int>(0);
  for (int i = 0; i < 10; ++i) {
    *has_begun = 0;
    const pid_t child = fork();
    if (child == 0) {
      *has_begun = 1;
      pause();
      _exit(0);
    }
    const std::string path = "/proc/" + std::to_string(child) + (i % 2 == 0 ? "/stat" : "/status");
    const auto state = [&] {
      const std::string text = TextOf(path);
      return i % 2 == 0 ? text[text.rfind(')') + 2] : Value(text, "State:")[0];
    };
    while (state() != 'S') usleep(50);
    const bool has_come = *has_begun == 1;
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT(has_come, "it sleeps before it has begun: %s", path.c_str());
  }
  munmap(shared, sizeof(int));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (g_mode == Mode::kNative) usleep(250'000);
  EveryOpenFindsTheSame();
  Descriptors();
  Uptime();
  Threads();
  Processes();
  SleepersWait();
  Groups();
  ProcessorsAgree();
}
