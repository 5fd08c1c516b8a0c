#include "coordinator/report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coordinator/report/text.h"

namespace tcs::report {

double NiceStep(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= step * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

Axis Axis::Exact(double low, double high, int ticks) {
  Axis axis;
  if (!(high > low)) high = low + 1;
  const double step = NiceStep((high - low) / std::max(1, ticks));
  axis.low_ = low;
  axis.high_ = high;
  axis.decimals_ = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  const double first = std::ceil(low / step - 1e-9);
  for (int i = 0; (first + i) * step <= high + 1e-9 * step; ++i) {
    axis.ticks_.push_back((first + i) * step);
  }
  return axis;
}

Axis Axis::Linear(double low, double high, int ticks) {
  if (!(high > low)) high = low + 1;
  const double step = NiceStep((high - low) / std::max(1, ticks));
  return Exact(step * std::floor(low / step + 1e-9), step * std::ceil(high / step - 1e-9), ticks);
}

Axis Axis::Decades(double low, double high) {
  const auto power = [](double value) { return std::pow(10.0, value); };
  const double first = std::floor(std::log10(low) + 1e-9);
  const double last = std::ceil(std::log10(std::max(low, high)) - 1e-9);
  return Logarithmic(power(first), power(std::max(last, first + 1)));
}

Axis Axis::Logarithmic(double low, double high) {
  Axis axis;
  axis.logarithmic_ = true;
  if (!(high > low)) high = low;
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(high) - 1e-9));
  std::vector<double> steps;
  for (int power = first; power <= last; ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) steps.push_back(factor * std::pow(10.0, power));
  }
  axis.low_ = steps.front();
  axis.high_ = steps.back();
  for (const double step : steps) {
    if (step <= low * (1 + 1e-9)) axis.low_ = step;
  }
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (*step >= high * (1 - 1e-9)) axis.high_ = *step;
  }
  if (axis.high_ <= axis.low_) axis.high_ = 10 * axis.low_;
  // Only powers of ten where there are many.
  const bool sparse = axis.high_ / axis.low_ > 300;
  for (const double step : steps) {
    const double power = std::log10(step);
    if (sparse && std::abs(power - std::round(power)) > 1e-9) continue;
    if (step >= axis.low_ * (1 - 1e-9) && step <= axis.high_ * (1 + 1e-9)) {
      axis.ticks_.push_back(step);
    }
  }
  return axis;
}

double Axis::Pixel(double value) const {
  const double share = logarithmic_
                           ? std::log(std::max(value, low_ * 1e-6) / low_) / std::log(high_ / low_)
                           : (value - low_) / (high_ - low_);
  return from_ + share * (to_ - from_);
}

std::string Axis::Label(double tick) const {
  if (logarithmic_) return Significant(tick, 1);
  return fmt::format("{:.{}f}", tick == 0 ? 0.0 : tick, decimals_);
}

}  // namespace tcs::report
