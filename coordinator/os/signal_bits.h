// Sets of signals as the kernel writes them: bit 0 is signal 1.
#pragma once

#include <signal.h>

#include <cstdint>

namespace tcs {

constexpr std::uint64_t SignalBit(int signal) { return std::uint64_t{1} << (signal - 1); }

// The signals that stop a process that does not catch or ignore them. A process can do neither with
// SIGSTOP.
constexpr std::uint64_t kStopSignals =
    SignalBit(SIGSTOP) | SignalBit(SIGTSTP) | SignalBit(SIGTTIN) | SignalBit(SIGTTOU);

}  // namespace tcs
