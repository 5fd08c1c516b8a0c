// `models` of a scenario file: robots from URDF files, and single bodies of one shape.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/errors/visible.h"
#include "coordinator/models/load_urdf.h"
#include "coordinator/models/model_mistake.h"
#include "coordinator/models/srdf.h"
#include "coordinator/models/uniform_inertial.h"
#include "coordinator/models/xacro.h"
#include "coordinator/scenario/load_rotors.h"
#include "coordinator/scenario/load_values.h"
#include "coordinator/scenario/sections.h"
#include "coordinator/scenario/substitute.h"
#include "simbody_bridge/engines.h"
#include "simbody_bridge/model/model_check.h"
#include "simbody_bridge/touch/overlaps.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kShapes = {"box", "sphere", "cylinder", "capsule", "plane", "mesh"};

class Models {
 public:
  Models(const Variables& variables, Scenario* scenario)
      : variables_(variables), scenario_(*scenario), world_(*scenario->world) {}

  void Add(const YamlMap::Entry& entry) {
    CheckName(entry);
    for (const BodySpec& body : world_.bodies) {
      if (body.name == entry.key)
        entry.value.Fail("has the same name as a body; rename one of them");
    }
    const YamlMap map = entry.value.AsMap();
    const YamlValue& what = WhatOf(map);
    if (what.name() == map.place().name() + ".urdf") {
      AddRobot(entry, map, what);
    } else {
      AddBody(entry, map, what);
    }
  }

 private:
  // The one key that says what the model is.
  static const YamlValue& WhatOf(const YamlMap& map) {
    const YamlValue* what = nullptr;
    std::vector<std::string> known = {"urdf"};
    known.insert(known.end(), kShapes.begin(), kShapes.end());
    for (const std::string& key : known) {
      const YamlValue* value = map.Find(key);
      if (value == nullptr) continue;
      if (what != nullptr) {
        value->Fail("cannot be given beside " + what->name() + "; make two models of it");
      }
      what = value;
    }
    if (what != nullptr) return *what;
    for (const YamlMap::Entry& entry : map.entries()) {
      const auto nearest = Nearest(entry.key, known);
      if (!nearest) continue;
      entry.value.At(entry.key_place)
          .FailPlainly("unknown key '" + entry.key + "' in " + map.place().name() +
                       "; did you mean '" + *nearest + "'?");
    }
    map.place().Fail("does not say what it is; add one of urdf, " + List(kShapes));
  }

  static std::string List(const std::vector<std::string>& names) {
    std::string list = names[0];
    for (std::size_t i = 1; i < names.size(); ++i) {
      list += (i + 1 == names.size() ? " and " : ", ") + names[i];
    }
    return list;
  }

  std::string PathOf(const YamlValue& value) const {
    const std::string written = Substitute(value, variables_);
    if (written.empty()) value.Fail("is empty; give the path of a file");
    return (fs::path(variables_.scenario_directory) / written).lexically_normal();
  }

  static Pose PoseOf(const YamlMap& map) {
    Pose pose;
    if (const YamlValue* v = map.Find("position")) pose.position_m = v->AsVector3();
    if (const YamlValue* v = map.Find("orientation")) pose.orientation_xyzw = LoadOrientation(*v);
    return pose;
  }

  static void LoadVelocities(const YamlMap& map, RobotModel* model) {
    for (const char* key : {"linear_velocity", "angular_velocity"}) {
      const YamlValue* v = map.Find(key);
      if (v == nullptr) continue;
      if (model->has_fixed_base) v->Fail("is for a base that does not move; remove it");
      (key[0] == 'l' ? model->linear_velocity_mps : model->angular_velocity_radps) = v->AsVector3();
    }
  }

  std::vector<std::string> PackagesOf(const YamlMap& map) const {
    std::vector<std::string> folders;
    if (const YamlValue* packages = map.Find("packages")) {
      for (const YamlValue& folder : packages->AsList("[../install/share]")) {
        folders.push_back(PathOf(folder));
        if (!fs::is_directory(folders.back())) {
          folder.Fail("is '" + folder.AsText() + "', which is no folder; give one of packages");
        }
      }
    }
    return folders;
  }

