#include "coordinator/world/measurement_noise.h"

#include <cmath>
#include <cstddef>
#include <span>

#include "shm/random_stream.h"
#include "simbody_bridge/link_motion.h"

namespace tcs {
namespace {

// Each field has a stream of its own: a noise that is added to one field leaves the others as they
// were.
RandomStream StreamOf(std::uint64_t seed, RandomPurpose purpose, std::size_t field,
                      std::uint64_t sample) {
  return {seed ^ 0xd1342543de82ef95 * (field + 1), purpose, sample};
}

}  // namespace

// The errors of one sample.
class MeasurementNoise::Draws {
 public:
  Draws(const MeasurementNoise& noise, std::uint64_t sample) : noise_(noise), sample_(sample) {}

  void operator()(std::monostate&) const {}
  void operator()(ImuMeasurement& imu) const {
    Turn(MeasuredField::kOrientation, &imu.orientation_xyzw);
    Add(MeasuredField::kAngularRate, &imu.felt.angular_rate_radps);
    if (imu.felt.proper_acceleration_mps2.has_value()) {
      Add(MeasuredField::kProperAcceleration, &*imu.felt.proper_acceleration_mps2);
    }
    imu.orientation_variance = VarianceOf(MeasuredField::kOrientation);
    imu.rate_variance = VarianceOf(MeasuredField::kAngularRate);
    imu.acceleration_variance = VarianceOf(MeasuredField::kProperAcceleration);
  }
  void operator()(OdometryMeasurement& odometry) const {
    Add(MeasuredField::kPosition, &odometry.pose.position_m);
    Turn(MeasuredField::kOrientation, &odometry.pose.orientation_xyzw);
    Add(MeasuredField::kLinearVelocity, &odometry.linear_mps);
    Add(MeasuredField::kAngularVelocity, &odometry.angular_radps);
    odometry.position_variance = VarianceOf(MeasuredField::kPosition);
    odometry.orientation_variance = VarianceOf(MeasuredField::kOrientation);
    odometry.linear_variance = VarianceOf(MeasuredField::kLinearVelocity);
    odometry.angular_variance = VarianceOf(MeasuredField::kAngularVelocity);
  }
  void operator()(TransformsMeasurement&) const {}
  void operator()(DescriptionMeasurement&) const {}
  void operator()(ContactMeasurement&) const {}
  void operator()(ScanMeasurement& scan) const { Add(MeasuredField::kRange, scan.ranges_m); }
  void operator()(CloudMeasurement& cloud) const {
    Numbers numbers(*this, MeasuredField::kRange);
    for (CloudMeasurement::Point& point : cloud.points) numbers.Add(&point.range_m);
  }
  void operator()(RangeMeasurement& range) const {
    Add(MeasuredField::kRange, std::span(&range.range_m, 1));
    range.range_variance = VarianceOf(MeasuredField::kRange);
  }
  void operator()(DepthMeasurement& depth) const { Add(MeasuredField::kRange, depth.depths_m); }
  void operator()(GnssMeasurement& gnss) const {
    Add(MeasuredField::kPosition, &gnss.enu_m);
    gnss.position_variance = VarianceOf(MeasuredField::kPosition);
  }
  void operator()(MagneticMeasurement& magnetic) const {
    Add(MeasuredField::kMagneticField, &magnetic.field_t);
    magnetic.field_variance = VarianceOf(MeasuredField::kMagneticField);
  }
  void operator()(PressureMeasurement& pressure) const {
    Add(MeasuredField::kPressure, std::span(&pressure.pressure_pa, 1));
    pressure.pressure_variance = VarianceOf(MeasuredField::kPressure);
  }

 private:
  double VarianceOf(MeasuredField field) const {
    return noise_.errors_[static_cast<std::size_t>(field)].Variance();
  }
  std::array<double, 3> ErrorOf(MeasuredField field) const {
    const auto index = static_cast<std::size_t>(field);
    RandomStream random = StreamOf(noise_.seed_, RandomPurpose::kNoise, index, sample_);
    std::array<double, 3> error = noise_.biases_[index];
    for (double& axis : error) axis += noise_.errors_[index].noise * random.Normal();
    return error;
  }
  void Add(MeasuredField field, std::array<double, 3>* vector) const {
    const std::array<double, 3> error = ErrorOf(field);
    for (std::size_t i = 0; i < 3; ++i) (*vector)[i] += error[i];
  }
  void Turn(MeasuredField field, std::array<double, 4>* orientation) const {
    *orientation = Turned(*orientation, ErrorOf(field));
  }
  // Adds errors to many numbers of one field. Only finite numbers get an error, but every number
  // has a place in the stream.
  class Numbers {
   public:
    Numbers(const Draws& draws, MeasuredField field)
        : bias_(draws.noise_.biases_[static_cast<std::size_t>(field)][0]),
          noise_(draws.noise_.errors_[static_cast<std::size_t>(field)].noise),
          random_(StreamOf(draws.noise_.seed_, RandomPurpose::kNoise,
                           static_cast<std::size_t>(field), draws.sample_)) {}
    void Add(double* number) {
      const double error = bias_ + noise_ * random_.Normal();
      if (std::isfinite(*number)) *number += error;
    }

   private:
    double bias_, noise_;
    RandomStream random_;
  };
  void Add(MeasuredField field, std::span<double> all) const {
    Numbers numbers(*this, field);
    for (double& number : all) numbers.Add(&number);
  }

  const MeasurementNoise& noise_;
  std::uint64_t sample_;
};

MeasurementNoise::MeasurementNoise(const MeasurementErrors& errors, std::uint64_t seed)
    : errors_(errors), seed_(seed) {
  for (std::size_t i = 0; i < kMeasuredFields; ++i) {
    const FieldError& field = errors_[i];
    is_exact_ &= field.IsExact();
    RandomStream random = StreamOf(seed, RandomPurpose::kBias, i, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      biases_[i][axis] = field.bias[axis] + field.bias_deviation * random.Normal();
    }
  }
}

void MeasurementNoise::Disturb(std::uint64_t sample, Measurement* measurement) const {
  if (!is_exact_) std::visit(Draws(*this, sample), *measurement);
}

}  // namespace tcs
