#include "coordinator/os/landlock.h"

#include <errno.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

namespace tcs {

namespace {

constexpr unsigned kAsksForVersion = 1;  // LANDLOCK_CREATE_RULESET_VERSION
constexpr long kLastWithoutScopes = 5;

}  // namespace

bool AsksForLandlockVersion(const std::uint64_t (&arguments)[6]) {
  return arguments[0] == 0 && arguments[1] == 0 &&
         static_cast<std::uint32_t>(arguments[2]) == kAsksForVersion;
}

std::int64_t LandlockVersionForPrograms() {
  const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0, kAsksForVersion);
  return version < 0 ? -errno : std::min(version, kLastWithoutScopes);
}

}  // namespace tcs
