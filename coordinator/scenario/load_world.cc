// `dynamics` and `bodies` of a scenario file; load_models.cc has `models`.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/load_air.h"
#include "coordinator/scenario/load_joints.h"
#include "coordinator/scenario/load_values.h"
#include "coordinator/scenario/sections.h"
#include "simbody_bridge/engines.h"

namespace tcs {
namespace {

constexpr std::array<std::pair<std::string_view, IntegratorKind>, 5> kIntegrators = {{
    {"runge_kutta3", IntegratorKind::kRungeKutta3},
    {"runge_kutta_merson", IntegratorKind::kRungeKuttaMerson},
    {"verlet", IntegratorKind::kVerlet},
    {"semi_explicit_euler2", IntegratorKind::kSemiExplicitEuler2},
    {"explicit_euler", IntegratorKind::kExplicitEuler},
}};

IntegratorKind LoadIntegratorKind(const YamlValue& value) {
  const std::string text = value.AsText();
  std::vector<std::string> known;
  for (const auto& [name, kind] : kIntegrators) {
    if (name == text) return kind;
    known.emplace_back(name);
  }
  value.Fail("is the unknown '" + text + "'; " + Suggest(text, known, "integrators"));
}

EngineKind LoadEngine(const YamlValue& value) {
  const std::string text = value.AsText();
  std::vector<std::string> known;
  for (const EngineTraits& engine : kEngines) {
    if (engine.name == text) return engine.kind;
    known.emplace_back(engine.name);
  }
  value.Fail("is the unknown '" + text + "'; " + Suggest(text, known, "engines"));
}

IntegratorSpec LoadIntegrator(const YamlMap& dynamics) {
  IntegratorSpec integrator;
  if (const YamlValue* engine = dynamics.Find("engine")) integrator.engine = LoadEngine(*engine);
  for (const char* key : {"integrator", "accuracy"}) {
    const YamlValue* value = dynamics.Find(key);
    const EngineTraits& engine = TraitsOf(integrator.engine);
    if (value == nullptr || engine.has_integrators) continue;
    value->Fail("is Simbody's, and dynamics.engine is " + std::string(engine.name) +
                ", which takes fixed steps; remove it, or set step");
  }
  if (const YamlValue* kind = dynamics.Find("integrator")) {
    integrator.kind = LoadIntegratorKind(*kind);
  }
  const YamlValue* accuracy = dynamics.Find("accuracy");
  const YamlValue* step = dynamics.Find("step");
  if (accuracy != nullptr && step != nullptr) {
    step->Fail(
        "cannot be given beside accuracy: one sets fixed steps, the other error control; "
        "remove one");
  }
  if (accuracy != nullptr) {
    integrator.accuracy = accuracy->AsPositiveNumber(" (a relative error)");
    if (integrator.accuracy >= 1) accuracy->Fail("is 1 or more; it must be below 1, like 1e-3");
  }
  if (step != nullptr) integrator.fixed_step = step->AsPositiveDuration();
  return integrator;
}

RegionSpec LoadRegion(const YamlValue& value) {
  const YamlMap map = value.AsMap();
  map.AllowOnly({"half_extent", "stiffness", "damping"});
  RegionSpec region;
  if (const YamlValue* v = map.Find("half_extent")) {
    region.half_extent_m = v->AsPositiveNumber(" (metres)");
  }
  if (const YamlValue* v = map.Find("stiffness")) {
    region.stiffness_npm = v->AsNonNegativeNumber(" (N/m)");
  }
  if (const YamlValue* v = map.Find("damping")) {
    region.damping_nspm = v->AsNonNegativeNumber(" (N·s/m)");
  }
  return region;
}

std::array<double, 3> LoadInertia(const YamlValue& value) {
  const std::array<double, 3> inertia = value.AsVector3();
  for (const double moment : inertia) {
    if (!(moment > 0)) {
      value.Fail("is impossible: every principal moment must be positive (kg·m²)");
    }
  }
  const double largest = *std::max_element(inertia.begin(), inertia.end());
  const double sum = inertia[0] + inertia[1] + inertia[2];
  // Flat bodies reach the limit; rounding is forgiven.
  if (largest > (sum - largest) + 1e-12 * sum) {
    value.Fail(
        "is impossible: no principal moment can exceed the sum of the other two; correct it");
  }
  return inertia;
}

BodySpec LoadBody(const YamlMap::Entry& entry) {
  CheckName(entry);
  const YamlMap map = entry.value.AsMap();
  map.AllowOnly({"mass", "inertia", "position", "orientation", "linear_velocity",
                 "angular_velocity", "drag"});
  BodySpec body;
  body.name = entry.key;
  body.mass_kg = map.Require("mass", "mass: 1.0").AsPositiveNumber(" (kilograms)");
  body.inertia_kgm2 = LoadInertia(map.Require("inertia", "inertia: [0.1, 0.1, 0.1]"));
  BodyState& initial = body.initial;
  if (const YamlValue* v = map.Find("position")) initial.position_m = v->AsVector3();
  if (const YamlValue* v = map.Find("orientation")) initial.orientation_xyzw = LoadOrientation(*v);
  if (const YamlValue* v = map.Find("linear_velocity")) {
    initial.linear_velocity_mps = v->AsVector3();
  }
  if (const YamlValue* v = map.Find("angular_velocity")) {
    initial.angular_velocity_radps = v->AsVector3();
  }
  if (const YamlValue* v = map.Find("drag")) body.drag = LoadDrag(*v);
  return body;
}

// Lists of names that are one island each: of bodies, or of models.
void LoadTogether(const YamlValue& value, Scenario* scenario) {
  WorldSpec& world = *scenario->world;
  std::set<std::string> placed;
  for (const YamlValue& list : value.AsList("[[predator, prey]]")) {
    const std::vector<YamlValue> names = list.AsList("[predator, prey]");
    if (names.size() < 2) {
      list.Fail("names one " + std::string(world.bodies.empty() ? "model" : "body") +
                ", which is alone already; name two or more");
    }
    const auto is_model = [&world](const YamlValue& name) {
      return world.bodies.empty() || std::ranges::find(world.models, name.AsText(),
                                                       &RobotModel::name) != world.models.end();
    };
    const bool of_models = is_model(names.front());
    std::vector<int>& island = (of_models ? world.models_together : world.together).emplace_back();
    for (const YamlValue& name : names) {
      if (is_model(name) != of_models) {
        name.Fail("names '" + name.AsText() + "' beside '" + names.front().AsText() +
                  "', but one of them is a body and the other one a model; free bodies touch "
                  "nothing, so give bodies and models separate lists");
      }
      island.push_back(of_models ? static_cast<int>(FindModel(name, *scenario))
                                 : FindBody(name, *scenario));
      if (!placed.insert(name.AsText()).second) {
        name.Fail("names the " + std::string(of_models ? "model" : "body") + " '" + name.AsText() +
                  "' a second time; write all names that belong together in one list");
      }
    }
  }
}

void LoadBodies(const YamlValue& value, WorldSpec* world) {
  const YamlMap map = value.AsMap();
  if (map.entries().empty()) value.Fail("is empty; describe at least one body");
  map.ForEach([&](const YamlMap::Entry& entry) { world->bodies.push_back(LoadBody(entry)); });
}

}  // namespace

std::array<double, 4> LoadOrientation(const YamlValue& value) {
  const std::vector<double> q = value.AsNumbers(4, "[0, 0, 0, 1] (x, y, z, w)");
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(norm - 1) <= 1e-3)) {
    value.Fail("is not a unit quaternion [x, y, z, w] (its norm is " + std::to_string(norm) +
               "); normalise it");
  }
  return {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
}

