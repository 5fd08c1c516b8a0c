#include "tests/zoo/urdf_text.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace tcs::zoo {
namespace {

std::string Words(const Vec3& v) { return fmt::format("{:g} {:g} {:g}", v[0], v[1], v[2]); }

std::string Attribute(std::string_view name, double value) {
  return std::isnan(value) ? std::string() : fmt::format(" {}=\"{:g}\"", name, value);
}

std::string ElementsOf(const Part& part) {
  const std::string origin =
      fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", Words(part.center_m), part.rpy);
  std::string text;
  if (part.mass_kg > 0) {
    text += fmt::format(
        "<inertial>{}<mass value=\"{:g}\"/><inertia ixx=\"{:g}\" ixy=\"0\" ixz=\"0\" iyy=\"{:g}\" "
        "iyz=\"0\" izz=\"{:g}\"/></inertial>",
        origin, part.mass_kg, part.moments_kgm2[0], part.moments_kgm2[1], part.moments_kgm2[2]);
  }
  if (part.geometry.empty()) return text;
  for (const char* kind : {"visual", "collision"}) {
    if (!part.collides && kind == std::string_view("collision")) continue;
    text += fmt::format("<{0}>{1}<geometry>{2}</geometry></{0}>", kind, origin, part.geometry);
  }
  return text;
}

Vec3 MomentsOfBox(double mass, const Vec3& size) {
  const double x = size[0] * size[0], y = size[1] * size[1], z = size[2] * size[2];
  return {mass * (y + z) / 12, mass * (x + z) / 12, mass * (x + y) / 12};
}

}  // namespace

Part Frame() { return {}; }

Part Box(double mass_kg, const Vec3& size_m, const Vec3& center_m) {
  return {fmt::format("<box size=\"{}\"/>", Words(size_m)), mass_kg, MomentsOfBox(mass_kg, size_m),
          center_m};
}

Part Ball(double mass_kg, double radius_m, const Vec3& center_m) {
  const double moment = 0.4 * mass_kg * radius_m * radius_m;
  return {fmt::format("<sphere radius=\"{:g}\"/>", radius_m),
          mass_kg,
          {moment, moment, moment},
          center_m};
}

Part Cylinder(double mass_kg, double radius_m, double length_m, const Vec3& center_m,
              const std::string& rpy) {
  const double r = radius_m * radius_m;
  const double across = mass_kg * (3 * r + length_m * length_m) / 12;
  return {fmt::format("<cylinder radius=\"{:g}\" length=\"{:g}\"/>", radius_m, length_m),
          mass_kg,
          {across, across, mass_kg * r / 2},
          center_m,
          rpy};
}

Part Capsule(double mass_kg, double radius_m, double length_m, const Vec3& center_m) {
  Part part = Cylinder(mass_kg, radius_m, length_m + radius_m, center_m);
  part.geometry = fmt::format("<capsule radius=\"{:g}\" length=\"{:g}\"/>", radius_m, length_m);
  return part;
}

Part Wheel(double mass_kg, double radius_m, double width_m) {
  return Cylinder(mass_kg, radius_m, width_m, {}, "1.5707963268 0 0");
}

Part Wedge(double mass_kg, const std::string& file, const Vec3& size_m) {
  return {fmt::format("<mesh filename=\"package://zoo_description/meshes/{}\" scale=\"{}\"/>", file,
                      Words(size_m)),
          mass_kg, MomentsOfBox(mass_kg, size_m)};
}

Part WithMoments(Part part, const Vec3& moments_kgm2) {
  part.moments_kgm2 = moments_kgm2;
  return part;
}

Part Invisible(Part part) {
  part.geometry.clear();
  return part;
}

Gear Range(double lower, double upper, double effort, double velocity, double damping,
           double friction) {
  return {lower, upper, effort, velocity, damping, friction};
}
Gear Motor(double effort, double velocity, double damping, double friction) {
  return {0, 0, effort, velocity, damping, friction};
}

Urdf::Urdf(const std::string& name, const std::string& root, const Part& part)
    : text_(fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", name)) {
  Link(root, part);
}

Urdf& Urdf::Link(const std::string& name, const Part& part) {
  text_ += fmt::format("<link name=\"{}\">{}</link>\n", name, ElementsOf(part));
  return *this;
}

Urdf& Urdf::Join(const std::string& parent, const Step& step, const std::string& more) {
  Link(step.name, step.part);
  const Gear& gear = step.gear;
  std::string limit = Attribute("effort", gear.effort) + Attribute("velocity", gear.velocity);
  if (gear.lower != gear.upper) {
    limit += Attribute("lower", gear.lower) + Attribute("upper", gear.upper);
  }
  text_ += fmt::format(
      "<joint name=\"{0}_joint\" type=\"{1}\"><parent link=\"{2}\"/><child link=\"{0}\"/><origin "
      "xyz=\"{3}\"/><axis xyz=\"{4}\"/>{5}{6}{7}</joint>\n",
      step.name, step.type, parent, Words(step.at_m), Words(step.axis),
      limit.empty() ? "" : "<limit" + limit + "/>",
      gear.damping == 0 && gear.friction == 0
          ? ""
          : fmt::format("<dynamics damping=\"{:g}\" friction=\"{:g}\"/>", gear.damping,
                        gear.friction),
      more);
  return *this;
}

Urdf& Urdf::Fix(const std::string& parent, const std::string& name, const Vec3& at_m,
                const Part& part) {
  return Join(parent, {name, "fixed", at_m, kX, {}, part});
}

Urdf& Urdf::Chain(const std::string& parent, const std::string& prefix,
                  const std::vector<Step>& steps) {
  std::string on = parent;
  for (Step step : steps) {
    step.name = prefix + step.name;
    Join(on, step);
    on = step.name;
  }
  return *this;
}

Urdf& Urdf::Raw(const std::string& text) {
  text_ += text + "\n";
  return *this;
}

std::string Mimic(const std::string& joint, double multiplier, double offset) {
  return fmt::format("<mimic joint=\"{}\" multiplier=\"{:g}\" offset=\"{:g}\"/>", joint, multiplier,
                     offset);
}

std::vector<Step> Mirrored(std::vector<Step> steps) {
  for (Step& step : steps) {
    step.at_m[1] = -step.at_m[1];
    step.part.center_m[1] = -step.part.center_m[1];
    for (const std::size_t across : {0, 2}) step.axis[across] = -step.axis[across];
  }
  return steps;
}

}  // namespace tcs::zoo
