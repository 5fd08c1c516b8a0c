// The network between robots as a leaf of the run.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/policy/temporal_consistency.h"

namespace tcs {

class NetworkLeaf : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // `computer`: the leaf's number among the robots' computers.
  void Join(int computer);
  TemporalConsistency::Leaf leaf() const { return leaf_; }  // -1: there is no network
  // Packets arrive once no thread can act before that. False if no packet arrives.
  bool Step();
  // Another packet is on its way.
  void Update() { ShowAt(progress_); }

 private:
  void ShowAt(VirtualTime progress);

  TemporalConsistency::Leaf leaf_ = -1;
  VirtualTime progress_;
};

}  // namespace tcs
