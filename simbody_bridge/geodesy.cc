#include "simbody_bridge/geodesy.h"

#include <cmath>
#include <numbers>

namespace tcs {
namespace {

constexpr double kEquatorM = 6'378'137;                      // WGS 84
constexpr double kFlattening = 1 / 298.257223563;            // WGS 84
constexpr double kSquare = kFlattening * (2 - kFlattening);  // of the first eccentricity
constexpr double kDegree = std::numbers::pi / 180;

// From the centre to the earth's axis along the ellipsoid's normal.
double NormalM(double sine) { return kEquatorM / std::sqrt(1 - kSquare * sine * sine); }

}  // namespace

Geodetic ToGeodetic(const Geodetic& origin, const std::array<double, 3>& enu_m) {
  const double sin_lat = std::sin(origin.latitude_deg * kDegree);
  const double cos_lat = std::cos(origin.latitude_deg * kDegree);
  const double sin_lon = std::sin(origin.longitude_deg * kDegree);
  const double cos_lon = std::cos(origin.longitude_deg * kDegree);
  const auto& [east, north, up] = enu_m;
  const double normal = NormalM(sin_lat) + origin.altitude_m;
  // Along the axes of the earth: through the prime meridian, through 90 degrees east, to the pole.
  const double out = normal * cos_lat + up * cos_lat - north * sin_lat;
  const double x = out * cos_lon - east * sin_lon;
  const double y = out * sin_lon + east * cos_lon;
  const double z =
      (NormalM(sin_lat) * (1 - kSquare) + origin.altitude_m + up) * sin_lat + north * cos_lat;
  const double from_axis = std::hypot(x, y);
  // Bowring's method: each round gains some three digits near the ground.
  double latitude = std::atan2(z, from_axis * (1 - kSquare));
  for (int round = 0; round < 8; ++round) {
    const double sine = std::sin(latitude);
    latitude = std::atan2(z + kSquare * NormalM(sine) * sine, from_axis);
  }
  const double sine = std::sin(latitude), cosine = std::cos(latitude);
  // Along the normal, so that it holds at the poles as well.
  const double altitude =
      from_axis * cosine + z * sine - kEquatorM * std::sqrt(1 - kSquare * sine * sine);
  return {latitude / kDegree, std::atan2(y, x) / kDegree, altitude};
}

}  // namespace tcs
