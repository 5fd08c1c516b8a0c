#include "simbody_bridge/mujoco/runge_kutta4.h"

#include <algorithm>
#include <cstddef>

namespace tcs {
namespace {

constexpr double kOn[3][3] = {{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 1}};
constexpr double kCounts[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};

}  // namespace

void RungeKutta4::Step(const mjModel& model, mjData* data, const Find& find) {
  const int count = model.nv;
  const double seconds = model.opt.timestep;
  const auto add = [&](const double* shares, std::size_t stages) {
    moves_.assign(static_cast<std::size_t>(count), 0);
    gains_.assign(static_cast<std::size_t>(count), 0);
    for (std::size_t i = 0; i < stages; ++i) {
      mju_addToScl(moves_.data(), speeds_[i].data(), shares[i], count);
      mju_addToScl(gains_.data(), rates_[i].data(), shares[i], count);
    }
  };
  start_.assign(data->qpos, data->qpos + model.nq);
  speeds_[0].assign(data->qvel, data->qvel + count);
  rates_[0].assign(data->qacc, data->qacc + count);
  for (std::size_t stage = 1; stage < kStages; ++stage) {
    add(kOn[stage - 1], stage);
    positions_ = start_;
    mj_integratePos(&model, positions_.data(), moves_.data(), seconds);
    speeds_[stage] = speeds_[0];
    mju_addToScl(speeds_[stage].data(), gains_.data(), seconds, count);
    std::ranges::copy(speeds_[stage], data->qvel);
    find(positions_.data());
    rates_[stage].assign(data->qacc, data->qacc + count);
  }
  add(kCounts, kStages);
  std::ranges::copy(start_, data->qpos);
  std::ranges::copy(speeds_[0], data->qvel);
  mju_addToScl(data->qvel, gains_.data(), seconds, count);
  mj_integratePos(&model, data->qpos, moves_.data(), seconds);
}

}  // namespace tcs
