#include "coordinator/engine/world_leaf.h"

#include <algorithm>

#include "coordinator/engine/turn_plan.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/os/guardian.h"
#include "coordinator/port/clocks.h"

namespace tcs {

bool WorldLeaf::GoesOn() const { return all_.world.present() && !run_.IsInGrace(); }

bool WorldLeaf::Step() {
  if (!GoesOn()) return false;
  const VirtualTime limit = std::min(run_.root.Least(), run_.end);
  const VirtualTime now = all_.world.progress();
  const VirtualDuration lag =
      limit == run_.end || run_.IsCallback() ? VirtualDuration() : run_.scenario.drift_bound;
  if (limit - now <= lag && all_.world.NextStop() > limit) return false;
  run_.latest = std::max(run_.latest, std::min(now, limit));
  Beat();
  const std::uint64_t begun_tsc = HostTsc();
  all_.state_link.Does(Doing::kIntegrates, begun_tsc);
  const bool sent = all_.world.Advance(limit);
  if (all_.world.HasHadHelp()) all_.ahead.MakeRoomForHelpers();
  const std::uint64_t ended_tsc = HostTsc();
  all_.state_link.Does(Doing::kSchedules, ended_tsc);
  all_.records.Integrated({now, all_.world.progress()}, {begun_tsc, ended_tsc});
  run_.root.UpdateDynamics(all_.world.progress(), all_.world.NextOutput());
  if (sent) {
    run_.latest = all_.world.progress();
    all_.records.SentSensors(run_.latest);
    all_.dds.ShowDeliverersTheirDeadlines();
    all_.event_pump.Poll(EventPump::kNoWait, {.at = run_.latest, .from_outside = true});
  }
  return true;
}

VirtualTime WorldLeaf::KeepNear(const Task& task, VirtualTime horizon) {
  if (!GoesOn() || run_.IsCallback()) return horizon;
  const VirtualTime now = task.cpu->progress, world = all_.world.progress();
  const auto to = WhereToLead({.now = now,
                               .world = world,
                               .horizon = horizon,
                               .apart = run_.root.Horizon(task.cpu->leaf),
                               .drift_bound = run_.scenario.drift_bound,
                               .computes = task.used_up >= Task::kComputes});
  if (to.has_value()) {
    const std::uint64_t begun_tsc = HostTsc();
    all_.state_link.Does(Doing::kIntegrates, begun_tsc);
    all_.world.Lead(now, std::min(*to, all_.world.NextStop()));
    const std::uint64_t ended_tsc = HostTsc();
    all_.state_link.Does(Doing::kSchedules, ended_tsc);
    all_.records.Integrated({world, all_.world.progress()}, {begun_tsc, ended_tsc});
    run_.root.UpdateDynamics(all_.world.progress(), all_.world.NextOutput());
  }
  return std::min(horizon, run_.root.DynamicsHorizon());
}

VirtualTime WorldLeaf::FurthestOfRun() const {
  VirtualTime furthest = all_.world.present() ? all_.world.progress() : VirtualTime();
  for (const VirtualCpu& cpu : run_.cpus) furthest = std::max(furthest, cpu.progress);
  return furthest;
}

}  // namespace tcs
