// Where the world lies on the earth.
#pragma once

#include <array>

namespace tcs {

// On the ellipsoid of WGS 84.
struct Geodetic {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;  // above the ellipsoid

  bool operator==(const Geodetic&) const = default;
};

// Where `enu_m` is: metres to the east and to the north of `origin`, and up from it, along the axes
// of the plane that touches the ellipsoid there.
Geodetic ToGeodetic(const Geodetic& origin, const std::array<double, 3>& enu_m);

}  // namespace tcs
