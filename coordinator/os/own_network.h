// A network of its own for a process and all that it starts: programs with the same fixed ports run
// side by side, and meet nobody else on this machine. The network has a loopback interface and
// nothing else.
#pragma once

#include <string>

namespace tcs {

// Puts the calling process, which must be the only thread, into a network of its own. Needs root or
// user namespaces. Empty on success, else the kernel's reason.
[[nodiscard]] std::string EnterOwnNetwork();

// Why runs cannot be given networks of their own; empty if they can. Tries it in a process made for
// that: real-time priority has to outlive it.
[[nodiscard]] std::string WhyNoOwnNetwork();

}  // namespace tcs
