#include "simbody_bridge/model_loads.h"

#include <cmath>
#include <cstddef>

#include "simbody_bridge/lag.h"
#include "simbody_bridge/model/vectors.h"
#include "simbody_bridge/model_engine.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

// The drag of a rotor that turns counter-clockwise turns its link clockwise.
Load LoadOfSquare(const Rotor& rotor) {
  const double drag = rotor.is_clockwise ? rotor.drag_nms2 : -rotor.drag_nms2;
  const auto& q = rotor.frame.orientation_xyzw;
  const Vector force = Rotate(q, {0, 0, rotor.thrust_ns2});
  Load load{force, Cross(rotor.frame.position_m, force)};
  AddTo(&load, {{}, Rotate(q, {0, 0, drag})}, 1);
  return load;
}

Load NumbersOf(const Wrench& command, const Remainder& remainder, double share) {
  Load numbers;
  if (share == 0) {
    AddTo(&numbers, LoadOf(command), 1);
    return numbers;
  }
  AddTo(&numbers, LoadOf(command), 1 - share);
  AddTo(&numbers, remainder.in_world, share);
  return numbers;
}

}  // namespace

ModelLoads::ModelLoads(std::span<const RobotModel> all, std::span<const int> models) {
  int links = 0, joints = 0, first_link = 0, number = 0;
  for (const int index : models) {
    const RobotModel& model = all[static_cast<std::size_t>(index)];
    links += static_cast<int>(model.links.size());
    joints += static_cast<int>(model.joints.size());
  }
  for (const int index : models) {
    const RobotModel& model = all[static_cast<std::size_t>(index)];
    for (const Rotor& rotor : model.rotors) {
      const int of_link = PlaceOfLink(first_link + rotor.link, WrenchFrame::kLink);
      rotors_.push_back({static_cast<std::size_t>(PlaceOfRotor(links, joints, number++)),
                         static_cast<std::size_t>(of_link), LoadOfSquare(rotor)});
    }
    first_link += static_cast<int>(model.links.size());
  }
}

std::span<const Wrench> ModelLoads::At(const IslandStep& step, double after_s) {
  return Sum(step.wrenches, step.remainders,
             [&](const Wrench& command, const Remainder& remainder) {
               const double share =
                   ShareLeftAfter(command, ShareLeft(command, remainder, step.at), after_s);
               return Left{share, share * share};
             });
}

std::span<const Wrench> ModelLoads::At(const Acting& acting) {
  return Sum(acting.wrenches, acting.remainders,
             [&](const Wrench& command, const Remainder& remainder) {
               const double share = ShareLeft(command, remainder, acting.at);
               return Left{share, share * share};
             });
}

// The square of the share fades twice as fast.
std::span<const Wrench> ModelLoads::MeanOver(const IslandStep& step, double seconds) {
  return Sum(step.wrenches, step.remainders,
             [&](const Wrench& command, const Remainder& remainder) {
               const double share = ShareLeft(command, remainder, step.at);
               if (!(share > 0)) return Left{0, 0};
               const double lags = seconds / command.lag.seconds();
               return Left{share * -std::expm1(-lags) / lags,
                           share * share * -std::expm1(-2 * lags) / (2 * lags)};
             });
}

// Commands that lag together are left to the same share: a robot's rotors have one time constant,
// and are commanded at once.
template <class LeftOf>
class ModelLoads::Lefts {
 public:
  explicit Lefts(const LeftOf& left_of) : left_of_(left_of) {}

  const Left& Of(const Wrench& command, const Remainder& remainder) {
    if (remainder.since != since_ || command.lag != lag_) {
      since_ = remainder.since;
      lag_ = command.lag;
      left_ = left_of_(command, remainder);
    }
    return left_;
  }

 private:
  const LeftOf& left_of_;
  VirtualTime since_ = VirtualTime::Never();
  VirtualDuration lag_{};
  Left left_{};  // 0 for commands that never lagged
};

template <class LeftOf>
std::span<const Wrench> ModelLoads::Sum(const std::vector<Wrench>& commanded,
                                        const std::vector<Remainder>& remainders,
                                        const LeftOf& left_of) {
  if (remainders.empty() && rotors_.empty()) return commanded;
  acting_ = commanded;
  Lefts<LeftOf> lefts(left_of);
  for (std::size_t place = 0; place < remainders.size(); ++place) {
    const Left& left = lefts.Of(commanded[place], remainders[place]);
    const Load numbers = NumbersOf(commanded[place], remainders[place], left.share);
    acting_[place].force_n = numbers.force_n;
    acting_[place].torque_nm = numbers.torque_nm;
  }
  for (const SpinningRotor& rotor : rotors_) {
    const double aim = commanded[rotor.place].force_n[0];
    double square = aim * aim;
    if (!remainders.empty()) {
      const Left& left = lefts.Of(commanded[rotor.place], remainders[rotor.place]);
      const double missing = remainders[rotor.place].in_world.force_n[0] - aim;
      square += 2 * aim * missing * left.share + missing * missing * left.square_of_share;
    }
    Wrench& on_link = acting_[rotor.place_of_link];
    Load load = LoadOf(on_link);
    AddTo(&load, rotor.of_square, square);
    on_link.force_n = load.force_n;
    on_link.torque_nm = load.torque_nm;
  }
  return acting_;
}

}  // namespace tcs
