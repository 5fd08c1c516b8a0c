#include "coordinator/engine/run_end.h"

#include <algorithm>

#include "coordinator/engine/wiring.h"
#include "coordinator/os/descendants.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/levels.h"

namespace tcs {

void RunEnd::EndClients() {
  BeginGrace();
  while (all_.grace.GoOnToNextKill()) {
    all_.idle_time.StartAnew();
    while (!all_.grace.IsOver() && all_.loop.Step()) {
    }
    if (all_.grace.KillOverdue()) all_.idle_time.WaitOutside();
  }
  all_.grace.WarnOfThoseLeft();
}

// The world stops, and nothing is recorded any more.
void RunEnd::BeginGrace() {
  run_.grace_began = RobotTime(run_.report.virtual_ns);
  if (run_.turn.lasts())
    all_.settler.Settle(*run_.turn.task());  // the dynamics have failed beside it
  run_.turn.End();
  run_.root.EndDynamics();
  all_.dds.records().Stop();
  for (const int fd : all_.world.command_fds()) {
    if (fd >= 0) all_.reactor.Remove(fd);
  }
  for (VirtualCpu& cpu : run_.cpus) {
    if (all_.loop.reached_end()) cpu.ComeTo(std::max(cpu.progress, run_.grace_began));
  }
  all_.launches.Stop();
  all_.grace.Begin();
}

// No process that is killed may keep the processor meanwhile, nor may this process, which waits in
// the kernel for the last steps of the killed processes' threads.
void RunEnd::Shutdown() {
  all_.state_link.Does(Doing::kEnds, HostTsc());
  run_.header->shutdown.store(1);
  for (const Task& task : run_.table.tasks()) {
    if (task.state != TaskState::kDead) LeaveRealTime(task.tid);
  }
  LeaveRealTime(0);
  // Everything that descends from this process and lost its parent is ours to end and to reap, too.
  KillDescendants();
}

}  // namespace tcs
