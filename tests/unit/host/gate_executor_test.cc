#include "coordinator/host/gate_executor.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdint>

#include "coordinator/port/thread_signals.h"
#include "shm/layout.h"

namespace tcs {
namespace {

constexpr std::uint64_t kDispatch = 4711;

// What the shim does with it, but for the gate.
void EndAsTold(int, siginfo_t* info, void*) {
  const auto ended = reinterpret_cast<std::uintptr_t>(info->si_value.sival_ptr);
  _exit(info->si_code == SI_QUEUE && ended == kDispatch ? 3 : 4);
}

// The C library does not let a program catch it.
void Catch(int signal) {
  struct {
    void (*handler)(int, siginfo_t*, void*) = EndAsTold;
    unsigned long flags = SA_SIGINFO | 0x04000000;
    void (*restorer)() = nullptr;  // it does not return
    unsigned long mask = 0;
  } const action;
  struct sigaction libcs {};
  if (sigaction(signal, &libcs, nullptr) == 0) _exit(5);
  if (syscall(SYS_rt_sigaction, signal, &action, nullptr, 8) != 0) _exit(6);
}

TEST(GateExecutor, SendsAThreadThatComputesToItsGateByASignalWithTheNumberOfItsDispatch) {
  int caught[2];
  ASSERT_EQ(pipe(caught), 0);
  const pid_t child = fork();
  if (child == 0) {
    Catch(shm::kPreemptionSignal);
    if (write(caught[1], "x", 1) != 1) _exit(7);
    alarm(100);
    for (volatile bool computes = true; computes;) {
    }
    _exit(0);
  }
  char ready;
  ASSERT_EQ(read(caught[0], &ready, 1), 1);
  GateExecutor executor;
  EXPECT_FALSE(executor.StandsStill());
  executor.Hold(child);  // which does nothing
  SendToGate(child, child, kDispatch);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << status;
  close(caught[0]);
  close(caught[1]);
}

}  // namespace
}  // namespace tcs
