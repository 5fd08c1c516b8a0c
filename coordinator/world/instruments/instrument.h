// A sensor of a robot that is a model: when it looks at the world, and which measurement it makes
// of that.
//
// The sensor neither moves the dynamics nor knows what carries its measurements, and draws no
// noise.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "coordinator/scenario/scenario.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/measurements.h"

namespace tcs {

// Functions that read the states of links and joints of the world at the instant; as many states as
// are asked for.
using ReadLinks = std::function<void(std::span<const int> links, std::span<LinkState> states)>;
using ReadJoints = std::function<void(std::span<const int> joints, std::span<JointState> states)>;
struct Eyes {
  ReadLinks links;
  ReadJoints joints;
};

class Instrument {
 public:
  virtual ~Instrument() = default;

  // A sample takes `count` looks: the first one at the sample's beginning, each other one `apart`
  // after the one before.
  struct Looks {
    int count = 1;
    VirtualDuration apart{};
  };
  virtual Looks looks() const { return {}; }
  // The links that the sensor asks for in a look, so that all links that are due can be read at
  // once.
  virtual std::span<const int> links() const { return {}; }
  // The look of that number, counted from 0, at `now`.
  virtual void Look(int number, VirtualTime now, const Eyes& eyes) = 0;
  // The measurement, once all looks are taken.
  virtual Measurement Finish() = 0;
};

// The instrument of a sensor that takes a sample each `period`. The world outlives the instrument.
std::unique_ptr<Instrument> MakeInstrument(const InstrumentSpec& spec, VirtualDuration period,
                                           const WorldSpec& world);

}  // namespace tcs
