#include "coordinator/metrics/expression.h"

#include <algorithm>
#include <cmath>

#include "shm/check.h"

namespace tcs {

double Expression::Evaluate(std::span<const double> values) const {
  std::array<double, kMostKept> kept;
  std::size_t size = 0;
  const auto two = [&](auto combine) {
    --size;
    kept[size - 1] = combine(kept[size - 1], kept[size]);
  };
  for (const Step& step : steps_) {
    switch (step.kind) {
      case Kind::kNumber:
        kept[size++] = step.number;
        break;
      case Kind::kValue:
        kept[size++] = values[step.count];
        break;
      case Kind::kAdd:
        two([](double a, double b) { return a + b; });
        break;
      case Kind::kSubtract:
        two([](double a, double b) { return a - b; });
        break;
      case Kind::kMultiply:
        two([](double a, double b) { return a * b; });
        break;
      case Kind::kNegate:
        kept[size - 1] = -kept[size - 1];
        break;
      case Kind::kNorm: {
        size -= step.count;
        double norm = 0;
        for (std::size_t i = 0; i < step.count; ++i) norm = std::hypot(norm, kept[size + i]);
        kept[size++] = norm;
        break;
      }
      case Kind::kLess:
        two([](double a, double b) { return a < b ? 1.0 : 0.0; });
        break;
      case Kind::kLessOrEqual:
        two([](double a, double b) { return a <= b ? 1.0 : 0.0; });
        break;
      case Kind::kMore:
        two([](double a, double b) { return a > b ? 1.0 : 0.0; });
        break;
      case Kind::kMoreOrEqual:
        two([](double a, double b) { return a >= b ? 1.0 : 0.0; });
        break;
    }
  }
  TCS_CHECK(size == 1);
  return kept[0];
}

std::vector<std::size_t> Expression::Needs() const {
  std::vector<std::size_t> needs;
  for (const Step& step : steps_) {
    if (step.kind == Kind::kValue) needs.push_back(step.count);
  }
  std::ranges::sort(needs);
  needs.erase(std::unique(needs.begin(), needs.end()), needs.end());
  return needs;
}

}  // namespace tcs