  void AddRobot(const YamlMap::Entry& entry, const YamlMap& map, const YamlValue& urdf) {
    map.AllowOnly({"urdf", "at", "fixed_base", "joints", "packages", "friction", "self_collision",
                   "collisions", "xacro", "linear_velocity", "angular_velocity", "touches",
                   "rotors"});
    UrdfUse use;
    if (const YamlValue* v = map.Find("fixed_base")) use.has_fixed_base = v->AsBoolean();
    if (const YamlValue* v = map.Find("friction")) use.friction = v->AsNonNegativeNumber("");
    if (const YamlValue* v = map.Find("xacro")) use.xacro_arguments = LoadXacro(*v);
    std::vector<std::string> packages = PackagesOf(map);
    LoadedUrdf loaded = Read(urdf, use, PackagePath(packages));
    RobotModel& model = loaded.model;
    model.name = entry.key;
    if (!loaded.expanded.empty()) scenario_.urdf_expanded[model.name] = std::move(loaded.expanded);
    scenario_.urdf_packages[model.name] = std::move(packages);
    scenario_.urdf_files[model.name] = PathOf(urdf);
    if (const YamlValue* v = map.Find("at")) {
      const YamlMap at = v->AsMap();
      at.AllowOnly({"position", "orientation"});
      model.at = PoseOf(at);
    }
    if (const YamlValue* v = map.Find("self_collision")) model.has_self_collision = v->AsBoolean();
    if (const YamlValue* v = map.Find("touches")) model.touches_models = LoadTouchesModels(*v);
    LoadVelocities(map, &model);
    LoadStart(map, &model);
    if (const YamlValue* v = map.Find("collisions")) LoadCollisions(*v, &model);
    if (model.has_self_collision) IgnoreOverlaps(map, &model);
    if (const YamlValue* v = map.Find("rotors")) LoadRotors(*v, &model);
    world_.models.push_back(std::move(model));
  }

  static std::map<std::string, std::string> LoadXacro(const YamlValue& value) {
    if (!HasXacro()) {
      value.Fail(
          "has arguments for xacro, but there is no program `xacro` in PATH; install it, or "
          "expand the file where it is and remove this");
    }
    std::map<std::string, std::string> arguments;
    const YamlMap map = value.AsMap();
    for (const YamlMap::Entry& entry : map.entries()) {
      arguments[entry.key] = entry.value.AsText();
    }
    return arguments;
  }

  LoadedUrdf Read(const YamlValue& urdf, const UrdfUse& use, const PackagePath& packages) {
    const std::string path = PathOf(urdf);
    UrdfRemarks remarks;
    auto loaded = LoadUrdf(path, use, packages, &meshes_, &remarks);
    scenario_.warnings.insert(scenario_.warnings.end(), remarks.warnings.begin(),
                              remarks.warnings.end());
    scenario_.details.insert(scenario_.details.end(), remarks.details.begin(),
                             remarks.details.end());
    if (const auto* errors = std::get_if<std::vector<LoadError>>(&loaded)) {
      // Where all mistakes are asked for, all but the last are noted here.
      for (std::size_t i = 0; i + 1 < errors->size(); ++i) {
        urdf.Try([&] { Refuse(urdf, path, (*errors)[i]); });
      }
      Refuse(urdf, path, errors->back());
    }
    return std::get<LoadedUrdf>(std::move(loaded));
  }

  [[noreturn]] static void Refuse(const YamlValue& urdf, const std::string& path,
                                  const LoadError& error) {
    // An error of a file as a whole is to be mended in the scenario. Messages show names of files.
    if (error.message.starts_with(Visible(path) + ": ")) {
      urdf.FailPlainly(urdf.name() + ": " + error.message);
    }
    throw ScenarioMistake{error.message};
  }

  static bool LoadTouchesModels(const YamlValue& value) {
    const std::string text = value.AsText();
    if (text != "everything" && text != "static") {
      value.Fail("is the unknown '" + text + "'; " +
                 Suggest(text, {"everything", "static"}, "values"));
    }
    return text == "everything";
  }

  // Where the joints are at the start.
  void LoadStart(const YamlMap& map, RobotModel* model) {
    const YamlValue* joints = map.Find("joints");
    std::vector<std::optional<YamlValue>> places(model->joints.size());
    if (joints != nullptr) {
      const YamlMap starts = joints->AsMap();
      for (const YamlMap::Entry& entry : starts.entries()) {
        const std::size_t joint = FindJoint(entry, *model);
        LoadJointStart(entry, &model->joints[joint]);
        places[joint] = entry.value;
      }
    }
    PutWithinLimits(map, places, model);
    const auto fault = CheckModel(*model);
    if (!fault) return;
    const auto& place =
        fault->joint < 0 ? std::nullopt : places[static_cast<std::size_t>(fault->joint)];
    const YamlValue& where = place ? *place : joints != nullptr ? *joints : map.place();
    where.FailPlainly(where.name() + ": " + fault->what +
                      (place || fault->joint < 0 ? "" : "; say in joints where it starts"));
  }

