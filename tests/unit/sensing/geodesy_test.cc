#include "simbody_bridge/geodesy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tcs {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(Geodesy, TheOriginIsTheOrigin) {
  const Geodetic origin{52.52, 13.405, 34};
  const Geodetic there = ToGeodetic(origin, {});
  EXPECT_NEAR(there.latitude_deg, origin.latitude_deg, 1e-12);
  EXPECT_NEAR(there.longitude_deg, origin.longitude_deg, 1e-12);
  EXPECT_NEAR(there.altitude_m, origin.altitude_m, 1e-8);
}

TEST(Geodesy, UpIsAltitude) {
  const Geodetic there = ToGeodetic({-33.9, 151.2, 10}, {0, 0, 2500});
  EXPECT_NEAR(there.latitude_deg, -33.9, 1e-12);
  EXPECT_NEAR(there.longitude_deg, 151.2, 1e-12);
  EXPECT_NEAR(there.altitude_m, 2510, 1e-7);
}

// By the radii of curvature of the ellipsoid at that latitude.
TEST(Geodesy, AMetreToTheNorthAndToTheEastIsSoManyDegrees) {
  constexpr double kLatitude = 48, kEquator = 6'378'137, kFlattening = 1 / 298.257223563;
  const double square = kFlattening * (2 - kFlattening);
  const double w = 1 - square * std::pow(std::sin(kLatitude * kDegree), 2);
  const double meridian_m = kEquator * (1 - square) / std::pow(w, 1.5);
  const double normal_m = kEquator / std::sqrt(w);
  const Geodetic north = ToGeodetic({kLatitude, 11, 0}, {0, 1, 0});
  EXPECT_NEAR((north.latitude_deg - kLatitude) * kDegree * meridian_m, 1, 1e-6);
  EXPECT_NEAR(north.longitude_deg, 11, 1e-12);
  const Geodetic east = ToGeodetic({kLatitude, 11, 0}, {1, 0, 0});
  EXPECT_NEAR((east.longitude_deg - 11) * kDegree * normal_m * std::cos(kLatitude * kDegree), 1,
              1e-6);
}

}  // namespace
}  // namespace tcs
