// Calls of programs that the kernel hands to the coordinator (os/trap.h says which), and what the
// coordinator reads and writes in their memory to answer them.
#pragma once

#include <sys/types.h>
#include <sys/uio.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

namespace tcs {

struct TrappedCall {
  int listener = -1;     // where it arrived,
  std::uint64_t id = 0;  // and what it is answered by there
  pid_t tid = 0;
  int number = 0;
  std::uint64_t args[6] = {};

  // True of a call that the kernel makes again as it was: something has ended the wait for its
  // answer, and no handler has run that would have made the call fail.
  bool IsAgain(const TrappedCall& before) const {
    return listener == before.listener && tid == before.tid && number == before.number &&
           std::equal(std::begin(args), std::end(args), std::begin(before.args));
  }
};

// The next call that waits at `listener`; none if its thread has gone meanwhile.
std::optional<TrappedCall> ReceiveTrapped(int listener);

// Ends the call with `result`, negative for an errno. False if the thread no longer waits there: a
// signal has ended the call.
bool AnswerTrapped(int listener, std::uint64_t id, std::int64_t result);
// Ends the call with a descriptor of the file, which the caller has from then on; `on_exec`: also
// when the caller executes another program.
bool AnswerTrappedByFile(int listener, std::uint64_t id, int file, bool on_exec);
// The same without ending the call. The number, or -1: errno is set.
int PutFileInto(int listener, std::uint64_t id, int file, bool on_exec);
// Lets the kernel carry the call out.
bool ContinueTrapped(int listener, std::uint64_t id);

// While the call waits its process gets a copy of the descriptor `ours`, under `number`, which
// names another of its descriptors until then. The copy is closed at an exec.
bool GiveDescriptor(const TrappedCall& call, int ours, int number);

// Results by which the kernel ends a call as it ends one of its own that a signal interrupts. The
// kernel knows these results only in a thread that it has marked for a signal (IsMarkedForSignal,
// proc_files.h); in any other thread they would reach the program.
namespace by_signal {
inline constexpr int kAsFlagsSay = 512;      // with EINTR, or again if SA_RESTART (ERESTARTSYS)
inline constexpr int kAgain = 513;           // the kernel makes the call again (ERESTARTNOINTR)
inline constexpr int kAgainUnlessRun = 514;  // with EINTR once a handler has run (ERESTARTNOHAND)
}  // namespace by_signal

constexpr bool EndsBySignal(std::int64_t result) {
  return result <= -by_signal::kAsFlagsSay && result >= -by_signal::kAgainUnlessRun;
}

// True if the call's thread has not taken the answer yet, because the thread has not run since.
bool HasAnswerToTake(int listener, std::uint64_t id);

// Copies from another process's memory. False if that memory is not there.
bool ReadMemory(pid_t pid, std::uint64_t address, void* to, std::size_t size);
// The same from two places, which costs hardly more than from one.
struct RemotePiece {
  std::uint64_t address;
  void* to;
  std::size_t size;
};
bool ReadMemory(pid_t pid, const RemotePiece& first, const RemotePiece& second);
bool WriteMemory(pid_t pid, std::uint64_t address, const void* from, std::size_t size);
// As much as `size` from, or to, several places one after the other.
bool ReadMemory(pid_t pid, const std::vector<iovec>& from, void* to, std::size_t size);
bool WriteMemory(pid_t pid, const std::vector<iovec>& to, const void* from, std::size_t size);

// The errno by which the kernel keeps this process from what is in the memory of a child of this
// process; 0 if the kernel does not.
int WhyNoLooksInto(pid_t pid);

}  // namespace tcs
