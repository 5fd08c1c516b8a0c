#pragma once

namespace tcs {

// "0.1.0", as CMakeLists.txt has it.
extern const char kVersion[];

}  // namespace tcs
