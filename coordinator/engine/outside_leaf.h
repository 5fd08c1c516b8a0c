// What comes from outside of the run, as a leaf of it: virtual time keeps to real time while
// something from there is waited for (calls/outside_waits.h).
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/policy/temporal_consistency.h"
#include "coordinator/tasks/event_time.h"

namespace tcs {

class OutsideLeaf : public EnginePart {
 public:
  using EnginePart::EnginePart;

  void Join(int computer);
  TemporalConsistency::Leaf leaf() const { return leaf_; }

  // Its leaf stands where the earliest of what may come is seen.
  void Update();
  bool is_shown() const { return is_shown_; }
  // What was hidden may be no more.
  void LookAgainAtHidden();
  // Nothing is before what comes from outside next: it is shown, or waited for in real time. False
  // where somebody else acts first.
  bool Step();
  bool awaits() const { return awaits_; }  // in real time, just now
  // While it is waited for, what comes does so at the virtual time that the real one stands for.
  EventTime WhenItCame(EventTime when) const;

 private:
  TemporalConsistency::Leaf leaf_ = -1;
  bool awaits_ = false, is_shown_ = false;
};

}  // namespace tcs
