// A seccomp filter, instruction by instruction, for programs that install one and execute a
// command.
#pragma once

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stdio.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>
#include <vector>

namespace seccomp_filter {

inline sock_filter Statement(unsigned code, unsigned k) {
  return {static_cast<unsigned short>(code), 0, 0, k};
}
inline sock_filter Jump(unsigned test, unsigned k, std::size_t yes, std::size_t no) {
  return {static_cast<unsigned short>(BPF_JMP | test | BPF_K), static_cast<unsigned char>(yes),
          static_cast<unsigned char>(no), k};
}
inline sock_filter Load(std::size_t at) {
  return Statement(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(at));
}
inline sock_filter Return(unsigned action) { return Statement(BPF_RET | BPF_K, action); }

// For this process and all that it executes. False: errno is set.
inline bool Install(std::vector<sock_filter> code) {
  const sock_fprog program{static_cast<unsigned short>(code.size()), code.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) == 0;
}

// Executes the words after the first behind that filter. Returns the exit status if it cannot, or
// if `refuses`, which is asked at once, is false: the tests that use this would show nothing.
inline int ExecuteBehind(const std::vector<sock_filter>& filter, bool (*refuses)(), char** words) {
  if (words[0] == nullptr || words[1] == nullptr) return 2;
  if (!Install(filter)) {
    perror("the filter cannot be installed");
    return 126;
  }
  if (!refuses()) {
    fprintf(stderr, "%s: what is to be refused is not, or more is\n", words[0]);
    return 126;
  }
  execvp(words[1], words + 1);
  perror(words[1]);
  return 127;
}

}  // namespace seccomp_filter
