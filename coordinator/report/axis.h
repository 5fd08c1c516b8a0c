// An axis of a figure: which values it spans, where they are in pixels, and where its ticks are.
#pragma once

#include <string>
#include <vector>

namespace tcs::report {

class Axis {
 public:
  // From `low` to `high`, widened to whole ticks, at most about `ticks` of them.
  [[nodiscard]] static Axis Linear(double low, double high, int ticks);
  // From `low` to `high` and no further.
  [[nodiscard]] static Axis Exact(double low, double high, int ticks);
  // `low` and `high` are above 0; widened to powers of ten.
  [[nodiscard]] static Axis Decades(double low, double high);
  // `low` and `high` are above 0; widened to 1, 2 or 5 times a power of ten.
  [[nodiscard]] static Axis Logarithmic(double low, double high);

  // `low` is at `from`, `high` at `to`; `from` may be the greater one.
  void Place(double from, double to) { from_ = from, to_ = to; }
  [[nodiscard]] double Pixel(double value) const;

  double low() const { return low_; }
  double high() const { return high_; }
  bool is_logarithmic() const { return logarithmic_; }
  const std::vector<double>& ticks() const { return ticks_; }
  // The tick's label, written as those of the axis's other ticks: "0", "2.5", "0.001".
  [[nodiscard]] std::string Label(double tick) const;

 private:
  double low_ = 0, high_ = 1, from_ = 0, to_ = 1;
  bool logarithmic_ = false;
  int decimals_ = 0;
  std::vector<double> ticks_;
};

// 1, 2 or 5 times a power of ten: the least that is at least `step`.
[[nodiscard]] double NiceStep(double step);

}  // namespace tcs::report
