// When servos reach what they can give in the course of a step, or come back from there: the rates
// have a kink then, and what is in closed form before it is not what is behind it.
//
// A joint's effort ratio is what its servo is asked for by what it can give. A crossing is where it
// passes -1 or 1. All times are of whole nanoseconds since the step's beginning.
#pragma once

#include <functional>
#include <vector>

namespace tcs {

class LimitCrossings {
 public:
  // Finds the effort ratios `h` seconds after the beginning of a step, by a motion that is known.
  using FindRatios = std::function<void(double h, std::vector<double>* ratios)>;

  // Of a step that begins with these effort ratios.
  void Begin(const std::vector<double>& ratios);

  // When the first crossing within `h` has happened, by so little that a step which begins there
  // begins behind it; else `h`. Of a ratio that crosses and comes back within `h` it may see
  // nothing.
  double Predict(double h, const FindRatios& find);

  // A step of `h` was tried, and its motion led to `ratios`. When the crossing that Predict has
  // found comes if it has yet to come, as far as that can be told; else `h`.
  double Late(double h, const std::vector<double>& ratios) const;
  // When the first crossing was, as far as that can be told; else `h`.
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
  // What Predict has found: whose ratio passes which limit. 0: nothing.
  std::size_t joint_ = 0;
  double limit_ = 0;
  Point tried_;  // what First was asked about before; its h is 0 if nothing
};

}  // namespace tcs
