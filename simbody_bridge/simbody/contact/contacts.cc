#include "simbody_bridge/simbody/contact/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simbody_bridge/model/moving_ball.h"
#include "simbody_bridge/simbody/vectors.h"

namespace tcs {
namespace {

// The lighter of two bodies that touch would swing so fast on one point of contact; a weight on one
// point sinks in by g / kContactRadps^2.
constexpr double kContactRadps = 600;
constexpr double kDampingRatio = 0.5;

// Of each body, the mass of all bodies that hang together with it.
std::vector<double> MassesTogether(const Forest& forest) {
  std::vector<std::size_t> root(forest.bodies.size());
  std::vector<double> sum(forest.bodies.size());
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const int parent = forest.bodies[i].parent;
    root[i] = parent == kWorldBody ? i : root[static_cast<std::size_t>(parent)];
    sum[root[i]] += forest.bodies[i].mass_kg;
  }
  std::vector<double> masses;
  for (const std::size_t of : root) masses.push_back(sum[of]);
  return masses;
}

}  // namespace

Contacts::Contacts(const Forest& forest, const std::vector<SimTK::MobilizedBody>& bodies)
    : bodies_(bodies) {
  const std::vector<double> masses = MassesTogether(forest);
  for (const ForestShape& shape : forest.shapes) {
    const double mass = shape.body == kWorldBody ? std::numeric_limits<double>::infinity()
                                                 : masses[static_cast<std::size_t>(shape.body)];
    parts_.push_back({Solid(shape.shape->geometry), shape.body, ToTransform(shape.pose),
                      shape.shape->friction, mass});
  }
  poses_.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (std::size_t k = i + 1; k < parts_.size(); ++k) {
      if (!MayTouch(forest, forest.shapes[i], forest.shapes[k])) continue;
      const double mass = 1 / (1 / parts_[i].mass_kg + 1 / parts_[k].mass_kg);
      pairs_.push_back({i, k, std::min(parts_[i].friction, parts_[k].friction),
                        mass * kContactRadps * kContactRadps,
                        2 * kDampingRatio * mass * kContactRadps});
    }
  }
}

void Contacts::Place(const SimTK::State& state) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    poses_[i] = part.on_body;
    if (part.body == kWorldBody) continue;
    const SimTK::MobilizedBody& body = bodies_[static_cast<std::size_t>(part.body)];
    poses_[i] = body.getBodyTransform(state) * part.on_body;
  }
}

// The speed of the pair's nearest points towards each other, at the most.
double Contacts::SpeedBetween(const SimTK::State& state, const Pair& pair) const {
  SimTK::Vec3 between(0);
  double turning = 0;
  for (const std::size_t index : {pair.first, pair.second}) {
    const Part& part = parts_[index];
    if (part.body == kWorldBody) continue;
    const SimTK::MobilizedBody& body = bodies_[static_cast<std::size_t>(part.body)];
    const SimTK::Vec3 speed = body.findStationVelocityInGround(state, part.on_body.p());
    between += (index == pair.first ? 1.0 : -1.0) * speed;
    turning += body.getBodyAngularVelocity(state).norm() * part.solid.reach();
  }
  return between.norm() + turning;
}

double Contacts::TimeToTouch(const SimTK::State& state) {
  double least_s = std::numeric_limits<double>::infinity();
  if (pairs_.empty()) return least_s;
  Place(state);
  gaps_.clear();
  for (const Pair& pair : pairs_) {
    const double gap = GapBetween({parts_[pair.first].solid, poses_[pair.first]},
                                  {parts_[pair.second].solid, poses_[pair.second]});
    if (gap <= 0) return 0;
    gaps_.push_back(gap);
    least_s = std::min(least_s, TimeOver(gap, SpeedBetween(state, pair)));
  }
  return least_s;
}

bool Contacts::MayHaveTouched(const SimTK::State& state, double seconds) const {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (SpeedBetween(state, pairs_[i]) * seconds > gaps_[i]) return true;
  }
  return false;
}

bool Contacts::MayComeDeeper(const SimTK::State& state, double seconds, double depth_m) const {
  for (const Pair& pair : pairs_) {
    const double way = SpeedBetween(state, pair) * seconds;
    if (way <= depth_m) continue;
    const PlacedSolid a{parts_[pair.first].solid, poses_[pair.first]};
    const PlacedSolid b{parts_[pair.second].solid, poses_[pair.second]};
    if (GapBetween(a, b) < way - depth_m) return true;
  }
  return false;
}

double Contacts::LatenessOfTouch(const SimTK::State& state, double late_m, double met_m) {
  Find(state, &deep_);
  double late_s = 0;
  for (const Contact& contact : deep_) {
    if (contact.touch.depth <= late_m) continue;
    SimTK::Vec3 leaving(0);
    for (const auto& [index, sign] : {std::pair{contact.first, 1.0}, {contact.second, -1.0}}) {
      if (index == kWorldBody) continue;
      const SimTK::MobilizedBody& body = bodies_[static_cast<std::size_t>(index)];
      leaving += sign * body.findStationVelocityInGround(
                            state, body.findStationAtGroundPoint(state, contact.touch.point));
    }
    const double coming = -SimTK::dot(leaving, contact.touch.normal);
    if (coming > 0) late_s = std::max(late_s, (contact.touch.depth - met_m) / coming);
  }
  return late_s;
}

void Contacts::Find(const SimTK::State& state, std::vector<Contact>* contacts) {
  contacts->clear();
  Place(state);
  for (const Pair& pair : pairs_) {
    const Part& first = parts_[pair.first];
    const Part& second = parts_[pair.second];
    const PlacedSolid a{first.solid, poses_[pair.first]}, b{second.solid, poses_[pair.second]};
    if (GapBetween(a, b) > 0) continue;
    touches_.clear();
    FindTouches(a, b, &touches_);
    for (const Touch& touch : touches_) {
      contacts->push_back({first.body, second.body, pair.first, pair.second, touch, pair.friction,
                           pair.stiffness_npm, pair.damping_nspm});
    }
  }
}

}  // namespace tcs
