// A sensor of a robot that is a model: when it looks at the world, and what it makes of that.
//
// It neither moves the dynamics nor knows what carries what it measures, and draws no noise.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "coordinator/scenario/scenario.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/measurements.h"

namespace tcs {

// How links and joints of the world are at the instant; as many states as are asked for.
using ReadLinks = std::function<void(std::span<const int> links, std::span<LinkState> states)>;
using ReadJoints = std::function<void(std::span<const int> joints, std::span<JointState> states)>;
struct Eyes {
  ReadLinks links;
  ReadJoints joints;
};

class Instrument {
 public:
  virtual ~Instrument() = default;

  // A sample takes so many looks: the first one at its beginning, the others as long after the one
  // before.
  struct Looks {
    int count = 1;
    VirtualDuration apart{};
  };
  virtual Looks looks() const { return {}; }
  // The links that it asks for in a look, so that all that are due can be read at once.
  virtual std::span<const int> links() const { return {}; }
  // The look of that number, counted from 0, at `now`.
  virtual void Look(int number, VirtualTime now, const Eyes& eyes) = 0;
  // What came out of it, once all looks are taken.
  virtual Measurement Finish() = 0;
};

// Of a sensor that takes a sample each `period`. The world outlives it.
std::unique_ptr<Instrument> MakeInstrument(const InstrumentSpec& spec, VirtualDuration period,
                                           const WorldSpec& world);

}  // namespace tcs
