#include "coordinator/report/replay_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tcs::report {
namespace {

// A moment that is nearer to the one before than this share of the interval is left out.
constexpr double kNearly = 1e-6;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

struct Quantity {
  std::string_view name, panel, unit;
};
// The quantities of commands; a joint's unit is the joint's.
constexpr Quantity kQuantities[] = {
    {"force_x", "commanded force", "N"},         {"force_y", "commanded force", "N"},
    {"force_z", "commanded force", "N"},         {"torque_x", "commanded torque", "N m"},
    {"torque_y", "commanded torque", "N m"},     {"torque_z", "commanded torque", "N m"},
    {"speed", "commanded rotor speed", "rad/s"}, {"forward", "commanded speed", "m/s"},
    {"turn", "commanded turn rate", "rad/s"},
};

// The unit of the effort of a joint whose positions are in `unit`.
std::string EffortUnit(const std::string& unit) { return unit == "m" ? "N" : "N m"; }

std::string LastPart(const std::string& name) {
  return name.substr(name.rfind('/') + 1);  // of a name without a slash all of it
}

void Put(Signal* signal, std::size_t moment, double value) {
  if (signal->values.size() <= moment) signal->values.resize(moment + 1, kNothing);
  signal->values[moment] = value;
}

}  // namespace

ReplayReader::ReplayReader(ReplayScene scene, Replay* replay, double interval_s)
    : scene_(std::move(scene)), replay_(*replay), interval_s_(interval_s) {
  for (const std::string& name : scene_.tracks) AddTrack(name);
  for (const ReplayScene::Robot& robot : scene_.robots) {
    replay_.robots.push_back({robot.name, robot.root, {}});
  }
  has_scene_ = !scene_.json.is_null();
}

bool ReplayReader::TakeState(const CsvFields& fields) {
  const auto known = track_of_.find(std::string(fields[1]));
  if (known == track_of_.end() && has_scene_) return true;  // a link that is fixed to another one
  const auto time = ToReal(fields[0]);
  if (!time) return false;
  if (!NoteTime(*time)) return true;
  std::array<double, 10> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = ToReal(fields[i + 2]);
    if (!number) return false;
    numbers[i] = *number;
  }
  std::size_t track = 0;
  if (known != track_of_.end()) {
    track = known->second;
  } else {
    track = AddTrack(std::string(fields[1]));
    replay_.robots.push_back({replay_.tracks[track].name, track, {}});
  }
  TakePose(track, numbers);
  return true;
}

bool ReplayReader::TakeJoint(const CsvFields& fields) {
  const auto time = ToReal(fields[0]);
  if (!time) return false;
  const auto moment = MomentOf(*time);
  if (!moment) return true;
  const std::string joint(fields[1]);
  const std::string unit = UnitOf(joint);
  const std::pair<std::string_view, std::string> panels[] = {{"joint positions", unit},
                                                             {"joint speeds", unit + "/s"},
                                                             {"joint efforts", EffortUnit(unit)}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = ToReal(fields[i + 2]);
    Signal* signal = SignalOf(joint, panels[i].first, panels[i].second, LastPart(joint));
    if (!number || signal == nullptr) return number.has_value();
    Put(signal, *moment, *number);
  }
  return true;
}

bool ReplayReader::TakeContact(const CsvFields& fields) {
  std::array<double, 7> numbers{};  // a time, a point, a force
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = ToReal(fields[i == 0 ? 0 : i + 2]);
    if (!number) return false;
    numbers[i] = *number;
  }
  const auto& [time_s, x, y, z, fx, fy, fz] = numbers;
  if (const auto moment = MomentOf(time_s)) {
    const std::string second(fields[2]);
    replay_.contacts.Add(*moment, {std::string(fields[1]), second, scene_.moving.contains(second)},
                         {x, y, z}, {fx, fy, fz});
  }
  return true;
}

// The command holds until the next one of its kind.
bool ReplayReader::TakeCommand(const CsvFields& fields) {
  const auto acts = ToInteger(fields[0]);
  const auto value = ToReal(fields[3]);
  if (!acts || !value) return false;
  const std::string target(fields[1]);
  Signal* signal = nullptr;
  for (const Quantity& quantity : kQuantities) {
    if (fields[2] != quantity.name) continue;
    const bool is_rotor = fields[2] == "speed";
    signal = SignalOf(target, quantity.panel, quantity.unit,
                      is_rotor ? LastPart(target) : std::string(1, fields[2].back()));
    if (signal != nullptr && (fields[2] == "forward" || fields[2] == "turn")) {
      signal->name = fields[2];
    }
  }
  if (signal == nullptr) {
    const std::string unit = UnitOf(target);
    const std::string_view kind = fields[2];
    const bool is_effort = kind == "effort", is_speed = kind == "velocity";
    signal =
        SignalOf(target,
                 is_effort  ? "commanded joint efforts"
                 : is_speed ? "commanded joint speeds"
                            : "commanded joint positions",
                 is_effort ? EffortUnit(unit) : unit + (is_speed ? "/s" : ""), LastPart(target));
  }
  if (signal == nullptr) return true;  // of no robot that is shown
  const double acts_s = static_cast<double>(*acts) * 1e-9;
  const auto& times = replay_.time_s;
  const auto from = std::lower_bound(times.begin(), times.end(), acts_s - 1e-9) - times.begin();
  if (static_cast<std::size_t>(from) < times.size()) {
    Put(signal, static_cast<std::size_t>(from), *value);
  }
  return true;
}

