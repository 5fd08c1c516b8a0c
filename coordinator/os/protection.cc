#include "coordinator/os/protection.h"

#include <asm/sockios.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <sys/ioctl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

#include "coordinator/os/filter_code.h"

namespace tcs {

namespace {

using filter::LoadArgument;
using filter::Return;

// A call that names a process in an argument. For a call that sends a signal, also the argument
// with the signal: the signal 0 is none.
struct NamingCall {
  std::uint32_t number;
  std::size_t process;
  int signal = -1;  // no argument
};

// The calls' numbers, in which the architectures differ.
struct Numbers {
  std::vector<NamingCall> naming;
  std::vector<std::uint32_t> unfollowed;  // by a pidfd; or to the scheduler, which is the robot's
  std::uint32_t kill, ptrace, ioctl;
  std::vector<std::uint32_t> fcntls;
};

const Numbers& NumbersOf(CallTable table) {
  static const Numbers native{
      {{SYS_kill, 0, 1},
       {SYS_tkill, 0, 1},
       {SYS_tgkill, 0, 2},
       {SYS_rt_sigqueueinfo, 0, 1},
       {SYS_rt_tgsigqueueinfo, 0, 2},
       {SYS_ptrace, 1},
       {SYS_process_vm_readv, 0},
       {SYS_process_vm_writev, 0},
       {SYS_prlimit64, 0},
       {SYS_setpriority, 1}},
      {SYS_pidfd_send_signal, SYS_pidfd_getfd, SYS_process_madvise, SYS_sched_setscheduler,
       SYS_sched_setparam, SYS_sched_setattr, SYS_sched_setaffinity},
      SYS_kill,
      SYS_ptrace,
      SYS_ioctl,
      {SYS_fcntl}};
  static const Numbers of_32_bits{{{37, 0, 1},
                                   {238, 0, 1},
                                   {270, 0, 2},
                                   {178, 0, 1},
                                   {335, 0, 2},
                                   {26, 1},
                                   {347, 0},
                                   {348, 0},
                                   {340, 0},
                                   {97, 1}},
                                  {424, 438, 440, 154, 156, 241, 351},
                                  37,
                                  26,
                                  54,
                                  {55, 221}};
  return table == CallTable::kNative ? native : of_32_bits;
}

sock_filter Statement(std::uint16_t code, std::uint32_t k) { return {code, 0, 0, k}; }
sock_filter LoadNumber() { return filter::Load(offsetof(seccomp_data, nr)); }
sock_filter Jump(std::uint16_t test, std::uint32_t k, std::size_t yes, std::size_t no) {
  return {static_cast<std::uint16_t>(BPF_JMP | test | BPF_K), static_cast<std::uint8_t>(yes),
          static_cast<std::uint8_t>(no), k};
}

using Code = std::vector<sock_filter>;

void Append(Code* code, const Code& more) { code->insert(code->end(), more.begin(), more.end()); }

// `body` for one call; a call from which `body` does not return goes on with the number.
void AppendFor(Code* code, std::uint32_t number, Code body) {
  body.push_back(LoadNumber());
  code->push_back(Jump(BPF_JEQ, number, 0, body.size()));
  Append(code, body);
}

// Returns with `action` if the loaded value is one of `values`, else skips that.
Code ReturnIfAny(const std::vector<std::uint32_t>& values, const Code& action) {
  Code code;
  for (std::size_t i = 0; i < values.size(); ++i) {
    code.push_back(Jump(BPF_JEQ, values[i], values.size() - i, 0));
  }
  code.push_back(Statement(BPF_JMP | BPF_JA, static_cast<std::uint32_t>(action.size())));
  Append(&code, action);
  return code;
}

}  // namespace

std::vector<sock_filter> Protection(CallTable table, const std::vector<pid_t>& guarded) {
  const Numbers& numbers = NumbersOf(table);
  const sock_filter refuse = Return(SECCOMP_RET_ERRNO | EPERM);
  const sock_filter ask = table == CallTable::kNative ? Return(SECCOMP_RET_USER_NOTIF) : refuse;
  std::vector<std::uint32_t> processes, owners;
  for (const pid_t pid : guarded) {
    processes.push_back(static_cast<std::uint32_t>(pid));
    owners.push_back(static_cast<std::uint32_t>(pid));
    owners.push_back(static_cast<std::uint32_t>(-getpgid(pid)));
  }
  Code code;
  for (const NamingCall& call : numbers.naming) {
    Code action;
    if (call.signal >= 0) {
      const auto signal = static_cast<std::size_t>(call.signal);
      action = {LoadArgument(signal), Jump(BPF_JEQ, 0, 1, 0)};
    }
    action.push_back(refuse);
    Code body{LoadArgument(call.process)};
    Append(&body, ReturnIfAny(processes, action));
    AppendFor(&code, call.number, body);
  }
  // A signal to all of a group, or to every process.
  AppendFor(&code, numbers.kill,
            {LoadArgument(0), Jump(BPF_JEQ, 0, 1, 0), Jump(BPF_JGE, 1u << 31, 0, 1), ask});
  AppendFor(&code, numbers.ptrace, {LoadArgument(0), Jump(BPF_JEQ, PTRACE_TRACEME, 0, 1), ask});
  for (const std::uint32_t number : numbers.unfollowed) AppendFor(&code, number, {ask});
  // The kernel sends signals to the owner of a descriptor.
  AppendFor(&code, numbers.ioctl,
            {LoadArgument(1), Jump(BPF_JEQ, FIOSETOWN, 1, 0), Jump(BPF_JEQ, SIOCSPGRP, 0, 1), ask});
  for (const std::uint32_t number : numbers.fcntls) {
    constexpr std::uint32_t kSetOwnerEx = 15;  // F_SETOWN_EX
    Code body{LoadArgument(1), Jump(BPF_JEQ, kSetOwnerEx, 0, 1), ask};
    Code owner{LoadArgument(2)};
    Append(&owner, ReturnIfAny(owners, {refuse}));
    body.push_back(Jump(BPF_JEQ, F_SETOWN, 0, owner.size()));
    Append(&body, owner);
    AppendFor(&code, number, body);
  }
  return code;
}

}  // namespace tcs
