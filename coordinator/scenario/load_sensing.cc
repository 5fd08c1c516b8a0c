#include "coordinator/scenario/load_sensing.h"

#include <algorithm>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/sections.h"

namespace tcs {

const char* NameOf(SensorField field) {
  constexpr std::array<const char*, kSensorFields> kNames = {
      "position",         "orientation",  "linear_velocity",
      "angular_velocity", "angular_rate", "proper_acceleration"};
  return kNames[static_cast<std::size_t>(field)];
}

namespace {

std::vector<std::string> FieldNames() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kSensorFields; ++i) {
    names.push_back(NameOf(static_cast<SensorField>(i)));
  }
  return names;
}

// A number for all three axes, or one for each.
std::array<double, 3> LoadAxes(const YamlValue& value, std::string_view unit) {
  if (value.IsList()) return value.AsVector3();
  const double number = value.AsNonNegativeNumber(unit);
  return {number, number, number};
}

std::array<double, 3> LoadLimit(const YamlValue& value, std::string_view unit) {
  const std::array<double, 3> limit = LoadAxes(value, unit);
  if (std::any_of(limit.begin(), limit.end(), [](double axis) { return axis < 0; })) {
    value.Fail("is negative, but a limit holds in both directions; write a positive number");
  }
  return limit;
}

bool LoadIsInOwnFrame(const YamlValue& value, const std::string& own) {
  const std::string axes = value.AsText();
  if (axes != "world" && axes != own) {
    value.Fail("is the unknown '" + axes + "'; " + Suggest(axes, {"world", own}, "axes"));
  }
  return axes == own;
}

}  // namespace

// FNV-1a; the scenario's seed has come in before.
std::uint64_t SeedOf(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325 ^ seed * 0x9e3779b97f4a7c15;
  for (const char byte : name) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  }
  return hash;
}

std::vector<SensorField> LoadSensorFields(const YamlValue& value) {
  const std::vector<std::string> names = FieldNames();
  std::vector<SensorField> fields;
  for (const YamlValue& item : value.AsList("[position, angular_rate]")) {
    const std::string name = item.AsText();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      item.Fail("is the unknown '" + name + "'; " + Suggest(name, names, "fields"));
    }
    const auto field = static_cast<SensorField>(found - names.begin());
    if (std::find(fields.begin(), fields.end(), field) != fields.end()) {
      item.Fail("names " + name + " a second time; remove it");
    }
    fields.push_back(field);
  }
  return fields;
}

void LoadFieldErrors(const YamlMap& map, std::span<const NamedError> fields) {
  std::vector<std::string> names;
  for (const NamedError& field : fields) names.push_back(field.name);
  // Null for a key that is unknown, where that was only noted.
  const auto of = [&](const YamlMap::Entry& entry) -> const NamedError* {
    const auto found = std::find(names.begin(), names.end(), entry.key);
    return found == names.end() ? nullptr
                                : &fields[static_cast<std::size_t>(found - names.begin())];
  };
  if (const YamlValue* value = map.Find("noise")) {
    const YamlMap noise = value->AsMap();
    noise.AllowOnly(names);
    for (const YamlMap::Entry& entry : noise.entries()) {
      if (const NamedError* field = of(entry)) {
        field->error->noise = entry.value.AsNonNegativeNumber(" (a standard deviation)");
      }
    }
  }
  if (const YamlValue* value = map.Find("bias")) {
    const YamlMap bias = value->AsMap();
    bias.AllowOnly(names);
    for (const YamlMap::Entry& entry : bias.entries()) {
      const NamedError* field = of(entry);
      if (field == nullptr) continue;
      if (entry.value.IsList() && field->is_number) {
        field->error->bias[0] = entry.value.AsNumbers(1, "[0.02]")[0];
      } else if (entry.value.IsList()) {
        field->error->bias = entry.value.AsVector3();
      } else {
        field->error->bias_deviation = entry.value.AsNonNegativeNumber(" (a standard deviation)");
      }
    }
  }
}

SensorErrors LoadSensorErrors(const YamlMap& map, const std::string& name, std::uint64_t seed) {
  SensorErrors errors;
  errors.seed = SeedOf(seed, name);
  if (const YamlValue* value = map.Find("dropout")) {
    errors.dropout = value->AsNonNegativeNumber(" (the share of samples that are lost)");
    if (errors.dropout > 1)
      value->Fail("is above 1; it is a share, from 0 to 1 (all samples lost)");
  }
  if (const YamlValue* value = map.Find("jitter")) errors.jitter = value->AsDuration();
  return errors;
}

void LoadBodyErrors(const YamlMap& map, SensorErrors* errors) {
  std::vector<NamedError> fields;
  for (std::size_t i = 0; i < kSensorFields; ++i) {
    fields.push_back({NameOf(static_cast<SensorField>(i)), &errors->fields[i], false});
  }
  LoadFieldErrors(map, fields);
}

void LoadJointErrors(const YamlMap& map, SensorErrors* errors) {
  std::vector<NamedError> fields;
  for (std::size_t i = 0; i < kJointQuantities.size(); ++i) {
    fields.push_back({std::string(kJointQuantities[i]), &errors->joints[i], true});
  }
  LoadFieldErrors(map, fields);
}

void LoadCommandEffect(const YamlMap& map, const std::string& own, CommandChannelSpec* command) {
  if (const YamlValue* v = map.Find("latency")) command->latency = v->AsDuration();
  if (const YamlValue* v = map.Find("axes")) command->in_body_frame = LoadIsInOwnFrame(*v, own);
  if (const YamlValue* v = map.Find("lag")) command->lag = v->AsDuration();
  const YamlValue* limits = map.Find("limits");
  if (limits == nullptr) return;
  const YamlMap most = limits->AsMap();
  most.AllowOnly({"force", "torque"});
  if (const YamlValue* v = most.Find("force")) command->most_force_n = LoadLimit(*v, " (N)");
  if (const YamlValue* v = most.Find("torque")) command->most_torque_nm = LoadLimit(*v, " (N*m)");
}

}  // namespace tcs