  // Joints of which nobody says where they start, and that may not start at 0.
  void PutWithinLimits(const YamlMap& map, const std::vector<std::optional<YamlValue>>& said,
                       RobotModel* model) {
    std::string starts;
    for (std::size_t i = 0; i < model->joints.size(); ++i) {
      Joint& joint = model->joints[i];
      if (said[i] || joint.mimic || CoordinatesOf(joint.kind) != 1) continue;
      if (joint.limits.lower <= 0 && joint.limits.upper >= 0) continue;
      const double nearest = joint.limits.lower > 0 ? joint.limits.lower : joint.limits.upper;
      joint.initial_position = {nearest};
      starts += fmt::format("{}{}: {}", starts.empty() ? "" : ", ", joint.name, nearest);
    }
    if (starts.empty()) return;
    scenario_.warnings.push_back(map.place().place().Prefix() + map.place().name() +
                                 ": 0 is beyond the limits of some joints, which start as near to "
                                 "it as they may; to start them there or elsewhere, write joints: "
                                 "{" +
                                 starts + "}");
  }

  void LoadCollisions(const YamlValue& value, RobotModel* model) {
    if (!model->has_self_collision) {
      value.Fail(
          "says which links do not collide, but none do; add self_collision: true, or remove "
          "it");
    }
    const YamlMap map = value.AsMap();
    map.AllowOnly({"ignore", "srdf"});
    if (const YamlValue* pairs = map.Find("ignore")) {
      for (const YamlValue& pair : pairs->AsList("[[LINK, LINK]]")) {
        const std::vector<YamlValue> links = pair.AsList("[LINK, LINK]");
        if (links.size() != 2) pair.Fail("does not name two links; write [LINK, LINK]");
        Ignore(FindLink(links[0], *model), FindLink(links[1], *model), model);
      }
    }
    if (const YamlValue* srdf = map.Find("srdf")) ReadSrdf(*srdf, model);
  }

  static void Ignore(int a, int b, RobotModel* model) {
    if (a == b || Ignores(*model, a, b)) return;
    model->ignored_pairs.push_back(std::minmax(a, b));
  }

