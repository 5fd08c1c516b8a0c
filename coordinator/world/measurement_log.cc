#include "coordinator/world/measurement_log.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace tcs {

class MeasurementLog::LoggedOutlet final : public Outlet {
 public:
  LoggedOutlet(MeasurementLog& log, const SensorChannelSpec& sensor, std::unique_ptr<Outlet> outlet)
      : log_(log), sensor_(sensor), outlet_(std::move(outlet)) {}

  bool Send(const Reading& reading, VirtualTime arrives) override {
    log_.Write(sensor_.name, sensor_.fields, reading);
    return outlet_->Send(reading, arrives);
  }
  VirtualTime NextDue() const override { return outlet_->NextDue(); }
  bool HandOver(VirtualTime now) override { return outlet_->HandOver(now); }
  std::string WhyUnheard() const override { return outlet_->WhyUnheard(); }
  std::string WhatWasLost() const override { return outlet_->WhatWasLost(); }
  void TellOf(DatagramWatch& watch, const std::string& channel) override {
    outlet_->TellOf(watch, channel);
  }

 private:
  MeasurementLog& log_;
  const SensorChannelSpec& sensor_;
  std::unique_ptr<Outlet> outlet_;
};

std::string MeasurementLog::Open(const std::string& path) {
  return file_.Open(path, "time_ns,channel,of,quantity,x,y,z,w");
}

std::unique_ptr<Outlet> MeasurementLog::Wrap(const SensorChannelSpec& sensor,
                                             std::unique_ptr<Outlet> outlet) {
  return std::make_unique<LoggedOutlet>(*this, sensor, std::move(outlet));
}

// What is not finite (nothing within reach) is no number for those who draw it.
void MeasurementLog::Line(const Of& of, std::string_view quantity,
                          std::initializer_list<double> values) {
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return;
  const double* v = values.begin();
  const std::int64_t at_ns = of.at.ns();
  switch (values.size()) {
    case 1:
      file_.Line(at_ns, of.channel, of.name, quantity, v[0], "", "", "");
      break;
    case 3:
      file_.Line(at_ns, of.channel, of.name, quantity, v[0], v[1], v[2], "");
      break;
    default:
      file_.Line(at_ns, of.channel, of.name, quantity, v[0], v[1], v[2], v[3]);
  }
}

template <std::size_t n>
void MeasurementLog::Line(const Of& of, std::string_view quantity,
                          const std::array<double, n>& values) {
  if constexpr (n == 3) {
    Line(of, quantity, {values[0], values[1], values[2]});
  } else {
    Line(of, quantity, {values[0], values[1], values[2], values[3]});
  }
}

void MeasurementLog::WriteBody(const Of& of, const std::vector<SensorField>& fields,
                               const BodyReading& body) {
  for (const SensorField field : fields) {
    switch (field) {
      case SensorField::kPosition:
        Line(of, "position (m)", body.state.position_m);
        break;
      case SensorField::kOrientation:
        Line(of, "orientation", body.state.orientation_xyzw);
        break;
      case SensorField::kLinearVelocity:
        Line(of, "linear velocity (m per s)", body.state.linear_velocity_mps);
        break;
      case SensorField::kAngularVelocity:
        Line(of, "angular velocity (rad per s)", body.state.angular_velocity_radps);
        break;
      case SensorField::kAngularRate:
        Line(of, "angular rate (rad per s)", body.felt.angular_rate_radps);
        break;
      case SensorField::kProperAcceleration:
        if (const auto& felt = body.felt.proper_acceleration_mps2) {
          Line(of, "proper acceleration (m per s2)", *felt);
        }
        break;
      case SensorField::kCount:
        break;
    }
  }
}

void MeasurementLog::WriteMeasured(VirtualTime at, const std::string& channel,
                                   const Measurement& measured) {
  if (const auto* imu = std::get_if<ImuMeasurement>(&measured)) {
    const Of of{at, channel, imu->frame};
    Line(of, "orientation", imu->orientation_xyzw);
    Line(of, "angular rate (rad per s)", imu->felt.angular_rate_radps);
    if (const auto& felt = imu->felt.proper_acceleration_mps2) {
      Line(of, "proper acceleration (m per s2)", *felt);
    }
  } else if (const auto* odometry = std::get_if<OdometryMeasurement>(&measured)) {
    const Of of{at, channel, odometry->child_frame};
    Line(of, "position (m)", odometry->pose.position_m);
    Line(of, "orientation", odometry->pose.orientation_xyzw);
    Line(of, "linear velocity (m per s)", odometry->linear_mps);
    Line(of, "angular velocity (rad per s)", odometry->angular_radps);
  } else if (const auto* range = std::get_if<RangeMeasurement>(&measured)) {
    Line({at, channel, range->frame}, "range (m)", {range->range_m});
  } else if (const auto* gnss = std::get_if<GnssMeasurement>(&measured)) {
    Line({at, channel, gnss->frame}, "east north up (m)", gnss->enu_m);
  } else if (const auto* magnetic = std::get_if<MagneticMeasurement>(&measured)) {
    Line({at, channel, magnetic->frame}, "magnetic field (T)", magnetic->field_t);
  } else if (const auto* pressure = std::get_if<PressureMeasurement>(&measured)) {
    Line({at, channel, pressure->frame}, "pressure (Pa)", {pressure->pressure_pa});
  } else if (const auto* contact = std::get_if<ContactMeasurement>(&measured)) {
    Line({at, channel, contact->frame}, "touches", {contact->is_touching ? 1.0 : 0.0});
  }
}

void MeasurementLog::Write(const std::string& channel, const std::vector<SensorField>& fields,
                           const Reading& reading) {
  if (!file_.is_open()) return;
  for (const BodyReading& body : reading.bodies) {
    WriteBody({reading.at, channel, body.name}, fields, body);
  }
  for (const JointReading& joint : reading.joints) {
    const Of of{reading.at, channel, joint.name};
    Line(of, "position", {joint.state.position});
    Line(of, "velocity", {joint.state.velocity});
    Line(of, "effort", {joint.state.effort});
  }
  WriteMeasured(reading.at, channel, reading.measured);
}

}  // namespace tcs
