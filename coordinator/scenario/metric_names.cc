#include "coordinator/scenario/metric_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "coordinator/errors/nearest.h"

namespace tcs {

namespace {

constexpr std::size_t kMostListed = 12;
constexpr std::array<std::string_view, 4> kComponents = {"x", "y", "z", "w"};

template <class... Handlers>
struct Either : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Either(Handlers...) -> Either<Handlers...>;

std::vector<std::string> KeysOf(const auto& map) {
  std::vector<std::string> keys;
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

// Suggests the nearest of the known names, or as many names as a sentence holds.
std::string SuggestShortly(std::string_view written, std::vector<std::string> known,
                           std::string_view kind) {
  if (const auto nearest = Nearest(written, known)) return "did you mean '" + *nearest + "'?";
  const std::size_t all = known.size();
  if (all > kMostListed) {
    known.resize(kMostListed);
    return fmt::format("the {} here are {} and {} more", kind, fmt::join(known, ", "),
                       all - kMostListed);
  }
  return Suggest(written, known, kind);
}

}  // namespace

MetricNames::MetricNames(const Scenario& scenario, std::vector<QuantitySpec>* quantities)
    : quantities_(*quantities) {
  const WorldSpec& world = *scenario.world;
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    AddMoving(world.bodies[i].name, QuantitySpec::Kind::kBody, i);
  }
  std::size_t first = 0;
  for (const RobotModel& model : world.models) {
    // A model's own name is that of its root.
    AddMoving(model.name, QuantitySpec::Kind::kLink, first + static_cast<std::size_t>(model.root));
    for (std::size_t i = 0; i < model.links.size() && model.links.size() > 1; ++i) {
      AddMoving(model.name + "/" + model.links[i].name, QuantitySpec::Kind::kLink, first + i);
    }
    first += model.links.size();
  }
  AddJoints(world);
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) AddSensor(scenario, i);
  for (std::size_t i = 0; i < scenario.commands.size(); ++i) AddCommands(scenario.commands[i], i);
}

void MetricNames::Add(const std::string& of, const std::string& quantity, QuantitySpec spec) {
  if (known_.emplace(of + "." + quantity, std::move(spec)).second) things_[of].push_back(quantity);
}

void MetricNames::AddComponents(const std::string& of, const std::string& field,
                                std::size_t components, const QuantitySpec& spec) {
  for (std::size_t i = 0; i < components; ++i) {
    QuantitySpec component = spec;
    component.part = i;
    Add(of, components == 1 ? field : field + "." + std::string(kComponents[i]), component);
  }
}

void MetricNames::AddMoving(const std::string& name, QuantitySpec::Kind kind, std::size_t index) {
  for (std::size_t part = 0; part < kMotionQuantities.size(); ++part) {
    Add(name, std::string(kMotionQuantities[part]), {.kind = kind, .index = index, .part = part});
  }
  places_.emplace(name, QuantitySpec{.kind = kind, .index = index});
}

void MetricNames::AddJoints(const WorldSpec& world) {
  std::size_t number = 0;
  for (const RobotModel& model : world.models) {
    for (const Joint& joint : model.joints) {
      for (std::size_t i = 0; i < kJointQuantities.size() && CoordinatesOf(joint.kind) == 1; ++i) {
        Add(model.name + "/" + joint.name, std::string(kJointQuantities[i]),
            {.kind = QuantitySpec::Kind::kJoint, .index = number, .part = i});
      }
      ++number;
    }
  }
}

