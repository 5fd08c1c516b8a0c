// system and popen, on posix_spawn and waitpid: the C library's own would wait where the shim does
// not see it.
#include <errno.h>
#include <fcntl.h>
#include <paths.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/real.h"

extern char** environ;

namespace {

constexpr int kMaxPipes = 256;
struct Pipe {
  FILE* file;
  pid_t pid;
};
Pipe g_pipes[kMaxPipes];

pid_t SpawnShell(const char* command, const posix_spawn_file_actions_t* actions,
                 const posix_spawnattr_t* attributes) {
  const char* argv[] = {"sh", "-c", command, nullptr};
  pid_t pid = -1;
  const int error =
      posix_spawn(&pid, _PATH_BSHELL, actions, attributes, const_cast<char**>(argv), environ);
  if (error != 0) errno = error;
  return error == 0 ? pid : -1;
}

int AwaitShell(pid_t pid) {
  int status = -1;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return status;
}

}  // namespace

TCS_EXPORT int system(const char* command) {
  if (command == nullptr) return 1;
  // As POSIX has it: the caller ignores SIGINT and SIGQUIT and blocks SIGCHLD meanwhile; the shell
  // does not.
  struct sigaction ignore {
  }, old_int, old_quit;
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGINT, &ignore, &old_int);
  sigaction(SIGQUIT, &ignore, &old_quit);
  sigset_t child, old_mask, defaults;
  sigemptyset(&child);
  sigaddset(&child, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child, &old_mask);

  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigemptyset(&defaults);
  if (old_int.sa_handler != SIG_IGN) sigaddset(&defaults, SIGINT);
  if (old_quit.sa_handler != SIG_IGN) sigaddset(&defaults, SIGQUIT);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setsigmask(&attributes, &old_mask);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  const pid_t pid = SpawnShell(command, nullptr, &attributes);
  posix_spawnattr_destroy(&attributes);
  // A shell that cannot be started counts as one that exited with 127.
  const int status = pid > 0 ? AwaitShell(pid) : 127 << 8;

  sigaction(SIGINT, &old_int, nullptr);
  sigaction(SIGQUIT, &old_quit, nullptr);
  sigprocmask(SIG_SETMASK, &old_mask, nullptr);
  return status;
}

TCS_EXPORT FILE* popen(const char* command, const char* mode) {
  const bool reads = strchr(mode, 'r') != nullptr;
  if (reads == (strchr(mode, 'w') != nullptr)) return errno = EINVAL, nullptr;
  Pipe* entry = nullptr;
  for (Pipe& candidate : g_pipes) {
    if (candidate.file == nullptr) {
      entry = &candidate;
      break;
    }
  }
  int ends[2];
  if (entry == nullptr || pipe2(ends, O_CLOEXEC) != 0) return nullptr;
  const int ours = reads ? ends[0] : ends[1], theirs = reads ? ends[1] : ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, theirs, reads ? STDOUT_FILENO : STDIN_FILENO);
  // POSIX: a popen'd child does not inherit the streams of earlier popens.
  for (const Pipe& other : g_pipes) {
    if (other.file != nullptr) posix_spawn_file_actions_addclose(&actions, fileno(other.file));
  }
  const pid_t pid = SpawnShell(command, &actions, nullptr);
  posix_spawn_file_actions_destroy(&actions);
  close(theirs);
  FILE* file = pid > 0 ? fdopen(ours, reads ? "r" : "w") : nullptr;
  if (file == nullptr) {
    close(ours);
    return nullptr;
  }
  if (strchr(mode, 'e') == nullptr) fcntl(ours, F_SETFD, 0);
  *entry = Pipe{file, pid};
  return file;
}

TCS_EXPORT int pclose(FILE* file) {
  for (Pipe& entry : g_pipes) {
    if (entry.file != file || file == nullptr) continue;
    entry.file = nullptr;
    fclose(file);
    return AwaitShell(entry.pid);
  }
  return TCS_REAL(pclose)(file);
}
