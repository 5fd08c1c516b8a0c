#include "coordinator/engine/network_leaf.h"

#include <algorithm>

#include "coordinator/engine/wiring.h"
#include "coordinator/os/guardian.h"

namespace tcs {

void NetworkLeaf::Join(int computer) { leaf_ = run_.root.AddLeaf(computer); }

bool NetworkLeaf::Step() {
  const VirtualTime due = all_.network.NextDue();
  if (due > run_.root.Least() || due >= run_.end) return false;
  run_.latest = std::max(run_.latest, due);
  Beat();
  all_.network.Arrive(due);
  ShowAt(std::max(progress_, due));
  all_.event_pump.Poll(EventPump::kNoWait, {.at = due, .from_outside = true});
  return true;
}

void NetworkLeaf::ShowAt(VirtualTime progress) {
  progress_ = progress;
  run_.root.Update(leaf_, progress_, all_.network.NextDue());
}

}  // namespace tcs
