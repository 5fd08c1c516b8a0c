// Places and arcs in the plane, in metres and radians.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace rover {

struct Point {
  double x = 0, y = 0;
};

struct Place {
  double x = 0, y = 0, heading = 0;
};

// How a rover drives: an arc.
struct Speed {
  double ahead_mps = 0, turn_radps = 0;
};

inline Place After(const Place& place, const Speed& speed, double seconds) {
  const double middle = place.heading + speed.turn_radps * seconds / 2;
  return {place.x + speed.ahead_mps * seconds * std::cos(middle),
          place.y + speed.ahead_mps * seconds * std::sin(middle),
          place.heading + speed.turn_radps * seconds};
}

// The point in the frame of the place.
inline Point From(const Place& place, const Point& point) {
  const double dx = point.x - place.x, dy = point.y - place.y;
  const double c = std::cos(place.heading), s = std::sin(place.heading);
  return {c * dx + s * dy, c * dy - s * dx};
}

// The other way round.
inline Point InWorld(const Place& place, const Point& point) {
  const double c = std::cos(place.heading), s = std::sin(place.heading);
  return {place.x + c * point.x - s * point.y, place.y + s * point.x + c * point.y};
}

// Of an odometry message.
inline Place PlaceOf(const nlohmann::json& odometry) {
  const auto& p = odometry.at("position");
  const auto& q = odometry.at("orientation");
  const double z = q.at(2), w = q.at(3);
  return {p.at(0), p.at(1), 2 * std::atan2(z, w)};
}

}  // namespace rover
