// The facts that the kernel of the host tells of threads: beside a coordinator's own knowledge of
// them, and in its place where the coordinator does not answer. Reads /proc as an ordinary process;
// facts that the kernel does not tell are left out.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace tcs {

// The name of a process as the kernel has it, at most 15 characters; empty: there is no such
// process.
[[nodiscard]] std::string KernelNameOf(pid_t pid);

// {"name", "state" (as ps has it), "cpu" (that it ran on last), "processor_ns", "in" (the function
// of the kernel that it waits in), "call" (the number of the system call that it is in)}; null if
// there is no such thread.
[[nodiscard]] nlohmann::ordered_json KernelStateOf(pid_t pid, pid_t tid);

// Adds these facts to each thread of a coordinator's answer, and the owners of the locks that
// threads wait for, as far as the lock tells its owner: a mutex of the C library does.
void AddWhatTheKernelKnows(nlohmann::ordered_json* state);

}  // namespace tcs