  static int FindLink(const YamlValue& value, const RobotModel& model) {
    const std::string name = value.AsText();
    std::vector<std::string> known;
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      if (model.links[i].name == name) return static_cast<int>(i);
      known.push_back(model.links[i].name);
    }
    value.Fail("names the unknown link '" + name + "' of " + model.name + "; " +
               Suggest(name, known, "links"));
  }

  // A file of MoveIt may name links of a gripper that this robot does not have.
  void ReadSrdf(const YamlValue& srdf, RobotModel* model) {
    std::map<std::string_view, int> links;
    for (std::size_t i = 0; i < model->links.size(); ++i) {
      links.emplace(model->links[i].name, static_cast<int>(i));
    }
    try {
      for (const auto& [a, b] : DisabledCollisions(PathOf(srdf))) {
        const auto first = links.find(a), second = links.find(b);
        if (first == links.end() || second == links.end()) continue;
        Ignore(first->second, second->second, model);
      }
    } catch (const ModelMistake& mistake) {
      srdf.FailPlainly(srdf.name() + ": " + mistake.message);
    }
  }

  // Links that overlap at the start would be thrown apart.
  void IgnoreOverlaps(const YamlMap& map, RobotModel* model) {
    const std::vector<std::pair<int, int>> pairs = OverlappingLinks(*model);
    if (pairs.empty()) return;
    constexpr std::size_t kMostNamed = 8;
    std::string named;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto name = [&](int link) { return model->links[static_cast<std::size_t>(link)].name; };
      const std::string pair = "[" + name(pairs[i].first) + ", " + name(pairs[i].second) + "]";
      if (i < kMostNamed) named += (i == 0 ? "" : ", ") + pair;
      scenario_.details.push_back(map.place().place().Prefix() + map.place().name() +
                                  ": the links " + pair + " overlap at the start");
      Ignore(pairs[i].first, pairs[i].second, model);
    }
    scenario_.warnings.push_back(
        map.place().place().Prefix() + map.place().name() +
        ": links overlap at the start, and such do not collide; to say so, write collisions: "
        "{ignore: [" +
        named +
        (pairs.size() > kMostNamed
             ? fmt::format(", … ({} in all; `tcsim check -v` lists them)", pairs.size())
             : "") +
        "]}");
  }

  static std::size_t FindJoint(const YamlMap::Entry& entry, const RobotModel& model) {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      const Joint& joint = model.joints[i];
      if (joint.name == entry.key && joint.kind == JointKind::kFixed) {
        entry.value.Fail("is for a fixed joint, which has no position; remove it");
      }
      if (joint.name == entry.key) return i;
      if (joint.kind != JointKind::kFixed) known.push_back(joint.name);
    }
    if (known.empty()) entry.value.Fail("names a joint, but the robot has none that moves");
    entry.value.At(entry.key_place)
        .FailPlainly("unknown joint '" + entry.key + "' of " + model.name + "; " +
                     Suggest(entry.key, known, "joints"));
  }

  // A joint with one coordinate may also have [position, velocity].
  static void LoadJointStart(const YamlMap::Entry& entry, Joint* joint) {
    if (CoordinatesOf(joint->kind) == 1 && entry.value.IsList()) {
      const std::vector<double> start = entry.value.AsNumbers(2, "[0.5, 0] (position, velocity)");
      joint->initial_position = {start[0]};
      joint->initial_velocity = {start[1]};
    } else {
      joint->initial_position = LoadPosition(entry, joint->kind);
    }
  }

  static std::vector<double> LoadPosition(const YamlMap::Entry& entry, JointKind kind) {
    const std::size_t count = CoordinatesOf(kind);
    if (count == 1) return {entry.value.AsNumber()};
    if (count == 3) return entry.value.AsNumbers(3, "[0, 0, 0] (x, y, angle)");
    return entry.value.AsNumbers(7, "[0, 0, 0, 0, 0, 0, 1] (x, y, z, and a quaternion x, y, z, w)");
  }

  void AddBody(const YamlMap::Entry& entry, const YamlMap& map, const YamlValue& what) {
    const std::string kind = what.name().substr(map.place().name().size() + 1);
    std::vector<std::string> keys = {
        kind,       "mass",        "static",          "friction",
        "position", "orientation", "linear_velocity", "angular_velocity"};
    if (kind == "mesh") keys.push_back("scale");
    map.AllowOnly(keys);
    Shape shape;
    shape.name = entry.key;
    shape.geometry = LoadGeometry(kind, what, map);
    if (const YamlValue* v = map.Find("friction")) shape.friction = v->AsNonNegativeNumber("");
    const Pose pose = kind == "plane" ? PoseOfPlane(what, map) : PoseOf(map);
    if (IsStatic(kind, map)) {
      shape.pose = pose;
      world_.fixtures.push_back(std::move(shape));
      return;
    }
    const double mass_kg = map.Find("mass")->AsPositiveNumber(" (kilograms)");
    RobotModel model;
    model.name = entry.key;
    model.at = pose;
    LoadVelocities(map, &model);
    Link link;
    link.name = entry.key;
    link.inertial = UniformInertial(shape.geometry, mass_kg);
    link.shapes.push_back(std::move(shape));
    model.links.push_back(std::move(link));
    if (const auto fault = CheckModel(model)) {
      entry.value.FailPlainly(entry.value.name() + ": " + fault->what);
    }
    world_.models.push_back(std::move(model));
  }

  static bool IsStatic(const std::string& kind, const YamlMap& map) {
    const YamlValue* is_static = map.Find("static");
    const YamlValue* mass = map.Find("mass");
    const bool is_plane = kind == "plane";
    if (is_static != nullptr && !is_static->AsBoolean() && is_plane) {
      is_static->Fail("is false, but a plane has no end and cannot move; remove it");
    }
    if (is_plane && mass != nullptr) mass->Fail("is for a plane, which cannot move; remove it");
    const bool stands = is_plane || (is_static != nullptr && is_static->AsBoolean());
    if (stands && mass != nullptr) {
      mass->Fail("is for something that does not move; remove it, or remove static");
    }
    if (!stands && mass == nullptr) {
      map.place().Fail("has neither mass nor static; add mass: 1.0, or static: true");
    }
    for (const char* key : {"linear_velocity", "angular_velocity"}) {
      const YamlValue* v = map.Find(key);
      if (stands && v != nullptr) v->Fail("is for something that does not move; remove it");
    }
    return stands;
  }

  Geometry LoadGeometry(const std::string& kind, const YamlValue& what, const YamlMap& map) {
    if (kind == "box") return BoxShape{LoadSize(what)};
    if (kind == "sphere") return SphereShape{what.AsPositiveNumber(" (its radius in metres)")};
    if (kind == "cylinder") {
      const auto [radius_m, length_m] = LoadRound(what);
      return CylinderShape{radius_m, length_m};
    }
    if (kind == "capsule") {
      const auto [radius_m, length_m] = LoadRound(what);
      return CapsuleShape{radius_m, length_m};
    }
    if (kind == "plane") return PlaneShape{};
    std::array<double, 3> scale = {1, 1, 1};
    if (const YamlValue* v = map.Find("scale")) scale = LoadScale(*v);
    try {
      auto mesh = meshes_.Take(PathOf(what), scale);
      if (mesh == nullptr)
        what.Fail("is a point or a line, which nothing touches; take another one");
      return MeshShape{std::move(mesh)};
    } catch (const ModelMistake& mistake) {
      what.FailPlainly(what.name() + ": " + mistake.message);
    }
  }

  static std::array<double, 3> LoadSize(const YamlValue& value) {
    const std::array<double, 3> size_m = value.AsVector3();
    for (const double edge_m : size_m) {
      if (!(edge_m > 0)) value.Fail("has an edge that is not positive (metres)");
    }
    return size_m;
  }

  static std::pair<double, double> LoadRound(const YamlValue& value) {
    const YamlMap map = value.AsMap();
    map.AllowOnly({"radius", "length"});
    return {map.Require("radius", "radius: 0.1").AsPositiveNumber(" (metres)"),
            map.Require("length", "length: 0.2").AsPositiveNumber(" (metres)")};
  }

  static std::array<double, 3> LoadScale(const YamlValue& value) {
    std::array<double, 3> scale{};
    if (value.IsList()) {
      scale = value.AsVector3();
    } else {
      scale.fill(value.AsNumber());
    }
    for (const double each : scale) {
      if (each == 0) value.Fail("is 0 along an axis, which leaves nothing of the mesh");
    }
    return scale;
  }

  // The way up from the plane is its normal; the plane goes through `position`.
  static Pose PoseOfPlane(const YamlValue& plane, const YamlMap& map) {
    if (const YamlValue* v = map.Find("orientation")) {
      v->Fail("is for a plane, whose normal says it already; remove it");
    }
    Pose pose = PoseOf(map);
    const auto [x, y, z] = plane.AsVector3();
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 1e-6) || !std::isfinite(length)) {
      plane.Fail("has no direction; give the normal, the way up from it, like [0, 0, 1]");
    }
    // The shortest turn from z; straight down, about x.
    const double w = 1 + z / length;
    pose.orientation_xyzw =
        w < 1e-12 ? std::array<double, 4>{1, 0, 0, 0} : Normalised({-y / length, x / length, 0, w});
    return pose;
  }

  const Variables& variables_;
  Scenario& scenario_;
  WorldSpec& world_;
  MeshLibrary meshes_;
};