// Once all files are read.
void ReplayReader::Finish() {
  for (PoseTrack& track : replay_.tracks) {
    // A run that was cut off may have written only a part of its last moment.
    const PoseRow last = track.poses.empty() ? PoseRow{0, 0, 0, 0, 0, 0, 1} : track.poses.back();
    track.poses.resize(replay_.time_s.size(), last);
  }
  FindAllPaths();
  for (Signal& signal : replay_.signals) Hold(&signal);
  std::erase_if(replay_.signals, [](const Signal& s) { return s.values.empty(); });
  if (has_scene_) replay_.scene = std::move(scene_.json);
}

std::size_t ReplayReader::AddTrack(const std::string& name) {
  track_of_[name] = replay_.tracks.size();
  replay_.tracks.push_back({name, {}});
  return replay_.tracks.size() - 1;
}

// Whether there is a moment at that time, the latest of the file so far.
bool ReplayReader::NoteTime(double time_s) {
  auto& times = replay_.time_s;
  if (!times.empty() && time_s == times.back()) return true;
  const bool is_due = times.empty() || time_s > times.back() + interval_s_ * (1 - kNearly);
  if (is_due) times.push_back(time_s);
  return is_due;
}

std::optional<std::size_t> ReplayReader::MomentOf(double time_s) const {
  const auto& times = replay_.time_s;
  const auto at = std::lower_bound(times.begin(), times.end(), time_s);
  if (at == times.end() || *at != time_s) return {};
  return static_cast<std::size_t>(at - times.begin());
}

void ReplayReader::TakePose(std::size_t number, const std::array<double, 10>& n) {
  PoseTrack& track = replay_.tracks[number];
  const std::size_t moment = replay_.time_s.size() - 1;
  PoseRow pose{n[0], n[1], n[2], n[3], n[4], n[5], n[6]};
  // An orientation has two signs; the one that is near the last pose is taken.
  if (!track.poses.empty()) {
    const PoseRow& last = track.poses.back();
    double same = 0;
    for (std::size_t i = 3; i < 7; ++i) same += last[i] * pose[i];
    for (std::size_t i = 3; same < 0 && i < 7; ++i) pose[i] = -pose[i];
    track.poses.resize(moment, last);
  } else {
    track.poses.resize(moment, pose);
  }
  track.poses.push_back(pose);
  for (std::size_t robot = 0; robot < replay_.robots.size(); ++robot) {
    if (replay_.robots[robot].root != number) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      Put(SignalAt(robot, "velocity [m/s]", std::string(1, "xyz"[i])), moment, n[7 + i]);
    }
  }
}

std::string ReplayReader::UnitOf(const std::string& joint) const {
  for (const ReplayScene::Robot& robot : scene_.robots) {
    const auto found = robot.joint_units.find(joint);
    if (found != robot.joint_units.end()) return found->second;
  }
  return "rad";
}

// Null if no robot that is shown has the target.
Signal* ReplayReader::SignalOf(const std::string& target, std::string_view panel,
                               std::string_view unit, const std::string& name) {
  const std::string_view owner = std::string_view(target).substr(0, target.find('/'));
  for (std::size_t robot = 0; robot < replay_.robots.size(); ++robot) {
    if (replay_.robots[robot].name != owner) continue;
    return SignalAt(robot, fmt::format("{} [{}]", panel, unit), name);
  }
  return nullptr;
}

Signal* ReplayReader::SignalAt(std::size_t robot, const std::string& panel,
                               const std::string& name) {
  const auto [place, is_new] =
      signal_of_.try_emplace(fmt::format("{} {} {}", robot, panel, name), replay_.signals.size());
  if (is_new) replay_.signals.push_back({robot, panel, name, 0, {}});
  return &replay_.signals[place->second];
}

// A moment without a value has the value of the moment before.
void ReplayReader::Hold(Signal* signal) const {
  auto& values = signal->values;
  const auto known =
      std::find_if(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
  signal->first = static_cast<std::size_t>(known - values.begin());
  values.erase(values.begin(), known);
  if (values.empty()) return;
  values.resize(replay_.time_s.size() - signal->first, kNothing);
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (std::isnan(values[i])) values[i] = values[i - 1];
  }
}

void ReplayReader::FindPaths(std::size_t number) {
  RobotTracks& robot = replay_.robots[number];
  if (replay_.tracks[robot.root].IsStill() && number < scene_.robots.size()) {
    for (const std::size_t track : scene_.robots[number].tracks) {
      if (!replay_.tracks[track].IsStill()) robot.paths.push_back(track);
    }
  }
  if (robot.paths.empty()) robot.paths = {robot.root};
}

void ReplayReader::FindAllPaths() {
  for (std::size_t robot = 0; robot < replay_.robots.size(); ++robot) {
    replay_.robots[robot].paths.clear();
    FindPaths(robot);
  }
}

void ReplayReader::Thin() {
  interval_s_ *= 2;
  const auto thin = [](auto* all) {
    for (std::size_t i = 0; 2 * i < all->size(); ++i) (*all)[i] = (*all)[2 * i];
    all->resize((all->size() + 1) / 2);
  };
  // A command counts until the next one; so does the command of a moment that is left out.
  for (Signal& signal : replay_.signals) {
    for (std::size_t i = 1; i + 1 < signal.values.size(); i += 2) {
      if (std::isnan(signal.values[i + 1])) signal.values[i + 1] = signal.values[i];
    }
    thin(&signal.values);
  }
  for (PoseTrack& track : replay_.tracks) thin(&track.poses);
  replay_.contacts.Thin();
  thin(&replay_.time_s);
}

}  // namespace tcs::report
