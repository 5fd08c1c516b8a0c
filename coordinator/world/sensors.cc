#include "coordinator/world/sensors.h"

#include <algorithm>

namespace tcs {

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
    next = std::min({next, sensor.next + sensor.timing.latency, sensor.outlet->NextDue()});
  }
  return next;
}

bool Sensors::Act(VirtualTime now, const Read& read) {
  bool went_out = false;
  for (Sensor& sensor : sensors_) {
    if (sensor.next <= now) went_out |= Sample(sensor, now, read);
    went_out |= sensor.outlet->HandOver(now);
  }
  return went_out;
}

bool Sensors::Sample(Sensor& sensor, VirtualTime now, const Read& read) {
  Reading reading{now, {}};
  for (const Body& body : sensor.bodies) reading.bodies.push_back({body.name, read(body.index)});
  sensor.next += sensor.timing.period;
  ++samples_;
  return sensor.outlet->Send(reading, now + sensor.timing.latency);
}

}  // namespace tcs