// The fields that world/reading_quantities.cc tells of.
void MetricNames::AddSensor(const Scenario& scenario, std::size_t index) {
  const SensorChannelSpec& sensor = scenario.sensors[index];
  const auto spec = [&](const std::string& of, const std::string& field) {
    return QuantitySpec{
        .kind = QuantitySpec::Kind::kReading, .index = index, .part = 0, .of = of, .field = field};
  };
  const std::string& name = sensor.name;
  if (sensor.joints) {
    for (const std::string& joint : sensor.joints->names) {
      for (const std::string_view quantity : kJointQuantities) {
        const std::string field(quantity);
        Add(name, joint + "." + field, spec(joint, field));
      }
    }
    return;
  }
  if (!sensor.instrument) {
    for (const int body : sensor.bodies) {
      // A single body need not be named.
      const std::string& of = scenario.world->bodies[static_cast<std::size_t>(body)].name;
      const bool is_alone = sensor.bodies.size() == 1;
      for (const SensorField field : sensor.fields) {
        const std::string text = NameOf(field);
        AddComponents(name, is_alone ? text : of + "." + text,
                      field == SensorField::kOrientation ? 4 : 3, spec(of, text));
      }
    }
    return;
  }
  const auto vector = [&](const std::string& field, std::size_t components = 3) {
    AddComponents(name, field, components, spec("", field));
  };
  const auto odometry = [&] {
    vector("position");
    vector("orientation", 4);
    vector("linear_velocity");
    vector("angular_velocity");
  };
  std::visit(
      Either{[&](const ImuSpec&) {
               vector("orientation", 4);
               vector("angular_rate");
               vector("proper_acceleration");
             },
             [&](const TruthSpec&) { odometry(); }, [&](const WheelOdometrySpec&) { odometry(); },
             [&](const RangeSpec&) { vector("range", 1); },
             [&](const GnssSpec&) {
               QuantitySpec component = spec("", "east_north_up");
               for (const char* quantity : {"east", "north", "up"}) {
                 Add(name, quantity, component);
                 ++component.part;
               }
             },
             [&](const MagnetometerSpec&) { vector("magnetic_field"); },
             [&](const BarometerSpec&) { vector("pressure", 1); },
             [&](const ContactSpec&) { vector("touches", 1); },
             [](const auto&) {}},  // sensors with hundreds of numbers, or none
      *sensor.instrument);
}

// Adds the quantities by the names that commands.csv has for them.
void MetricNames::AddCommands(const CommandChannelSpec& channel, std::size_t index) {
  const auto add = [&](const std::string& of, const std::string& field) {
    Add(channel.name, of.empty() ? field : of + "." + field,
        {.kind = QuantitySpec::Kind::kCommand,
         .index = index,
         .part = 0,
         .of = of,
         .field = field});
  };
  if (channel.rotors) {
    for (const std::string& rotor : channel.rotors->names) add(rotor, "speed");
  } else if (channel.joints && channel.joints->wheels) {
    add("", "forward");
    add("", "turn");
  } else if (channel.joints) {
    for (const std::string& joint : channel.joints->group.names) {
      for (const std::string_view quantity : kJointQuantities) add(joint, std::string(quantity));
    }
  } else {
    for (const char* field :
         {"force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"}) {
      add("", field);
    }
  }
}

std::string MetricNames::WhyUnknown(std::string_view name) const {
  const std::string what = fmt::format("there is no quantity '{}'; ", name);
  if (const auto nearest = Nearest(name, KeysOf(known_)))
    return what + "did you mean '" + *nearest + "'?";
  // The longest thing that `name` begins with.
  for (std::size_t dot = name.rfind('.'); dot != std::string_view::npos && dot > 0;
       dot = name.rfind('.', dot - 1)) {
    const auto thing = things_.find(name.substr(0, dot));
    if (thing == things_.end()) continue;
    return what +
           SuggestShortly(name.substr(dot + 1), thing->second, "quantities of " + thing->first);
  }
  if (const auto thing = things_.find(name); thing != things_.end()) {
    return what + SuggestShortly("", thing->second, "quantities of " + thing->first);
  }
  return what + SuggestShortly(name.substr(0, name.find('.')), KeysOf(things_),
                               "bodies, joints and channels");
}

std::size_t MetricNames::Numbered(const std::string& name, const QuantitySpec& spec) {
  const auto [at, is_new] = numbers_.emplace(name, quantities_.size());
  if (is_new) quantities_.push_back(spec);
  return at->second;
}

std::variant<std::size_t, std::string> MetricNames::ValueOf(std::string_view name) {
  const auto found = known_.find(name);
  if (found == known_.end()) return WhyUnknown(name);
  return Numbered(found->first, found->second);
}

std::variant<std::array<std::size_t, 3>, std::string> MetricNames::PlaceOf(std::string_view name) {
  const auto found = places_.find(name);
  if (found == places_.end()) {
    return fmt::format("there is no body or link '{}'; {}", name,
                       SuggestShortly(name, KeysOf(places_), "bodies and links"));
  }
  std::array<std::size_t, 3> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    QuantitySpec spec = found->second;
    spec.part = i;
    numbers[i] = Numbered(found->first + "." + std::string(kMotionQuantities[i]), spec);
  }
  return numbers;
}

}  // namespace tcs
