// A program that becomes another one, in all the ways there are, goes on in the same time.
#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

extern char** environ;

namespace {

constexpr char kPath[] = "/bin/sleep";
constexpr std::int64_t kLife = 200 * kMs;
char g_sleep[] = "sleep", g_life[] = "0.2";
char* const g_arguments[] = {g_sleep, g_life, nullptr};
// The environment handed over says nothing of tcs.
char g_path[] = "PATH=/usr/bin:/bin";
char* const g_environment[] = {g_path, nullptr};

void ExpectSlept(std::int64_t start, pid_t pid, const char* what) {
  int status = 0;
  rusage usage{};
  EXPECT(wait3(&status, 0, &usage) == pid && status == 0, "%s: status %x", what, status);
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= kLife, "%s took %lld ns", what, (long long)passed);
  if (g_mode != Mode::kNative) EXPECT(passed < kSecond, "%s took %lld ns", what, (long long)passed);
}

template <class Become>
void InAChild(const char* what, Become become) {
  const std::int64_t start = Now();
  const pid_t pid = fork();
  if (pid == 0) {
    become();
    _exit(9);
  }
  ExpectSlept(start, pid, what);
}

// glibc has them from 2.39 on, and before that only tcs.
void SpawnsWithPidfd(const char* name, const char* path) {
  using PidfdSpawn =
      int (*)(int* pidfd, const char* path, const posix_spawn_file_actions_t* actions,
              const posix_spawnattr_t* attributes, char* const argv[], char* const envp[]);
  const auto spawn = reinterpret_cast<PidfdSpawn>(dlsym(RTLD_DEFAULT, name));
  if (spawn == nullptr && g_mode == Mode::kNative) return;
  EXPECT(spawn != nullptr, "there is no %s", name);
  int pidfd = -1;
  const std::int64_t start = Now();
  EXPECT(spawn(&pidfd, path, nullptr, nullptr, g_arguments, g_environment) == 0, "%s", name);
  EXPECT((fcntl(pidfd, F_GETFD) & FD_CLOEXEC) != 0, "%s: not closed on exec", name);
  siginfo_t ended{};
  EXPECT(waitid(P_PIDFD, static_cast<id_t>(pidfd), &ended, WEXITED | WNOWAIT) == 0, "waitid");
  ExpectSlept(start, ended.si_pid, name);
  close(pidfd);
  EXPECT(spawn(&pidfd, "/nonexistent", nullptr, nullptr, g_arguments, environ) == ENOENT,
         "%s of nothing", name);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  InAChild("execl", [] { execl(kPath, g_sleep, g_life, nullptr); });
  InAChild("execlp", [] { execlp(g_sleep, g_sleep, g_life, nullptr); });
  InAChild("execle", [] { execle(kPath, g_sleep, g_life, nullptr, g_environment); });
  InAChild("execv", [] { execv(kPath, g_arguments); });
  InAChild("execvp", [] { execvp(g_sleep, g_arguments); });
  InAChild("execve", [] { execve(kPath, g_arguments, g_environment); });
  InAChild("execvpe", [] { execvpe(g_sleep, g_arguments, g_environment); });
  InAChild("fexecve", [] { fexecve(open(kPath, O_RDONLY), g_arguments, g_environment); });

  pid_t pid = 0;
  std::int64_t start = Now();
  EXPECT(posix_spawn(&pid, kPath, nullptr, nullptr, g_arguments, g_environment) == 0, "spawn");
  ExpectSlept(start, pid, "posix_spawn");
  start = Now();
  EXPECT(posix_spawnp(&pid, g_sleep, nullptr, nullptr, g_arguments, g_environment) == 0, "spawnp");
  ExpectSlept(start, pid, "posix_spawnp");
  SpawnsWithPidfd("pidfd_spawn", kPath);
  SpawnsWithPidfd("pidfd_spawnp", g_sleep);

  EXPECT(execl("/nonexistent", g_sleep, nullptr) == -1 && errno == ENOENT, "execl of nothing");
  EXPECT(posix_spawn(&pid, "/nonexistent", nullptr, nullptr, g_arguments, environ) == ENOENT,
         "posix_spawn of nothing");
}
