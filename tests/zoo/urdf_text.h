// Writes URDF files of robots that stand for what people bring: a link is a body of even density,
// unless its robot is there to have something else.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace tcs::zoo {

using Vec3 = std::array<double, 3>;

// What a link is made of, in its frame.
struct Part {
  std::string geometry;  // of <collision> and <visual>; empty: it has none
  double mass_kg = 0;    // 0: no <inertial>
  Vec3 moments_kgm2{};   // about `center_m`
  Vec3 center_m{};
  std::string rpy = "0 0 0";
  bool collides = true;
};
Part Frame();  // neither a mass nor a shape
Part Box(double mass_kg, const Vec3& size_m, const Vec3& center_m = {});
Part Ball(double mass_kg, double radius_m, const Vec3& center_m = {});
// Along its z, or turned by `rpy`.
Part Cylinder(double mass_kg, double radius_m, double length_m, const Vec3& center_m = {},
              const std::string& rpy = "0 0 0");
Part Capsule(double mass_kg, double radius_m, double length_m, const Vec3& center_m = {});
// A wheel that turns about y.
Part Wheel(double mass_kg, double radius_m, double width_m);
// The wedge of tests/models, scaled; `file` is its name there.
Part Wedge(double mass_kg, const std::string& file, const Vec3& size_m);
Part WithMoments(Part part, const Vec3& moments_kgm2);
Part Invisible(Part part);  // with a mass, and without a shape

// What a joint's gear and motor can do. NaN: the file does not say.
struct Gear {
  double lower = 0, upper = 0;
  double effort = std::numeric_limits<double>::quiet_NaN(), velocity = effort;
  double damping = 0, friction = 0;
};
Gear Range(double lower, double upper, double effort, double velocity, double damping = 0,
           double friction = 0);
Gear Motor(double effort, double velocity, double damping = 0, double friction = 0);

// A link of a chain, and the joint before it, NAME_joint.
struct Step {
  std::string name;
  const char* type;
  Vec3 at_m;  // from the link before
  Vec3 axis;
  Gear gear;
  Part part;
};

inline constexpr Vec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

class Urdf {
 public:
  Urdf(const std::string& name, const std::string& root, const Part& part);

  Urdf& Link(const std::string& name, const Part& part);
  // The link as well.
  Urdf& Join(const std::string& parent, const Step& step, const std::string& more = "");
  Urdf& Fix(const std::string& parent, const std::string& name, const Vec3& at_m, const Part& part);
  // Each on the one before.
  Urdf& Chain(const std::string& parent, const std::string& prefix, const std::vector<Step>& steps);
  Urdf& Raw(const std::string& text);
  std::string Text() const { return text_ + "</robot>\n"; }

 private:
  std::string text_;
};

std::string Mimic(const std::string& joint, double multiplier = 1, double offset = 0);
// The same on the other side of y: positions and axes are, as in a mirror.
std::vector<Step> Mirrored(std::vector<Step> steps);

}  // namespace tcs::zoo
