#include "coordinator/world/reading_quantities.h"

#include <array>
#include <variant>

namespace tcs {

namespace {

using Tell = std::function<void(const ReadingQuantity&)>;

void TellOfBody(const std::vector<SensorField>& fields, const BodyReading& body, const Tell& tell) {
  for (const SensorField field : fields) {
    switch (field) {
      case SensorField::kPosition:
        tell({body.name, "position", "position (m)", body.state.position_m});
        break;
      case SensorField::kOrientation:
        tell({body.name, "orientation", "orientation", body.state.orientation_xyzw});
        break;
      case SensorField::kLinearVelocity:
        tell({body.name, "linear_velocity", "linear velocity (m per s)",
              body.state.linear_velocity_mps});
        break;
      case SensorField::kAngularVelocity:
        tell({body.name, "angular_velocity", "angular velocity (rad per s)",
              body.state.angular_velocity_radps});
        break;
      case SensorField::kAngularRate:
        tell({body.name, "angular_rate", "angular rate (rad per s)", body.felt.angular_rate_radps});
        break;
      case SensorField::kProperAcceleration:
        if (const auto& felt = body.felt.proper_acceleration_mps2) {
          tell({body.name, "proper_acceleration", "proper acceleration (m per s2)", *felt});
        }
        break;
      case SensorField::kCount:
        break;
    }
  }
}

void TellOfMeasured(const Measurement& measured, const Tell& tell) {
  const auto one = [&](std::string_view of, std::string_view field, std::string_view title,
                       double value) {
    tell({of, field, title, {&value, 1}});
  };
  if (const auto* imu = std::get_if<ImuMeasurement>(&measured)) {
    tell({imu->frame, "orientation", "orientation", imu->orientation_xyzw});
    tell({imu->frame, "angular_rate", "angular rate (rad per s)", imu->felt.angular_rate_radps});
    if (const auto& felt = imu->felt.proper_acceleration_mps2) {
      tell({imu->frame, "proper_acceleration", "proper acceleration (m per s2)", *felt});
    }
  } else if (const auto* odometry = std::get_if<OdometryMeasurement>(&measured)) {
    const std::string_view of = odometry->child_frame;
    tell({of, "position", "position (m)", odometry->pose.position_m});
    tell({of, "orientation", "orientation", odometry->pose.orientation_xyzw});
    tell({of, "linear_velocity", "linear velocity (m per s)", odometry->linear_mps});
    tell({of, "angular_velocity", "angular velocity (rad per s)", odometry->angular_radps});
  } else if (const auto* range = std::get_if<RangeMeasurement>(&measured)) {
    one(range->frame, "range", "range (m)", range->range_m);
  } else if (const auto* gnss = std::get_if<GnssMeasurement>(&measured)) {
    tell({gnss->frame, "east_north_up", "east north up (m)", gnss->enu_m});
  } else if (const auto* magnetic = std::get_if<MagneticMeasurement>(&measured)) {
    tell({magnetic->frame, "magnetic_field", "magnetic field (T)", magnetic->field_t});
  } else if (const auto* pressure = std::get_if<PressureMeasurement>(&measured)) {
    one(pressure->frame, "pressure", "pressure (Pa)", pressure->pressure_pa);
  } else if (const auto* contact = std::get_if<ContactMeasurement>(&measured)) {
    one(contact->frame, "touches", "touches", contact->is_touching ? 1.0 : 0.0);
  }
}

}  // namespace

void ForEachQuantity(const Reading& reading, const std::vector<SensorField>& fields,
                     const Tell& tell) {
  for (const BodyReading& body : reading.bodies) TellOfBody(fields, body, tell);
  for (const JointReading& joint : reading.joints) {
    const std::array<double, 3> of = {joint.state.position, joint.state.velocity,
                                      joint.state.effort};
    for (std::size_t i = 0; i < of.size(); ++i) {
      tell({joint.name, kJointQuantities[i], kJointQuantities[i], {&of[i], 1}});
    }
  }
  TellOfMeasured(reading.measured, tell);
}

}  // namespace tcs
