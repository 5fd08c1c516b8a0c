#include "coordinator/cli/basics/version.h"

namespace tcs {

const char kVersion[] = TCS_VERSION;

}  // namespace tcs
