#include "coordinator/world/instruments/instrument.h"
#include "coordinator/world/instruments/lidar.h"
#include "coordinator/world/instruments/on_link.h"

namespace tcs {
namespace {

struct Make {
  VirtualDuration period;
  const WorldSpec& world;

  std::unique_ptr<Instrument> operator()(const ImuSpec& spec) const {
    return std::make_unique<Imu>(spec, world.gravity_mps2);
  }
  std::unique_ptr<Instrument> operator()(const TruthSpec& spec) const {
    return std::make_unique<Truth>(spec);
  }
  std::unique_ptr<Instrument> operator()(const LidarSpec& spec) const {
    return std::make_unique<Lidar>(spec, period, world);
  }
};

}  // namespace

std::unique_ptr<Instrument> MakeInstrument(const InstrumentSpec& spec, VirtualDuration period,
                                           const WorldSpec& world) {
  return std::visit(Make{period, world}, spec);
}

}  // namespace tcs
