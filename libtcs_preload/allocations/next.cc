#include "libtcs_preload/allocations/next.h"

namespace tcs::preload {

__thread bool t_looking = false;

}  // namespace tcs::preload
