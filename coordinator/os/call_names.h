// System calls by name, for messages.
#pragma once

#include <string>

namespace tcs {

// `number` as /proc says it: "close (system call 3)"; "system call 999" where the call is none of
// those in which the kernel is known to hold threads.
std::string NameOfSystemCall(const std::string& number);

}  // namespace tcs
