// The middle loop, 250 times a second: turns the quadrotor so that its thrust points where it is
// wanted.
//
//   attitude_loop NAME
//   in   NAME/attitude_imu  {"orientation": [x, y, z, w]}
//        NAME/thrust        {"thrust": [x, y, z], "yaw": rad}     what is wanted, N in the world
//   out  NAME/rates         {"rates": [x, y, z], "thrust": N}
#include <algorithm>
#include <string>

#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"
#include "examples/quadrotor/airframe.h"
#include "examples/quadrotor/vectors.h"

namespace quadrotor {
using examples::Socket;
using examples::Ticks;

namespace {

const Vector3d kGain{8, 8, 3};      // 1/s
const Vector3d kMostRate{6, 6, 2};  // rad/s

// The attitude whose z points along the thrust, with that yaw.
Quaterniond AttitudeFor(const Vector3d& thrust_n, double yaw_rad) {
  const Quaterniond tilt = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), thrust_n);
  return tilt * Quaterniond(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()));
}

void Run(const std::string& name) {
  Socket imu(name + "/attitude_imu"), wanted(name + "/thrust");
  Quaterniond attitude = Quaterniond::Identity();
  Vector3d thrust_n = Vector3d::Zero();
  double yaw_rad = 0;
  Ticks ticks(250);
  for (;;) {
    ticks.WaitForNext();
    if (const auto reading = imu.ReceiveNewest()) {
      attitude = QuaternionOf(reading->at("orientation"));
    }
    if (const auto command = wanted.ReceiveNewest()) {
      thrust_n = VectorOf(command->at("thrust"));
      yaw_rad = command->at("yaw").get<double>();
    }
    if (thrust_n.isZero()) continue;
    Quaterniond error = attitude.conjugate() * AttitudeFor(thrust_n, yaw_rad);
    if (error.w() < 0) error.coeffs() *= -1;  // the short way round
    const Vector3d rates = 2 * kGain.cwiseProduct(error.vec());
    // What of the thrust points where the quadrotor points by now.
    const double along_n =
        std::clamp(thrust_n.dot(attitude * Vector3d::UnitZ()), 0.0, kMostThrustN);
    imu.Send(name + "/rates",
             {{"rates", JsonOf(Vector3d(rates.cwiseMax(-kMostRate).cwiseMin(kMostRate)))},
              {"thrust", along_n}});
  }
}

}  // namespace
}  // namespace quadrotor

int main(int argc, char** argv) { quadrotor::Run(argc > 1 ? argv[1] : "drone"); }
