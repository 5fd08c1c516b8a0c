// What a thread of a simulated program does, by the shim's own sources. On that thread only.
#pragma once

#include <signal.h>

#include <atomic>
#include <cstdint>

#include "libtcs_preload/guest.h"

// The shim's own, under other names than the C library's.
extern "C" {
int Simulated_tgkill(pid_t pid, pid_t tid, int signal);
int Simulated_kill(pid_t pid, int signal);
int Simulated_sigaction(int signal, const struct sigaction* action, struct sigaction* before);
}

namespace tcs::simulate {

// It has its place in the run, and waits there for its first turn.
void Attach(const preload::GuestThread& guest);

// Computes for so long by the host's clock.
void Compute(std::int64_t ns);
// What its clock shows.
std::int64_t ReadClock();
// False if a signal has ended it.
bool SleepUntil(std::int64_t at_ns);
// As the C library makes it: nothing of the shim's is on the way. `operation`: FUTEX_WAIT or
// FUTEX_WAKE. Returns as the kernel does.
long Futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value);
// A timer of the thread's, by raw calls: its signal is for this thread.
int CreateTimer(int signal);
// First after that time, then after each interval; 0: not again.
void SetTimer(int timer, std::int64_t after_ns, std::int64_t interval_ns);
// The overruns of the timer's signal that was accepted last.
int OverrunsOf(int timer);
// All threads handle the signal so; `flags` of sigaction(2) besides SA_SIGINFO.
void HandleBy(int signal, void (*handler)(int, siginfo_t*, void*), int flags);

}  // namespace tcs::simulate
