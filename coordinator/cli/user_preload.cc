#include "coordinator/cli/user_preload.h"

#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "shm/attach_protocol.h"

namespace tcs {

namespace {

constexpr char kPreload[] = "LD_PRELOAD";
constexpr char kSetAside[] = "TCS_USER_PRELOAD";

std::string Get(const char* name) {
  const char* value = getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::string TakeUserPreload(char** argv) {
  std::string users = Get(kSetAside);
  if (!users.empty()) {
    unsetenv(kSetAside);
    setenv(kPreload, users.c_str(), 1);
    return users;
  }
  users = Get(kPreload);
  // Inside a run LD_PRELOAD is tcs's own, and main refuses to go on.
  if (users.empty() || getenv(shm::kSocketVariable) != nullptr) return users;
  std::error_code gone;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe", gone);
  setenv(kSetAside, users.c_str(), 1);
  unsetenv(kPreload);
  if (!gone) execv(self.c_str(), argv);
  // tcsim cannot be executed again: so tcsim goes on as it is.
  unsetenv(kSetAside);
  setenv(kPreload, users.c_str(), 1);
  return users;
}

}  // namespace tcs
