// Events from outside of the run, as a leaf of the run: virtual time keeps to real time while such
// an event is waited for (calls/outside_waits.h).
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

  // The leaf stands where the earliest event that may come is seen.
  void Update();
  bool is_shown() const { return is_shown_; }
  // Events that were hidden may be hidden no more.
  void LookAgainAtHidden();
  // Nothing is before the next event from outside: the event is shown, or waited for in real time.
  // False where another leaf acts first.
  bool Step();
  bool awaits() const { return awaits_; }  // in real time, just now
  // While the leaf waits in real time, an event comes at the virtual time that the real one stands
  // for.
  EventTime WhenItCame(EventTime when) const;

 private:
  TemporalConsistency::Leaf leaf_ = -1;
  bool awaits_ = false, is_shown_ = false;
};

}  // namespace tcs
