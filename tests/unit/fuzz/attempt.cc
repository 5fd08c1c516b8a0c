#include "tests/unit/fuzz/attempt.h"

#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>

namespace tcs::fuzz {

namespace {

[[noreturn]] void Attempt(const std::function<std::string()>& attempt, unsigned most_s, int told) {
  const rlimit processor{most_s, most_s};
  setrlimit(RLIMIT_CPU, &processor);
  alarm(10 * most_s);  // what waits takes no processor
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
#ifndef __SANITIZE_ADDRESS__
  const rlimit memory{rlim_t{2} << 30, rlim_t{2} << 30};
  setrlimit(RLIMIT_AS, &memory);
#endif
  std::string wrong;
  try {
    wrong = attempt();
  } catch (const std::exception& thrown) {
    wrong = std::string("an exception got out: ") + thrown.what();
  }
  const ssize_t n = write(told, wrong.data(), wrong.size());
  _exit(n == static_cast<ssize_t>(wrong.size()) ? 0 : 1);
}

}  // namespace

std::string Outcome(const std::function<std::string()>& attempt, unsigned most_s) {
  int ends[2];
  if (pipe(ends) != 0) return strerror(errno);
  const pid_t child = fork();
  if (child == 0) Attempt(attempt, most_s, ends[1]);
  close(ends[1]);
  std::string wrong;
  char piece[4096];
  for (ssize_t n; (n = read(ends[0], piece, sizeof piece)) > 0;) {
    wrong.append(piece, static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return std::string("it ended with ") + strsignal(WTERMSIG(status));
  if (WEXITSTATUS(status) != 0) wrong += " (exit status " + std::to_string(status >> 8) + ")";
  return wrong;
}

}  // namespace tcs::fuzz
