#include "coordinator/scenario/load_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/load_instruments.h"
#include "coordinator/scenario/load_values.h"

namespace tcs {

int LoadLink(const YamlValue& value, const Scenario& scenario, std::string* name) {
  const std::string text = value.AsText();
  const std::size_t slash = text.find('/');
  const std::string model_name = text.substr(0, slash);
  int first = 0;
  std::vector<std::string> models;
  for (const RobotModel& model : scenario.world->models) {
    models.push_back(model.name);
    if (model.name != model_name) {
      first += static_cast<int>(model.links.size());
      continue;
    }
    std::vector<std::string> links;
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const Link& link = model.links[i];
      links.push_back(link.name);
      const bool is_root = slash == std::string::npos && static_cast<int>(i) == model.root;
      if (!is_root && (slash == std::string::npos || link.name != text.substr(slash + 1))) continue;
      *name = link.name;
      return first + static_cast<int>(i);
    }
    const std::string link = text.substr(slash + 1);
    value.Fail("names the unknown link '" + link + "' of " + model_name + "; " +
               Suggest(link, links, "links"));
  }
  if (models.empty()) {
    value.Fail("names the model '" + model_name +
               "', but the scenario has none that moves; add models");
  }
  value.Fail("names the unknown model '" + model_name + "'; " +
             Suggest(model_name, models, "models"));
}

namespace {

constexpr std::int64_t kMostRays = 1'000'000, kMostLayers = 1024, kMostPixels = 1024;
constexpr double kTurn = 2 * std::numbers::pi;

// From where to where a sensor turns.
void LoadAngles(const YamlValue& value, double* first_rad, double* last_rad) {
  const std::vector<double> angles = value.AsNumbers(2, "[-1.57, 1.57] (radians)");
  if (std::abs(angles[1] - angles[0]) > kTurn + 1e-9) {
    value.Fail("is more than a whole turn (radians)");
  }
  *first_rad = angles[0];
  *last_rad = angles[1];
}

// A sweep that is not said goes at the speed of a whole turn in each period.
VirtualDuration LoadSweep(const YamlMap& map, double angle_rad, VirtualDuration period) {
  const YamlValue* value = map.Find("sweep");
  if (value == nullptr) {
    const double share = std::min(1.0, std::abs(angle_rad) / kTurn);
    return VirtualDuration::Nanoseconds(std::llround(share * static_cast<double>(period.ns())));
  }
  const VirtualDuration sweep = value->AsDuration();
  if (sweep > period) value->Fail("is longer than the time between two scans; make the rate lower");
  return sweep;
}

std::size_t LoadCount(const YamlMap& map, const char* key, std::int64_t most,
                      std::size_t otherwise) {
  const YamlValue* value = map.Find(key);
  return value == nullptr ? otherwise : static_cast<std::size_t>(value->AsInteger(1, most));
}

// The field of view of a sensor that looks ahead: less than half a turn.
double LoadFieldOfView(const YamlMap& map, double otherwise_rad) {
  const YamlValue* value = map.Find("field_of_view");
  if (value == nullptr) return otherwise_rad;
  const double angle_rad = value->AsPositiveNumber(" (radians)");
  if (angle_rad >= std::numbers::pi) value->Fail("is half a turn or more (radians)");
  return angle_rad;
}

LidarSpec LoadSweeping(const YamlMap& map, const Scenario& scenario, VirtualDuration period) {
  LidarSpec lidar{LoadMount(map, scenario)};
  lidar.rays = LoadCount(map, "rays", kMostRays, lidar.rays);
  // In a whole turn no two rays look the same way.
  lidar.last_rad = lidar.first_rad + kTurn * (1 - 1 / static_cast<double>(lidar.rays));
  if (const YamlValue* v = map.Find("angles")) {
    LoadAngles(*v, &lidar.first_rad, &lidar.last_rad);
  }
  lidar.reach = LoadReach(map, lidar.reach);
  lidar.sweep = LoadSweep(map, lidar.last_rad - lidar.first_rad, period);
  return lidar;
}

}  // namespace

Mount LoadMount(const YamlMap& map, const Scenario& scenario) {
  Mount mount;
  mount.link = LoadLink(map.Require("on", "on: rover/base_link"), scenario, &mount.frame);
  if (const YamlValue* v = map.Find("at")) {
    const YamlMap at = v->AsMap();
    at.AllowOnly({"position", "orientation"});
    if (const YamlValue* p = at.Find("position")) mount.at.position_m = p->AsVector3();
    if (const YamlValue* q = at.Find("orientation")) {
      mount.at.orientation_xyzw = LoadOrientation(*q);
    }
  }
  if (const YamlValue* v = map.Find("frame")) mount.frame = v->AsText();
  return mount;
}

ReachSpec LoadReach(const YamlMap& map, ReachSpec reach) {
  const YamlValue* value = map.Find("range");
  if (value == nullptr) return reach;
  const std::vector<double> numbers = value->AsNumbers(2, "[0.1, 30] (metres)");
  reach = {numbers[0], numbers[1]};
  if (reach.least_m < 0 || !(reach.most_m > reach.least_m)) {
    value->Fail("is not a range; give the least and the most distance in metres, like [0.1, 30]");
  }
  return reach;
}

InstrumentSpec LoadLidar(const YamlMap& map, const Scenario& scenario, VirtualDuration period) {
  return LoadSweeping(map, scenario, period);
}

InstrumentSpec LoadLidar3d(const YamlMap& map, const Scenario& scenario, VirtualDuration period) {
  Lidar3dSpec spec{LoadSweeping(map, scenario, period)};
  spec.layers = LoadCount(map, "layers", kMostLayers, spec.layers);
  if (spec.layers * spec.lidar.rays > static_cast<std::size_t>(kMostRays)) {
    map.Find("layers")->Fail("makes more than a million rays with those of rays; make one less");
  }
  if (const YamlValue* v = map.Find("elevations")) {
    const std::vector<double> angles = v->AsNumbers(2, "[-0.26, 0.26] (radians)");
    if (std::abs(angles[0]) > kTurn / 4 || std::abs(angles[1]) > kTurn / 4) {
      v->Fail("is beyond straight up or down (radians)");
    }
    spec.lowest_rad = angles[0];
    spec.highest_rad = angles[1];
  }
  return spec;
}

InstrumentSpec LoadRange(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  RangeSpec range{LoadMount(map, scenario)};
  range.field_of_view_rad = LoadFieldOfView(map, range.field_of_view_rad);
  range.reach = LoadReach(map, range.reach);
  if (const YamlValue* v = map.Find("radiation")) {
    const std::string text = v->AsText();
    if (text != "ultrasound" && text != "infrared") {
      v->Fail("is the unknown '" + text + "'; " +
              Suggest(text, {"ultrasound", "infrared"}, "radiations"));
    }
    range.is_infrared = text == "infrared";
  }
  return range;
}

InstrumentSpec LoadDepthCamera(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  DepthCameraSpec camera{LoadMount(map, scenario)};
  camera.width = LoadCount(map, "width", kMostPixels, camera.width);
  camera.height = LoadCount(map, "height", kMostPixels, camera.height);
  camera.field_of_view_rad = LoadFieldOfView(map, camera.field_of_view_rad);
  camera.reach = LoadReach(map, camera.reach);
  return camera;
}

}  // namespace tcs
