#include "coordinator/scenario/load_air.h"

#include "coordinator/scenario/sections.h"

namespace tcs {

WindSpec LoadWind(const YamlValue& value, std::uint64_t seed) {
  WindSpec wind;
  wind.seed = SeedOf(seed, "dynamics/wind");
  if (value.IsList()) {
    wind.mean_mps = value.AsVector3();
    return wind;
  }
  const YamlMap map = value.AsMap();
  map.AllowOnly({"mean", "gusts", "gust_time"});
  if (const YamlValue* v = map.Find("mean")) wind.mean_mps = v->AsVector3();
  if (const YamlValue* v = map.Find("gusts")) {
    wind.gusts_mps = v->AsNonNegativeNumber(" (a standard deviation, m/s)");
  }
  if (const YamlValue* v = map.Find("gust_time")) {
    wind.gust_time = v->AsPositiveDuration();
    if (wind.gusts_mps == 0) v->Fail("needs gusts, but there are none; add gusts, like gusts: 1.5");
  }
  return wind;
}

DragSpec LoadDrag(const YamlValue& value) {
  const YamlMap map = value.AsMap();
  map.AllowOnly({"linear", "quadratic", "angular_linear", "angular_quadratic"});
  DragSpec drag;
  const auto load = [&map](const char* key, const char* unit, double* factor) {
    if (const YamlValue* v = map.Find(key)) *factor = v->AsNonNegativeNumber(unit);
  };
  load("linear", " (N·s/m)", &drag.linear_nspm);
  load("quadratic", " (N·s²/m²)", &drag.quadratic_ns2pm2);
  load("angular_linear", " (N·m·s/rad)", &drag.angular_linear_nmsprad);
  load("angular_quadratic", " (N·m·s²/rad²)", &drag.angular_quadratic_nms2prad2);
  return drag;
}

}  // namespace tcs
