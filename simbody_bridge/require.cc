#include "simbody_bridge/require.h"

#include <cstdio>
#include <cstdlib>

namespace tcs {

void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "tcs: bug: %s\n", what);
  std::abort();
}

}  // namespace tcs
