#include "coordinator/models/uniform_inertial.h"

#include <array>
#include <variant>

namespace tcs {
namespace {

using Point = std::array<double, 3>;

// The integral of x x^T over a volume, about a point.
using SecondMoment = std::array<std::array<double, 3>, 3>;

Inertial FromMoments(double mass_kg, double ixx, double iyy, double izz) {
  Inertial inertial;
  inertial.mass_kg = mass_kg;
  inertial.ixx_kgm2 = ixx;
  inertial.iyy_kgm2 = iyy;
  inertial.izz_kgm2 = izz;
  return inertial;
}

// Around the z axis.
Inertial OfRound(double mass_kg, double across, double along) {
  return FromMoments(mass_kg, across, across, along);
}

Inertial OfCapsule(const CapsuleShape& capsule, double mass_kg) {
  const double r = capsule.radius_m, l = capsule.length_m;
  const double middle_part = l / (l + 4 * r / 3);
  const double middle = mass_kg * middle_part, balls = mass_kg - middle;
  // A half ball's centre of mass is 3/8 of the radius from its flat side.
  const double off = l / 2 + 3 * r / 8;
  const double across =
      middle * (3 * r * r + l * l) / 12 + balls * (2.0 / 5 - 9.0 / 64) * r * r + balls * off * off;
  return OfRound(mass_kg, across, middle * r * r / 2 + balls * 2 * r * r / 5);
}

double Determinant(const Point& a, const Point& b, const Point& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Tetrahedra from the origin to each triangle, counted negative where a triangle shows the origin
// its front.
Inertial OfMesh(const Mesh& mesh, double mass_kg) {
  double volume = 0;
  Point first{};
  SecondMoment second{};
  for (const auto& triangle : mesh.triangles) {
    const Point &a = mesh.vertices_m[triangle[0]], &b = mesh.vertices_m[triangle[1]],
                &c = mesh.vertices_m[triangle[2]];
    const double d = Determinant(a, b, c);
    volume += d / 6;
    for (std::size_t i = 0; i < 3; ++i) {
      const double sum_i = a[i] + b[i] + c[i];
      first[i] += d / 24 * sum_i;
      for (std::size_t j = 0; j < 3; ++j) {
        second[i][j] +=
            d / 120 * (sum_i * (a[j] + b[j] + c[j]) + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
      }
    }
  }
  const double density = mass_kg / volume;
  Inertial inertial;
  inertial.mass_kg = mass_kg;
  Point& middle = inertial.frame.position_m;
  for (std::size_t i = 0; i < 3; ++i) middle[i] = first[i] / volume;
  const auto about_middle = [&](std::size_t i, std::size_t j) {
    return density * second[i][j] - mass_kg * middle[i] * middle[j];
  };
  inertial.ixx_kgm2 = about_middle(1, 1) + about_middle(2, 2);
  inertial.iyy_kgm2 = about_middle(0, 0) + about_middle(2, 2);
  inertial.izz_kgm2 = about_middle(0, 0) + about_middle(1, 1);
  inertial.ixy_kgm2 = -about_middle(0, 1);
  inertial.ixz_kgm2 = -about_middle(0, 2);
  inertial.iyz_kgm2 = -about_middle(1, 2);
  return inertial;
}

struct OfGeometry {
  double m;

  Inertial operator()(const BoxShape& box) const {
    const auto& [x, y, z] = box.size_m;
    return FromMoments(m, m * (y * y + z * z) / 12, m * (x * x + z * z) / 12,
                       m * (x * x + y * y) / 12);
  }
  Inertial operator()(const SphereShape& sphere) const {
    const double moment = 2 * m * sphere.radius_m * sphere.radius_m / 5;
    return FromMoments(m, moment, moment, moment);
  }
  Inertial operator()(const CylinderShape& cylinder) const {
    const double r = cylinder.radius_m, l = cylinder.length_m;
    return OfRound(m, m * (3 * r * r + l * l) / 12, m * r * r / 2);
  }
  Inertial operator()(const CapsuleShape& capsule) const { return OfCapsule(capsule, m); }
  Inertial operator()(const PlaneShape&) const { return {}; }
  Inertial operator()(const MeshShape& shape) const { return OfMesh(*shape.mesh, m); }
};

}  // namespace

Inertial UniformInertial(const Geometry& geometry, double mass_kg) {
  return std::visit(OfGeometry{mass_kg}, geometry);
}

}  // namespace tcs
