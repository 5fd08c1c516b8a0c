#include "coordinator/cli/print.h"

#include <cerrno>
#include <cstring>

#include "coordinator/cli/basics/exit_status.h"

namespace tcs {

int FlushStdout(int status) {
  const bool was_bad = std::ferror(stdout) != 0;
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if ((flushed && !was_bad) || errno == EBADF || status != kSucceeded) return status;
  return Fail(fmt::format("not everything could be printed{}; look where the output goes",
                          errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

}  // namespace tcs
