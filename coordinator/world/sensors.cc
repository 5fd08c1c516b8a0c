#include "coordinator/world/sensors.h"

#include <algorithm>
#include <utility>

namespace tcs {

void Sensors::Add(std::vector<Body> bodies, SensorTiming timing, const SensorErrors& errors,
                  Outlet& outlet) {
  SensorNoise noise(errors, bodies.size());
  std::vector<InertialSensor> inertial(bodies.size(), InertialSensor(gravity_mps2_));
  sensors_.push_back(
      {std::move(bodies), timing, &outlet, std::move(noise), std::move(inertial), {}, 0, {}});
}

void Sensors::AddJoints(const JointGroup& joints, SensorTiming timing, const SensorErrors& errors,
                        Outlet& outlet) {
  Add(std::vector<Body>(), timing, errors, outlet);
  sensors_.back().joints = joints;
  sensors_.back().joint_states.resize(joints.joints.size());
  sensors_.back().noise = SensorNoise(errors, 0, joints.joints.size());
}

void Sensors::AddInstrument(std::unique_ptr<Instrument> instrument, SensorTiming timing,
                            const SensorErrors& errors, const MeasurementErrors& measurement_errors,
                            Outlet& outlet) {
  Add(std::vector<Body>(), timing, errors, outlet);
  sensors_.back().instrument = std::move(instrument);
  sensors_.back().measurement_noise = MeasurementNoise(measurement_errors, errors.seed);
}

// The time at which the sample that is being taken, or is taken next, is whole.
VirtualTime Sensors::NextSample(const Sensor& sensor) {
  if (sensor.instrument == nullptr) return sensor.next;
  const Instrument::Looks looks = sensor.instrument->looks();
  return sensor.next + looks.apart * (looks.count - 1 - sensor.look);
}

VirtualTime Sensors::NextStop() const {
  VirtualTime next = VirtualTime::Never();
  for (const Sensor& sensor : sensors_) {
    next = std::min({next, sensor.next, sensor.outlet->NextDue()});
  }
  return next;
}

VirtualTime Sensors::NextArrival() const {
  VirtualTime next = VirtualTime::Never();
  for (const Sensor& sensor : sensors_) {
    next = std::min({next, NextSample(sensor) + sensor.timing.latency, sensor.outlet->NextDue()});
  }
  return next;
}

void Sensors::AddDueBodies(VirtualTime now, std::vector<int>* bodies) const {
  for (const Sensor& sensor : sensors_) {
    if (sensor.next > now) continue;
    for (const Body& body : sensor.bodies) bodies->push_back(body.index);
  }
}

void Sensors::AddDueLinks(VirtualTime now, std::vector<int>* links) const {
  for (const Sensor& sensor : sensors_) {
    if (sensor.next > now || sensor.instrument == nullptr) continue;
    const std::span<const int> its = sensor.instrument->links();
    links->insert(links->end(), its.begin(), its.end());
  }
}

bool Sensors::Act(VirtualTime now, const Read& read, const Eyes& eyes) {
  bool went_out = false;
  for (Sensor& sensor : sensors_) {
    if (sensor.instrument != nullptr) {
      // Where a sample ends the next one may begin.
      while (sensor.next <= now) went_out |= Look(sensor, now, eyes);
    } else if (sensor.next <= now) {
      went_out |= Sample(sensor, now, read, eyes);
    }
    went_out |= sensor.outlet->HandOver(now);
  }
  return went_out;
}

bool Sensors::Sample(Sensor& sensor, VirtualTime now, const Read& read, const Eyes& eyes) {
  Reading reading{now, {}};
  if (!sensor.joint_states.empty()) eyes.joints(sensor.joints.joints, sensor.joint_states);
  for (std::size_t i = 0; i < sensor.joint_states.size(); ++i) {
    reading.joints.push_back({sensor.joints.names[i], sensor.joint_states[i]});
  }
  for (std::size_t i = 0; i < sensor.bodies.size(); ++i) {
    const BodyState state = read(sensor.bodies[i].index);
    reading.bodies.push_back({sensor.bodies[i].name, state, sensor.inertial[i].Sample(now, state)});
  }
  sensor.next += sensor.timing.period;
  return SendOff(sensor, now, std::move(reading));
}

bool Sensors::Look(Sensor& sensor, VirtualTime now, const Eyes& eyes) {
  const Instrument::Looks looks = sensor.instrument->looks();
  if (sensor.look == 0) sensor.began = now;
  sensor.instrument->Look(sensor.look, now, eyes);
  if (++sensor.look < looks.count) {
    sensor.next += looks.apart;
    return false;
  }
  sensor.look = 0;
  sensor.next = sensor.timing.period == VirtualDuration{} ? VirtualTime::Never()
                                                          : sensor.began + sensor.timing.period;
  Reading reading{sensor.began, {}};
  reading.measured = sensor.instrument->Finish();
  return SendOff(sensor, now, std::move(reading));
}

// Sends off a reading that has become whole at `now`.
bool Sensors::SendOff(Sensor& sensor, VirtualTime now, Reading reading) {
  const std::uint64_t number = sensor.number++;
  const SensorNoise::Fate fate = sensor.noise.FateOf(number);
  if (fate.is_lost) return false;
  sensor.noise.Disturb(number, &reading);
  sensor.measurement_noise.Disturb(number, &reading.measured);
  ++samples_;
  // No reading overtakes another.
  sensor.last_arrives = std::max(sensor.last_arrives, now + sensor.timing.latency + fate.late);
  return sensor.outlet->Send(reading, sensor.last_arrives);
}

}  // namespace tcs
