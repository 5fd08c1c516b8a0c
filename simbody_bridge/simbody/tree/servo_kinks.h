// When servos reach what they can give in the course of a step, or have less to give again: there
// the rates have a kink, and what is in closed form before it is not what is behind it.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/simbody/tree/tree.h"

namespace tcs {

class ServoKinks {
 public:
  // Of steps that begin in `state`.
  void Begin(const SimbodyTree& tree, std::span<const Wrench> acting,
             std::span<const double> state);
  // When the first one has happened, of a motion that has led to `state` after `h` seconds, and so
  // little later that the next step begins behind it; else `h`. Motions of one step are asked about
  // one after the other, each no longer than the one before: the second one tells how steeply what
  // a servo is asked for grows there.
  double First(const SimbodyTree& tree, std::span<const Wrench> acting,
               std::span<const double> state, double h);

  // When what First found last happens, of a motion that was to end behind it, has led to `state`
  // after `h` seconds, and has not reached it; else `h`.
  double Missed(const SimbodyTree& tree, std::span<const Wrench> acting,
                std::span<const double> state, double h);

 private:
  // For each joint, what its servo is asked for by what it can give; 0 without a servo.
  std::vector<double> asked_, asked_at_end_, asked_before_;
  std::vector<double> slopes_;  // 1/s; 0: not known
  double before_s_ = 0;         // how long the motion before was
  // What First found last: whose servo, and what it is asked for.
  std::size_t joint_ = 0;
  double limit_ = 0;  // -1 or 1; 0: nothing
};

}  // namespace tcs
