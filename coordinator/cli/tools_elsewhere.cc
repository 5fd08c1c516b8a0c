#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/preload_library.h"
#include "coordinator/cli/tools.h"

namespace tcs {

namespace {

int CannotStart(const std::string& program, int error) {
  return Fail("the rest of tcs is missing: " + program + " cannot be started (" + strerror(error) +
              "); `./dev build` makes it");
}

}  // namespace

int DoWithTools(const ToolArguments& /*arguments*/, char** argv) {
  const std::string program = ToolsProgram();
  execv(program.c_str(), argv);
  return CannotStart(program, errno);
}

int WriteSnapshot(const std::string& folder) {
  const std::string program = ToolsProgram(), out = folder + "/snapshot.yaml";
  const char* const argv[] = {"tcsim", "snapshot", folder.c_str(), "--out", out.c_str(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  // The run itself says what the snapshot command has written.
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = 0;
  const int error = posix_spawn(&pid, program.c_str(), &actions, nullptr,
                                const_cast<char* const*>(argv), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return CannotStart(program, error);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kCannotRun;
}

}  // namespace tcs
