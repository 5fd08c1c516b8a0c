#include "simbody_bridge/rays/ray_target.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simbody_bridge/model/convex_hull.h"
#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

// The stretch of a ray that is inside something convex; nothing where it ends before it begins.
struct Stretch {
  double from = -kMeetsNothing, to = kMeetsNothing;

  void Clip(const Stretch& other) {
    from = std::max(from, other.from);
    to = std::min(to, other.to);
  }
  // A ray that begins inside, or on the surface and goes in, has entered already.
  double Entry() const { return from <= to && from >= 0 ? from : kMeetsNothing; }
  bool Begins() const { return from <= 0 && to > 0; }
};

constexpr Stretch kNowhere = {kMeetsNothing, -kMeetsNothing};

// The stretch up to `most` of a ray whose product with a normal is `height` at the origin and grows
// by `slope`.
Stretch Below(double height, double slope, double most) {
  if (slope == 0) return height <= most ? Stretch{} : kNowhere;
  const double at = (most - height) / slope;
  return slope > 0 ? Stretch{-kMeetsNothing, at} : Stretch{at, kMeetsNothing};
}

Stretch Between(double height, double slope, double half) {
  Stretch stretch = Below(height, slope, half);
  stretch.Clip(Below(-height, -slope, half));
  return stretch;
}

// a t^2 + 2 b t + c <= 0
Stretch Roots(double a, double b, double c) {
  if (a == 0) return c <= 0 ? Stretch{} : kNowhere;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return kNowhere;
  // The root of the larger sum first: nothing cancels out.
  const double sum = -b - std::copysign(std::sqrt(discriminant), b);
  if (sum == 0) return {0, 0};
  const double one = sum / a, other = c / sum;
  return {std::min(one, other), std::max(one, other)};
}

Stretch InBall(const Ray& ray, const Vector& center, double radius) {
  Vector from;
  for (std::size_t i = 0; i < 3; ++i) from[i] = ray.origin_m[i] - center[i];
  return Roots(1, Dot(from, ray.direction), Dot(from, from) - radius * radius);
}

Stretch InCylinder(const Ray& ray, double radius, double length) {
  const auto& [x, y, z] = ray.origin_m;
  const auto& [dx, dy, dz] = ray.direction;
  Stretch stretch = Roots(dx * dx + dy * dy, x * dx + y * dy, x * x + y * y - radius * radius);
  stretch.Clip(Between(z, dz, length / 2));
  return stretch;
}

// A ray enters a shape of several parts where it enters the first of them, unless it began in one.
double FirstOf(std::initializer_list<Stretch> parts) {
  double first = kMeetsNothing;
  for (const Stretch& part : parts) {
    if (part.from <= part.to && part.Begins()) return kMeetsNothing;
    first = std::min(first, part.Entry());
  }
  return first;
}

}  // namespace

struct RayTarget::Meeting {
  const Ray& ray;

  double operator()(const BoxShape& box) const {
    Stretch stretch;
    for (std::size_t i = 0; i < 3; ++i) {
      stretch.Clip(Between(ray.origin_m[i], ray.direction[i], box.size_m[i] / 2));
    }
    return stretch.Entry();
  }
  double operator()(const SphereShape& sphere) const {
    return InBall(ray, {}, sphere.radius_m).Entry();
  }
  double operator()(const CylinderShape& cylinder) const {
    return InCylinder(ray, cylinder.radius_m, cylinder.length_m).Entry();
  }
  double operator()(const CapsuleShape& capsule) const {
    const double end = capsule.length_m / 2;
    return FirstOf({InCylinder(ray, capsule.radius_m, capsule.length_m),
                    InBall(ray, {0, 0, end}, capsule.radius_m),
                    InBall(ray, {0, 0, -end}, capsule.radius_m)});
  }
  double operator()(const PlaneShape&) const {
    return Below(ray.origin_m[2], ray.direction[2], 0).Entry();
  }
  double operator()(const Hull& hull) const {
    Stretch stretch;
    for (const HalfSpace& side : hull.sides) {
      stretch.Clip(
          Below(Dot(side.normal, ray.origin_m), Dot(side.normal, ray.direction), side.offset_m));
      if (stretch.from > stretch.to) return kMeetsNothing;
    }
    return stretch.Entry();
  }
};

RayTarget::RayTarget(const Geometry& geometry) {
  if (const auto* box = std::get_if<BoxShape>(&geometry)) {
    form_ = *box;
    radius_m_ = std::sqrt(Dot(box->size_m, box->size_m)) / 2;
  } else if (const auto* sphere = std::get_if<SphereShape>(&geometry)) {
    form_ = *sphere;
    radius_m_ = sphere->radius_m;
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&geometry)) {
    form_ = *cylinder;
    radius_m_ = std::hypot(cylinder->radius_m, cylinder->length_m / 2);
  } else if (const auto* capsule = std::get_if<CapsuleShape>(&geometry)) {
    form_ = *capsule;
    radius_m_ = capsule->radius_m + capsule->length_m / 2;
  } else if (const auto* mesh = std::get_if<MeshShape>(&geometry)) {
    form_ = TakeHull(*mesh->mesh);
  } else {
    form_ = PlaneShape{};
  }
}

// A mesh that spans no volume has been refused where the model was read.
RayTarget::Hull RayTarget::TakeHull(const Mesh& mesh) {
  Hull hull;
  const auto found = HullOf(mesh.vertices_m);
  radius_m_ = 0;
  if (!found) return {{{{1, 0, 0}, -kMeetsNothing}}};
  for (const Vector& vertex : found->vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      center_m_[i] += vertex[i] / static_cast<double>(found->vertices.size());
    }
  }
  for (const Vector& vertex : found->vertices) {
    radius_m_ = std::max(radius_m_, std::hypot(vertex[0] - center_m_[0], vertex[1] - center_m_[1],
                                               vertex[2] - center_m_[2]));
  }
  for (const auto& [a, b, c] : found->triangles) {
    const Vector& p = found->vertices[static_cast<std::size_t>(a)];
    const Vector& q = found->vertices[static_cast<std::size_t>(b)];
    const Vector& r = found->vertices[static_cast<std::size_t>(c)];
    const Vector u = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const Vector v = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    Vector normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                     u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(Dot(normal, normal));
    if (length == 0) continue;
    for (double& axis : normal) axis /= length;
    hull.sides.push_back({normal, Dot(normal, p)});
  }
  return hull;
}

double RayTarget::Meet(const Ray& ray) const { return std::visit(Meeting{ray}, form_); }

}  // namespace tcs
