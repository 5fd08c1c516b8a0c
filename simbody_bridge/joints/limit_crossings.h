// The times at which servos reach what they can give in the course of a step, or come back from
// there: the rates have a kink then, and the closed form before the kink is not the one behind it.
//
// A joint's effort ratio is the effort that its servo is asked for, divided by the effort that it
// can give. A crossing is where the ratio passes -1 or 1. All times are of whole nanoseconds since
// the step's beginning.
#pragma once

#include <functional>
#include <vector>

namespace tcs {

class LimitCrossings {
 public:
  // Finds the effort ratios `h` seconds after the beginning of a step, by a motion that is known.
  using FindRatios = std::function<void(double h, std::vector<double>* ratios)>;

  // Begins a step that has these effort ratios at its beginning.
  void Begin(const std::vector<double>& ratios);

  // The time at which the first crossing within `h` has happened, by so little that a step which
  // begins there begins behind it; else `h`. A ratio that crosses and comes back within `h` may not
  // be seen.
  double Predict(double h, const FindRatios& find);

  // A step of `h` was tried, and its motion led to `ratios`. Returns the time of the crossing that
  // Predict has found if it has yet to come, as far as that can be told; else `h`.
  double Late(double h, const std::vector<double>& ratios) const;
  // The time of the first crossing, as far as that can be told; else `h`.
  double First(double h, const std::vector<double>& ratios);

 private:
  struct Point {
    double h = 0;
    std::vector<double> ratios;
  };

  bool HasCrossed(const std::vector<double>& ratios) const;
  double Estimate(const Point& before, const Point& behind, const Point& last, const Point& latest);

  Point start_;
  std::vector<double> slopes_;  // 1/s, where a crossing was found; 0: not known
  // The crossing that Predict has found: whose ratio passes which limit. 0: none.
  std::size_t joint_ = 0;
  double limit_ = 0;
  Point tried_;  // the point that First was asked about before; h is 0: none
};

}  // namespace tcs
