// The contacts among the bodies of an island and the world's fixtures.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "simbody_bridge/model/forest.h"
#include "simbody_bridge/simbody/contact/touch.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

// A touch as two bodies feel it: a spring with a damper along the normal, and friction across it.
struct Contact {
  int first = kWorldBody, second = kWorldBody;    // bodies of the forest
  std::size_t first_shape = 0, second_shape = 0;  // and their shapes
  Touch touch;
  double friction = 0;
  double stiffness_npm = 0, damping_nspm = 0;
};

class Contacts {
 public:
  // `forest` outlives this; `bodies` are its bodies.
  Contacts(const Forest& forest, const std::vector<SimTK::MobilizedBody>& bodies);

  bool has_pairs() const { return !pairs_.empty(); }

  // The time in seconds for which at least no solids touch that do not touch yet; 0 where solids
  // may touch. `state` is realized to Velocity. The function trusts that no body is pushed much
  // harder than its weight.
  double TimeToTouch(const SimTK::State& state);
  // Whether that trust was misplaced: as fast as solids are at `state`, realized to Velocity, one
  // may have come through another one within `seconds` from the state that was asked about last.
  bool MayHaveTouched(const SimTK::State& state, double seconds) const;
  // Whether within `seconds` from `state`, realized to Velocity, a solid may come so much deeper
  // into another one. TimeToTouch was asked about `state` last.
  bool MayComeDeeper(const SimTK::State& state, double seconds, double depth_m) const;
  // How long before `state`, realized to Velocity, the first of the contacts deeper than `late_m`
  // was as deep as `met_m`, if it has come uniformly; 0: no contact is deeper.
  double LatenessOfTouch(const SimTK::State& state, double late_m, double met_m);
  // `state` is realized to Position.
  void Find(const SimTK::State& state, std::vector<Contact>* contacts);

 private:
  struct Part {
    Solid solid;
    int body;
    SimTK::Transform on_body;  // or in the world
    double friction;
    double mass_kg;  // of all that hangs together with the body
  };
  struct Pair {
    std::size_t first, second;  // parts
    double friction, stiffness_npm, damping_nspm;
  };
  void Place(const SimTK::State& state);
  double SpeedBetween(const SimTK::State& state, const Pair& pair) const;

  const std::vector<SimTK::MobilizedBody> bodies_;
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;
  std::vector<SimTK::Transform> poses_;  // of the parts, in the world: memory
  std::vector<double> gaps_;             // of the pairs, as TimeToTouch found them
  std::vector<Touch> touches_;
  std::vector<Contact> deep_;
};

}  // namespace tcs
