// The orderly end of a run, once it has concluded.
#include <x86gprintrin.h>

#include "coordinator/core/engine.h"
#include "coordinator/os/descendants.h"
#include "coordinator/os/host.h"

namespace tcs {

// The clients that still live get their grace (grace.h), in which the loop goes on for them.
void Engine::EndClients() {
  BeginGrace();
  while (grace_.GoOnToNextKill()) {
    idle_at_.reset();
    while (!grace_.IsOver() && Step()) {
    }
    if (grace_.KillOverdue()) WaitOutside();
  }
  grace_.WarnOfThoseLeft();
}

// The world stops, and nothing is recorded any more.
void Engine::BeginGrace() {
  run_.grace_began = RobotTime(run_.report.virtual_ns);
  if (run_.turn.lasts()) Settle(*run_.turn.task());  // the dynamics have failed beside it
  run_.turn.End();
  run_.root.EndDynamics();
  dds_.records().Stop();
  for (const int fd : world_.command_fds()) {
    if (fd >= 0) reactor_.Remove(fd);
  }
  for (VirtualCpu& cpu : run_.cpus) {
    if (reached_end_) cpu.ComeTo(std::max(cpu.progress, run_.grace_began));
  }
  launches_.Stop();
  grace_.Begin();
}

// Whoever is left now is killed. None may keep the processor meanwhile, nor this process, which
// waits in the kernel for the last steps of their threads.
void Engine::Shutdown() {
  state_link_.Does(Doing::kEnds, __rdtsc());
  run_.header->shutdown.store(1);
  for (const Task& task : run_.table.tasks()) {
    if (task.state != TaskState::kDead) LeaveRealTime(task.tid);
  }
  LeaveRealTime(0);
  // Everything that descends from this process and lost its parent is ours to end and to reap, too.
  KillDescendants();
}

}  // namespace tcs
