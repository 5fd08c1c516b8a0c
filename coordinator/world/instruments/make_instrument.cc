#include "coordinator/world/instruments/bumper.h"
#include "coordinator/world/instruments/instrument.h"
#include "coordinator/world/instruments/lidar.h"
#include "coordinator/world/instruments/on_link.h"
#include "coordinator/world/instruments/snapshots.h"
#include "coordinator/world/instruments/transforms.h"
#include "coordinator/world/instruments/wheel_odometry.h"

namespace tcs {
namespace {

struct Make {
  using Made = std::unique_ptr<Instrument>;
  VirtualDuration period;
  const WorldSpec& world;

  Made operator()(const ImuSpec& spec) const {
    return std::make_unique<Imu>(spec, world.gravity_mps2);
  }
  Made operator()(const TruthSpec& spec) const { return std::make_unique<Truth>(spec); }
  Made operator()(const WheelOdometrySpec& spec) const {
    return std::make_unique<WheelOdometry>(spec);
  }
  Made operator()(const TransformsSpec& spec) const { return std::make_unique<Transforms>(spec); }
  Made operator()(const FixedTransformsSpec& spec) const {
    return std::make_unique<Transforms>(spec.transforms);
  }
  Made operator()(const DescriptionSpec& spec) const { return std::make_unique<Description>(spec); }
  Made operator()(const LidarSpec& spec) const {
    return std::make_unique<Lidar>(spec, period, world);
  }
  Made operator()(const Lidar3dSpec& spec) const { return std::make_unique<Lidar3d>(spec, world); }
  Made operator()(const RangeSpec& spec) const {
    return std::make_unique<RangeFinder>(spec, world);
  }
  Made operator()(const DepthCameraSpec& spec) const {
    return std::make_unique<DepthCamera>(spec, world);
  }
  Made operator()(const GnssSpec& spec) const { return std::make_unique<Gnss>(spec); }
  Made operator()(const MagnetometerSpec& spec) const {
    return std::make_unique<Magnetometer>(spec);
  }
  Made operator()(const ContactSpec& spec) const { return std::make_unique<Bumper>(spec, world); }
  Made operator()(const BarometerSpec& spec) const { return std::make_unique<Barometer>(spec); }
};

}  // namespace

std::unique_ptr<Instrument> MakeInstrument(const InstrumentSpec& spec, VirtualDuration period,
                                           const WorldSpec& world) {
  return std::visit(Make{period, world}, spec);
}

}  // namespace tcs
