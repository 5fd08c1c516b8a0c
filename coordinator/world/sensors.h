// The sensors of a run: when each looks at the world, and that its readings go out. The clock is a
// sensor that looks at no body.
//
// Not thread-safe. Sensors neither move the dynamics nor know what carries their readings.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/world/instruments/instrument.h"
#include "coordinator/world/measurement_noise.h"
#include "coordinator/world/sensor_noise.h"
#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/inertial.h"

namespace tcs {

struct SensorTiming {
  VirtualDuration period;   // between samples, of which the first is at time 0; 0: only that one
  VirtualDuration latency;  // from the sample to its arrival
};

class Sensors {
 public:
  // The state of body `body` of the world at the instant.
  using Read = std::function<BodyState(int body)>;
  struct Body {
    int index;         // in the world
    std::string name;  // in readings
  };

  // `gravity_mps2` is the acceleration that accelerometers do not feel.
  explicit Sensors(const std::array<double, 3>& gravity_mps2 = {}) : gravity_mps2_(gravity_mps2) {}

  // The outlet outlives this.
  void Add(std::vector<Body> bodies, SensorTiming timing, const SensorErrors& errors,
           Outlet& outlet);
  // Adds a sensor of joints.
  void AddJoints(const JointGroup& joints, SensorTiming timing, const SensorErrors& errors,
                 Outlet& outlet);
  // Adds a sensor of a robot that looks by itself.
  void AddInstrument(std::unique_ptr<Instrument> instrument, SensorTiming timing,
                     const SensorErrors& errors, const MeasurementErrors& measurement_errors,
                     Outlet& outlet);

  // The next time at which there is something to do, and the next at which something may reach a
  // program.
  VirtualTime NextStop() const;
  VirtualTime NextArrival() const;

  // Appends the bodies of which samples are due, and the links of which looks are due. A body or a
  // link may be there more than once.
  void AddDueBodies(VirtualTime now, std::vector<int>* bodies) const;
  void AddDueLinks(VirtualTime now, std::vector<int>* links) const;
  // Takes the samples that are due, and hands over the readings that are due to arrive. True if
  // something went out.
  bool Act(VirtualTime now, const Read& read, const Eyes& eyes = {});

  std::int64_t samples() const { return samples_; }

 private:
  struct Sensor {
    std::vector<Body> bodies;
    SensorTiming timing;
    Outlet* outlet;
    SensorNoise noise;
    std::vector<InertialSensor> inertial;  // of each body
    VirtualTime next;                      // look
    std::uint64_t number = 0;              // of the sample
    VirtualTime last_arrives;
    JointGroup joints{};
    std::vector<JointState> joint_states{};  // memory of Sample
    std::unique_ptr<Instrument> instrument{};
    MeasurementNoise measurement_noise{};
    VirtualTime began{};  // the sample
    int look = 0;         // of the sample, the next
  };
  static VirtualTime NextSample(const Sensor& sensor);
  bool Sample(Sensor& sensor, VirtualTime now, const Read& read, const Eyes& eyes);
  bool Look(Sensor& sensor, VirtualTime now, const Eyes& eyes);
  bool SendOff(Sensor& sensor, VirtualTime now, Reading reading);

  std::array<double, 3> gravity_mps2_;
  std::vector<Sensor> sensors_;
  std::int64_t samples_ = 0;
};

}  // namespace tcs
