// Children in all the ways they are made, and waiting for their end.
#include <pty.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

extern char** environ;

namespace {

constexpr std::int64_t kLife = 100 * kMs;

void ExpectLived(std::int64_t start, const char* what) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= kLife, "%s took %lld ns", what, (long long)passed);
}

pid_t Sleeper(int status) {
  const pid_t pid = fork();
  if (pid == 0) {
    usleep(kLife / 1000);
    _exit(status);
  }
  EXPECT(pid > 0, "fork: %s", strerror(errno));
  return pid;
}

void Waits() {
  int status = 0;
  std::int64_t start = Now();
  pid_t pid = Sleeper(3);
  EXPECT(waitpid(pid, &status, WNOHANG) == 0, "a child that sleeps has ended");
  EXPECT(waitpid(pid, &status, 0) == pid && WEXITSTATUS(status) == 3, "waitpid: %x", status);
  ExpectLived(start, "waitpid");

  start = Now();
  pid = Sleeper(4);
  EXPECT(wait(&status) == pid && WEXITSTATUS(status) == 4, "wait: %x", status);
  ExpectLived(start, "wait");

  start = Now();
  pid = Sleeper(5);
  rusage usage{};
  EXPECT(wait4(-1, &status, 0, &usage) == pid && WEXITSTATUS(status) == 5, "wait4: %x", status);
  ExpectLived(start, "wait4");

  start = Now();
  pid = Sleeper(6);
  siginfo_t info{};
  EXPECT(waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED) == 0 && info.si_status == 6,
         "waitid");
  ExpectLived(start, "waitid");
  EXPECT(waitpid(-1, &status, 0) == -1 && errno == ECHILD, "there are no children left");
}

// One that has ended, and that is not waited for, does not keep from waiting.
void WaitsBesideOneThatEnded() {
  const std::int64_t start = Now();
  const pid_t first = fork();
  if (first == 0) _exit(0);
  const pid_t second = Sleeper(1), third = Sleeper(2);
  usleep(kLife / 2000);
  int status = 0;
  EXPECT(waitpid(second, &status, 0) == second && WEXITSTATUS(status) == 1, "waitpid: %x", status);
  EXPECT(syscall(SYS_wait4, third, &status, 0, nullptr) == third && WEXITSTATUS(status) == 2,
         "wait4: %x", status);
  ExpectLived(start, "waitpid beside one that ended");
  EXPECT(waitpid(first, &status, 0) == first && status == 0, "waitpid: %x", status);
}

void ClocksGoOnInAChild() {
  const std::int64_t before = Now();
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  const pid_t pid = fork();
  if (pid == 0) {
    const std::int64_t now = Now();
    _exit(write(fds[1], &now, sizeof now) == sizeof now ? 0 : 1);
  }
  std::int64_t childs = 0;
  EXPECT(read(fds[0], &childs, sizeof childs) == sizeof childs, "read");
  EXPECT(before <= childs && childs <= Now(), "a child's clock: %lld", (long long)childs);
  waitpid(pid, nullptr, 0);
}

void Programs() {
  int status = 0;
  std::int64_t start = Now();
  pid_t pid = vfork();
  if (pid == 0) {
    execlp("sleep", "sleep", "0.1", nullptr);
    _exit(127);
  }
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "vfork, exec: %x", status);
  ExpectLived(start, "vfork and exec");

  char name[] = "sleep", seconds[] = "0.1";
  char* arguments[] = {name, seconds, nullptr};
  start = Now();
  EXPECT(posix_spawnp(&pid, "sleep", nullptr, nullptr, arguments, environ) == 0, "posix_spawnp");
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "posix_spawnp: %x", status);
  ExpectLived(start, "posix_spawnp");

  start = Now();
  EXPECT(system("sleep 0.1; exit 7") == 7 << 8, "system");
  ExpectLived(start, "system");

  start = Now();
  FILE* out = popen("sleep 0.1; echo done", "r");
  EXPECT(out != nullptr, "popen");
  char line[16] = "";
  EXPECT(fgets(line, sizeof line, out) != nullptr && strcmp(line, "done\n") == 0, "popen: %s",
         line);
  EXPECT(pclose(out) == 0, "pclose");
  ExpectLived(start, "popen");
}

// Whose first parent ends at once: it is no less part of the program.
void Daemons() {
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  const std::int64_t start = Now();
  const pid_t pid = fork();
  if (pid == 0) {
    if (daemon(0, 0) != 0) _exit(1);
    usleep(kLife / 1000);
    struct stat out {
    }, null{};
    char where[8] = "";
    const bool apart = fstat(STDOUT_FILENO, &out) == 0 && stat("/dev/null", &null) == 0 &&
                       out.st_rdev == null.st_rdev && getsid(0) == getpid() &&
                       getcwd(where, sizeof where) != nullptr && strcmp(where, "/") == 0;
    const char said = apart ? 'y' : 'n';
    _exit(write(fds[1], &said, 1) == 1 ? 0 : 1);
  }
  close(fds[1]);
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "a daemon's parent: %x", status);
  char said = 0;
  EXPECT(read(fds[0], &said, 1) == 1 && said == 'y', "a daemon: %d", said);
  ExpectLived(start, "a daemon");
  close(fds[0]);
}

void Terminals() {
  int leader = -1;
  const std::int64_t start = Now();
  const pid_t pid = forkpty(&leader, nullptr, nullptr, nullptr);
  if (pid == 0) {
    usleep(kLife / 1000);
    _exit(isatty(STDOUT_FILENO) == 1 && write(STDOUT_FILENO, "x", 1) == 1 ? 8 : 1);
  }
  EXPECT(pid > 0, "forkpty: %s", strerror(errno));
  char said = 0;
  EXPECT(read(leader, &said, 1) == 1 && said == 'x', "a terminal's child said %d", said);
  ExpectLived(start, "a terminal's child");
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && WEXITSTATUS(status) == 8, "forkpty: %x", status);
  close(leader);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Waits();
  WaitsBesideOneThatEnded();
  ClocksGoOnInAChild();
  Programs();
  Daemons();
  Terminals();
}