void LoadWorld(const YamlMap& top, const Variables& variables, Scenario* scenario) {
  const YamlValue* dynamics = top.Find("dynamics");
  const YamlValue* bodies = top.Find("bodies");
  const YamlValue* models = top.Find("models");
  if (dynamics == nullptr) {
    for (const YamlValue* what : {bodies, models}) {
      if (what != nullptr) what->Fail("need physics; add the key dynamics, like dynamics: {}");
    }
    return;
  }
  const YamlMap map = dynamics->AsMap();
  map.AllowOnly(
      {"engine", "integrator", "accuracy", "step", "gravity", "region", "wind", "together"});
  WorldSpec world;
  dynamics->Try([&] { world.integrator = LoadIntegrator(map); });
  if (const YamlValue* gravity = map.Find("gravity")) world.gravity_mps2 = gravity->AsVector3();
  if (const YamlValue* region = map.Find("region")) {
    world.has_region = true;
    region->Try([&] { world.region = LoadRegion(*region); });
  }

  if (const YamlValue* wind = map.Find("wind")) world.wind = LoadWind(*wind, scenario->seed);

  if (bodies == nullptr && models == nullptr) {
    dynamics->Fail("has no bodies to move; add the key bodies or models, or remove dynamics");
  }
  if (bodies != nullptr) bodies->Try([&] { LoadBodies(*bodies, &world); });
  const auto feels_air = [](const BodySpec& body) { return body.drag != DragSpec{}; };
  if (const YamlValue* wind = map.Find("wind");
      wind != nullptr && std::none_of(world.bodies.begin(), world.bodies.end(), feels_air)) {
    scenario->warnings.push_back(
        wind->place().Prefix() + wind->name() +
        " moves no body because no body has drag; give one a drag, like drag: {linear: 0.3}");
  }
  scenario->world = std::move(world);
  if (models != nullptr) models->Try([&] { LoadModels(*models, variables, scenario); });
  const bool has_none = scenario->world->bodies.empty() && scenario->world->models.empty();
  if (has_none && !dynamics->HasMistakes()) {
    models->Fail("has nothing that moves; give one of them mass, or remove dynamics");
  }
  if (const YamlValue* together = map.Find("together")) {
    together->Try([&] { LoadTogether(*together, scenario); });
  }
}

int FindBody(const YamlValue& value, const Scenario& scenario) {
  const std::string name = value.AsText();
  if (!scenario.world || scenario.world->bodies.empty()) {
    value.Fail("names the body '" + name + "', but the scenario has none; add dynamics and bodies");
  }
  std::vector<std::string> known;
  for (std::size_t i = 0; i < scenario.world->bodies.size(); ++i) {
    if (scenario.world->bodies[i].name == name) return static_cast<int>(i);
    known.push_back(scenario.world->bodies[i].name);
  }
  value.Fail("names the unknown body '" + name + "'; " + Suggest(name, known, "bodies"));
}

}  // namespace tcs
