#include "simbody_bridge/joints/limit_crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simbody_bridge/whole_nanoseconds.h"

namespace tcs {
namespace {

// How far behind a limit the next step begins.
constexpr double kBehind = 1e-5;
// A step may end as near as this to a limit where it was to end behind the limit.
constexpr double kNear = 1e-4;
constexpr double kNanosecond = 1e-9;
constexpr double kNoCrossing = std::numeric_limits<double>::infinity();

// The first whole nanosecond behind `seconds`.
double After(double seconds) { return WholeNanoseconds(seconds + kNanosecond); }

// Whether a ratio has crossed a limit, from `start` to `end`, both less the limit.
bool Crosses(double start, double end) {
  return std::isfinite(end) && start != 0 && (start > 0) != (end > 0);
}

// Where the straight line through two points comes to `ratio`.
double OnLine(double at, double value, double slope, double ratio) {
  return at + (ratio - value) / slope;
}

}  // namespace

void LimitCrossings::Begin(const std::vector<double>& ratios) {
  start_ = {0, ratios};
  slopes_.assign(ratios.size(), 0);
  limit_ = 0;
  tried_.h = 0;
}

bool LimitCrossings::HasCrossed(const std::vector<double>& ratios) const {
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    for (const double limit : {-1.0, 1.0}) {
      if (Crosses(start_.ratios[i] - limit, ratios[i] - limit)) return true;
    }
  }
  return false;
}

// The first crossing between `before` and `behind`: by the line through the last two points where
// that leads between these, else by the line through `before` and `behind`. Never if there is none.
double LimitCrossings::Estimate(const Point& before, const Point& behind, const Point& last,
                                const Point& latest) {
  double first_s = kNoCrossing;
  for (std::size_t i = 0; i < start_.ratios.size(); ++i) {
    for (const double limit : {-1.0, 1.0}) {
      const double start = start_.ratios[i] - limit, end = behind.ratios[i] - limit;
      if (!Crosses(start, end)) continue;
      const double to = limit + (end > 0 ? kBehind : -kBehind);
      const auto along = [&](const Point& one, const Point& other) {
        return OnLine(other.h, other.ratios[i],
                      (other.ratios[i] - one.ratios[i]) / (other.h - one.h), to);
      };
      double at_s = along(last, latest);
      if (!(at_s > before.h && at_s < behind.h)) at_s = along(before, behind);
      if (!(at_s < first_s)) continue;
      first_s = at_s;
      joint_ = i;
      limit_ = limit;
    }
  }
  return first_s;
}

// Predicts by the secant method, and by halves where that gains little: from afar by halves of the
// logarithm, as a ratio may have grown with any power of the time.
double LimitCrossings::Predict(double h, const FindRatios& find) {
  constexpr int kMostRounds = 40;
  constexpr int kPatience = 2;  // rounds in which the bracket does not become half as long
  constexpr double kFar = 10;
  Point before = start_, behind{h, {}};
  find(h, &behind.ratios);
  Point last = before, latest = behind;
  int rounds_without = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const double at_s = Estimate(before, behind, last, latest);
    if (at_s == kNoCrossing) break;
    double next_s = After(at_s);
    const double length_s = behind.h - before.h;
    if (length_s < 1.5 * kNanosecond) break;
    if (next_s >= behind.h) {
      if (std::abs(behind.ratios[joint_] - limit_) < kNear) break;
      rounds_without = kPatience;  // a line that is steep from afar
    }
    const bool is_from_afar = round == 0 && kFar * next_s < h;
    if (is_from_afar || rounds_without >= kPatience || next_s <= before.h) {
      const double least_s = std::max({before.h, kNanosecond, is_from_afar ? next_s : 0});
      next_s = WholeNanoseconds(kFar * least_s < behind.h ? std::sqrt(least_s * behind.h)
                                                          : (before.h + behind.h) / 2);
      if (next_s <= before.h || next_s >= behind.h) break;
      rounds_without = 0;
    }
    last = std::exchange(latest, {next_s, {}});
    find(next_s, &latest.ratios);
    (HasCrossed(latest.ratios) ? behind : before) = latest;
    rounds_without = behind.h - before.h > length_s / 2 ? rounds_without + 1 : 0;
  }
  if (behind.h == h) limit_ = 0;
  for (std::size_t i = 0; limit_ != 0 && i < slopes_.size(); ++i) {
    slopes_[i] = (behind.ratios[i] - before.ratios[i]) / (behind.h - before.h);
  }
  return behind.h;
}

double LimitCrossings::Late(double h, const std::vector<double>& ratios) const {
  if (limit_ == 0) return h;
  const double start = start_.ratios[joint_] - limit_, end = ratios[joint_] - limit_;
  if (Crosses(start, end)) return h;
  const double to = limit_ + (start > 0 ? -kBehind : kBehind);
  const double at_s = OnLine(h, ratios[joint_], slopes_[joint_], to);
  return at_s > h && at_s < 2 * h ? After(at_s) : h;
}

double LimitCrossings::First(double h, const std::vector<double>& ratios) {
  double first_s = h;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (tried_.h > h) slopes_[i] = (tried_.ratios[i] - ratios[i]) / (tried_.h - h);
    for (const double limit : {-1.0, 1.0}) {
      const double start = start_.ratios[i] - limit, end = ratios[i] - limit;
      // A ratio that ends as little behind its limit as it is to end does not make a step fail.
      if (!Crosses(start, end) || std::abs(end) < 2 * kBehind) continue;
      const double to = limit + (end > 0 ? kBehind : -kBehind);
      double at_s = OnLine(h, ratios[i], (end - start) / h, to);
      const double by_slope_s = OnLine(h, ratios[i], slopes_[i], to);
      if (by_slope_s > 0 && by_slope_s < at_s) at_s = by_slope_s;
      if (at_s < first_s) first_s = at_s;
    }
  }
  tried_ = {h, ratios};
  return std::min(h, After(first_s));
}

}  // namespace tcs
