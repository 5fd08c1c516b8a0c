// The innermost loop, 1000 times a second: turns the quadrotor as fast as it is told, by its four
// rotors.
//
//   rate_loop NAME [HZ]
//   in   NAME/imu     {"angular_rate": [x, y, z]}                  of the gyroscope, rad/s
//        NAME/rates   {"rates": [x, y, z], "thrust": N}            what is wanted
//   out  NAME/motors  {"front_left": rad/s, ...}
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"
#include "examples/quadrotor/airframe.h"
#include "examples/quadrotor/vectors.h"

namespace quadrotor {
using examples::Json;
using examples::Socket;
using examples::Ticks;

namespace {

const Vector3d kGain{25, 25, 8};          // 1/s
const Vector3d kIntegralGain{40, 40, 8};  // 1/s^2
const Vector3d kMostIntegral{10, 10, 4};  // rad/s^2

// The speeds at which the rotors give that thrust and torque together, as far as they can.
Json Mix(double thrust_n, const Vector3d& torque_nm) {
  Json speeds;
  for (const RotorPlace& rotor : kRotors) {
    const double force_n = thrust_n / 4 + torque_nm.x() / (4 * rotor.y_m) -
                           torque_nm.y() / (4 * rotor.x_m) +
                           torque_nm.z() * rotor.yaw * kThrustNs2 / (4 * kDragNms2);
    const double speed_radps = std::sqrt(std::max(0.0, force_n) / kThrustNs2);
    speeds[rotor.name] = std::min(speed_radps, kMostRadps);
  }
  return speeds;
}

void Run(const std::string& name, double hz) {
  Socket imu(name + "/imu"), wanted(name + "/rates");
  Vector3d rate = Vector3d::Zero(), wanted_rate = Vector3d::Zero(), integral = Vector3d::Zero();
  double thrust_n = 0;
  Ticks ticks(hz);
  for (;;) {
    const double seconds = ticks.WaitForNext();
    if (const auto reading = imu.ReceiveNewest()) rate = VectorOf(reading->at("angular_rate"));
    if (const auto command = wanted.ReceiveNewest()) {
      wanted_rate = VectorOf(command->at("rates"));
      thrust_n = command->at("thrust").get<double>();
    }
    const Vector3d error = wanted_rate - rate;
    integral += seconds * kIntegralGain.cwiseProduct(error);
    integral = integral.cwiseMax(-kMostIntegral).cwiseMin(kMostIntegral);
    if (thrust_n == 0) integral.setZero();                       // on the ground
    const Vector3d turn = kGain.cwiseProduct(error) + integral;  // rad/s^2
    imu.Send(name + "/motors", Mix(thrust_n, kInertiaKgm2.cwiseProduct(turn)));
  }
}

}  // namespace
}  // namespace quadrotor

int main(int argc, char** argv) {
  quadrotor::Run(argc > 1 ? argv[1] : "drone", argc > 2 ? std::atof(argv[2]) : 1000);
}
