#include "coordinator/os/cpu_share.h"

#include <unistd.h>

#include <utility>

#include "coordinator/os/claim_order.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/cpu_places.h"
#include "coordinator/os/descendants.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

// A thread that makes others while it is looked for makes them on the CPU that it is to leave.
constexpr int kMostMovePasses = 8;

// Threads that are bound elsewhere stay there. False if there was no thread to move.
bool MoveThreadsOf(pid_t pid, int from, int to) {
  bool found = false;
  for (const pid_t tid : ThreadsOf(pid)) {
    if (IsBoundTo(tid, from)) found |= BindTo(tid, to);
  }
  return found;
}

void MoveAll(int from, int to) {
  BindTo(0, to);  // first: hardly any time is left to this thread there
  bool found = true;
  for (int pass = 0; found && pass < kMostMovePasses; ++pass) {
    found = MoveThreadsOf(getpid(), from, to);
    for (const pid_t pid : DescendantsOf(getpid())) found |= MoveThreadsOf(pid, from, to);
  }
}

}  // namespace

CpuShare::CpuShare() : allowed_(AllowedCpus()) {
  cpu_ = others_.Share([this] { return Choose(); });
}

int CpuShare::Choose() const {
  return CpuToShare(allowed_, IsClaimed, [this](int cpu) { return others_.SharersOf(cpu); });
}

bool CpuShare::LeaveIfClaimed() {
  if (allowed_.size() < 2 || !IsClaimed(cpu_) || IsClaimed(Choose())) return false;
  const int before = std::exchange(cpu_, others_.Share([this] { return Choose(); }));
  if (cpu_ == before) return false;
  MoveAll(before, cpu_);
  return true;
}

}  // namespace tcs
