// A sensor of contact.
#pragma once

#include <vector>

#include "coordinator/world/instruments/instrument.h"
#include "simbody_bridge/touch/touching.h"

namespace tcs {

class Bumper final : public Instrument {
 public:
  Bumper(const ContactSpec& spec, const WorldSpec& world)
      : spec_(spec), touching_(world, spec.mount.link) {
    measured_.frame = spec.mount.frame;
  }
  std::span<const int> links() const override { return touching_.links(); }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  ContactSpec spec_;
  Touching touching_;
  std::vector<LinkState> states_;
  std::vector<Pose> poses_;
  ContactMeasurement measured_;
};

}  // namespace tcs
