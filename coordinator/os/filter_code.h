// Statements of the kernel's filters for system calls (seccomp(2)), which look at seccomp_data.
#pragma once

#include <linux/filter.h>
#include <linux/seccomp.h>

#include <cstddef>
#include <cstdint>

namespace tcs::filter {

inline sock_filter Return(std::uint32_t action) { return {BPF_RET | BPF_K, 0, 0, action}; }

// The word at that offset of seccomp_data.
inline sock_filter Load(std::size_t offset) {
  return {BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(offset)};
}

// The lower half of an argument.
inline sock_filter LoadArgument(std::size_t argument) {
  return Load(offsetof(seccomp_data, args) + sizeof(std::uint64_t) * argument);
}

}  // namespace tcs::filter
