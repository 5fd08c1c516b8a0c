#include "coordinator/os/clone_call.h"

#include <linux/sched.h>
#include <signal.h>
#include <sys/syscall.h>

#include <algorithm>

namespace tcs {

std::optional<CloneCall> ReadCloneCall(const TrappedCall& call) {
  CloneCall read;
  switch (call.number) {
    case SYS_fork:
      break;
    case SYS_vfork:
      read.flags = CLONE_VM | CLONE_VFORK;
      break;
    case SYS_clone:
      read = {.flags = call.args[0],
              .tid_address = call.args[2],
              .end_word = call.args[3],
              .tls = call.args[4]};
      break;
    case SYS_clone3: {
      clone_args args{};
      const std::size_t size = std::min<std::size_t>(call.args[1], sizeof args);
      if (size < CLONE_ARGS_SIZE_VER0 || !ReadMemory(call.tid, call.args[0], &args, size)) {
        return std::nullopt;
      }
      read = {.flags = args.flags,
              .tid_address = args.parent_tid,
              .end_word = args.child_tid,
              .tls = args.tls};
      break;
    }
    default:
      return std::nullopt;
  }
  if ((read.flags & CLONE_PARENT_SETTID) == 0) read.tid_address = 0;
  if ((read.flags & CLONE_CHILD_CLEARTID) == 0) read.end_word = 0;
  if ((read.flags & CLONE_SETTLS) == 0) read.tls = 0;
  return read;
}

}  // namespace tcs