// A robot without collision shapes meets no floor.
void WarnOfWhatFallsThrough(const YamlMap& map, Scenario* scenario) {
  const WorldSpec& world = *scenario->world;
  if (world.fixtures.empty()) return;
  for (const RobotModel& model : world.models) {
    const auto has_shapes = [](const Link& link) { return !link.shapes.empty(); };
    if (model.has_fixed_base || std::ranges::any_of(model.links, has_shapes)) continue;
    const YamlValue* place = map.Find(model.name);
    scenario->warnings.push_back(place->place().Prefix() + place->name() +
                                 ": no link has a collision shape, so it falls through whatever "
                                 "is below it; add <collision> to its links");
  }
}

}  // namespace

void LoadModels(const YamlValue& value, const Variables& variables, Scenario* scenario) {
  const EngineTraits& engine = TraitsOf(scenario->world->integrator.engine);
  if (!engine.has_models) {
    std::string others;
    for (const EngineTraits& other : kEngines) {
      if (other.has_models) others += (others.empty() ? "" : " or ") + std::string(other.name);
    }
    value.Fail("need an engine that knows joints and contact, and dynamics.engine is " +
               std::string(engine.name) + "; set it to " + others);
  }
  const YamlMap map = value.AsMap();
  if (map.entries().empty()) value.Fail("is empty; describe at least one model");
  Models models(variables, scenario);
  map.ForEach([&](const YamlMap::Entry& entry) { models.Add(entry); });
  WarnOfWhatFallsThrough(map, scenario);
  // Static models need no steps.
  if (engine.has_integrators && !scenario->world->models.empty() &&
      scenario->world->integrator.kind != IntegratorKind::kRungeKutta3) {
    value.Fail("move by the integrator runge_kutta3 only on " + std::string(engine.name) +
               "; leave dynamics.integrator out, or set dynamics.engine to mujoco");
  }
}

}  // namespace tcs
