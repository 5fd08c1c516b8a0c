// One scenario: two processes that speak DDS with each other. Prints what each of them told.
//   dds_scenario NAME native|sockets|endpoints
// starts both, and waits for them; it calls itself for each with its role and the descriptor of
// their socket:
//   dds_scenario NAME native|sockets|endpoints writer|reader FD
// Two robots have one each, which meet at a socket of that name (it begins with a slash or a dot):
//   dds_scenario NAME native|sockets|endpoints writer|reader PATH
// The variable TCS_DDS_DOMAIN is the domain to use, 0 without it; the one after it must be free,
// too.
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"

namespace dds_test {
namespace {

constexpr const char* kRoles[] = {"writer", "reader"};

int Play(const Scenario& scenario, Under under, Role role, int socket) {
  Peer peer(socket);
  const char* domain = getenv("TCS_DDS_DOMAIN");
  Process process{domain == nullptr ? 0u : static_cast<dds_domainid_t>(atoi(domain)), 0, peer,
                  under};
  process.participant = process.Participant();
  (role == Role::kWriter ? scenario.writer_role : scenario.reader_role)(process);
  // Nobody sees the other leave while it is still looking.
  if (scenario.end == End::kOrderly) peer.Meet("end");
  OK(dds_delete(process.participant));
  return 0;
}

// Under tcs an hour passes at once; otherwise the test runs into its time limit.
void ProveVirtualTime() {
  const time_t start = time(nullptr);
  sleep(3600);
  if (time(nullptr) < start + 3600) Fail("an hour's sleep was early");
}

// A role in a process of its own, whose words go into a file in memory.
pid_t Start(char** argv, const char* role, int socket, int words) {
  char fd[16];
  snprintf(fd, sizeof fd, "%d", socket);
  char* arguments[] = {argv[0], argv[1], argv[2], const_cast<char*>(role), fd, nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, words, STDOUT_FILENO);
  pid_t pid;
  const int error = posix_spawn(&pid, "/proc/self/exe", &actions, nullptr, arguments, environ);
  if (error != 0) Fail("cannot start the %s: %s", role, strerror(error));
  posix_spawn_file_actions_destroy(&actions);
  return pid;
}

void Copy(int words) {
  char buffer[4096];
  lseek(words, 0, SEEK_SET);
  for (ssize_t got; (got = read(words, buffer, sizeof buffer)) > 0;)
    fwrite(buffer, 1, static_cast<std::size_t>(got), stdout);
}

bool EndedAsExpected(int status, bool killed) {
  return killed ? WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL
                : WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int StartBoth(const Scenario& scenario, char** argv) {
  int sockets[2], words[2];
  pid_t pids[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, sockets) != 0) Fail("socketpair: %s", strerror(errno));
  for (int i = 0; i < 2; i++) {
    words[i] = memfd_create(kRoles[i], MFD_CLOEXEC);
    // Each process has one end only, so that it hears of the other's death.
    fcntl(sockets[i], F_SETFD, 0);
    fcntl(sockets[1 - i], F_SETFD, FD_CLOEXEC);
    pids[i] = Start(argv, kRoles[i], sockets[i], words[i]);
  }
  for (int socket : sockets) close(socket);
  int result = 0;
  for (int i = 0; i < 2; i++) {
    int status;
    while (waitpid(pids[i], &status, 0) < 0 && errno == EINTR) {
    }
    const End killed = i == 0 ? End::kWriterKilled : End::kReaderKilled;
    if (!EndedAsExpected(status, scenario.end == killed)) {
      fprintf(stderr, "the %s ended with status 0x%x\n", kRoles[i], status);
      result = 1;
    }
  }
  for (int i = 0; i < 2; i++) {
    printf("-- %s\n", kRoles[i]);
    Copy(words[i]);
  }
  return result;
}

// The writer waits there, the reader tries until it does.
int MeetAt(const char* path, Role role) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (strlen(path) >= sizeof address.sun_path) Fail("the path '%s' is too long", path);
  strcpy(address.sun_path, path);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto* where = reinterpret_cast<const sockaddr*>(&address);
  if (role == Role::kWriter) {
    if (bind(fd, where, sizeof address) != 0 || listen(fd, 1) != 0)
      Fail("cannot listen at '%s': %s", path, strerror(errno));
    const int peer = accept4(fd, nullptr, nullptr, SOCK_CLOEXEC);
    close(fd);
    return peer;
  }
  WaitUntil("the writer listens", [&] { return connect(fd, where, sizeof address) == 0; });
  return fd;
}

int Main(int argc, char** argv) {
  if (argc != 3 && argc != 5) {
    fprintf(stderr, "usage: %s NAME native|sockets|endpoints\n", argv[0]);
    return 2;
  }
  const Scenario* scenario = FindScenario(argv[1]);
  if (scenario == nullptr) Fail("there is no scenario '%s'", argv[1]);
  const Under under = strcmp(argv[2], "endpoints") == 0 ? Under::kEndpoints
                      : strcmp(argv[2], "sockets") == 0 ? Under::kSockets
                                                        : Under::kNative;
  if (argc == 5) {
    const Role role = strcmp(argv[3], kRoles[0]) == 0 ? Role::kWriter : Role::kReader;
    const bool is_path = argv[4][0] == '/' || argv[4][0] == '.';
    return Play(*scenario, under, role, is_path ? MeetAt(argv[4], role) : atoi(argv[4]));
  }
  if (under != Under::kNative) ProveVirtualTime();
  return StartBoth(*scenario, argv);
}

}  // namespace
}  // namespace dds_test

int main(int argc, char** argv) { return dds_test::Main(argc, argv); }
