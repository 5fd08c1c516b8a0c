#include "simbody_bridge/simbody/lanes.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace tcs {
namespace {

constexpr std::size_t kMostLog2 = 5;  // wider, and a row leaves the cache between two evaluations

// The width of the next row for so many islands: a row may have idle lanes, but not many of them.
std::size_t WidthLog2(std::size_t lanes) {
  const auto above = static_cast<std::size_t>(std::bit_width(lanes - 1));
  if (above > kMostLog2) return kMostLog2;
  const std::size_t width = std::size_t{1} << above;
  return above == 0 || 4 * lanes > 3 * width ? above : above - 1;
}

}  // namespace

SimbodyLanes::SimbodyLanes(const WorldSpec& world, const std::vector<int>& bodies)
    : rows_(kMostLog2 + 1) {
  island_.gravity_mps2 = world.gravity_mps2;
  island_.has_region = world.has_region;
  island_.region = world.region;
  for (const int body : bodies) {
    bodies_.push_back(static_cast<int>(bodies_.size()));
    island_.bodies.push_back(world.bodies[static_cast<std::size_t>(body)]);
  }
  RowOf(0);
}

std::size_t SimbodyLanes::state_size() const { return bodies_.size() * kFreeBodyNumbers; }

SimbodyLanes::Row& SimbodyLanes::RowOf(std::size_t width_log2) {
  std::unique_ptr<Row>& row = rows_[width_log2];
  if (row == nullptr) {
    row = std::make_unique<Row>();
    std::vector<int> all;
    for (std::size_t i = 0; i < std::size_t{1} << width_log2; ++i) {
      all.insert(all.end(), bodies_.begin(), bodies_.end());
    }
    row->model = std::make_unique<SimbodyModel>(island_, all);
    row->state = row->model->blank_state();
    row->wrenches.resize(all.size());
  }
  return *row;
}

void SimbodyLanes::Evaluate(std::span<const Lane> lanes) {
  while (!lanes.empty()) {
    const std::size_t width_log2 = WidthLog2(lanes.size());
    const std::size_t count = std::min(lanes.size(), std::size_t{1} << width_log2);
    EvaluateRow(RowOf(width_log2), lanes.first(count));
    lanes = lanes.subspan(count);
  }
}

// Idle lanes stay as they were.
void SimbodyLanes::EvaluateRow(Row& row, std::span<const Lane> lanes) {
  const std::size_t bodies = bodies_.size();
  const std::size_t coordinates = bodies * kFreeBodyCoordinates, speeds = bodies * kFreeBodySpeeds;
  const std::size_t first_speed =
      static_cast<std::size_t>(row.model->body_count()) * kFreeBodyCoordinates;
  try {
    double* y = &row.state.updY()[0];
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const Lane& lane = lanes[i];
      std::copy_n(lane.state, coordinates, y + i * coordinates);
      std::copy_n(lane.state + coordinates, speeds, y + first_speed + i * speeds);
      for (std::size_t place = 0; place < bodies; ++place) {
        Wrench& set = row.wrenches[i * bodies + place];
        if (set == lane.wrenches[place]) continue;
        set = lane.wrenches[place];
        row.model->SetWrench(row.state, static_cast<int>(i * bodies + place), set);
      }
    }
    row.model->system().realize(row.state, SimTK::Stage::Acceleration);
    const double* rate = row.state.getYDot().getContiguousScalarData();
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      std::copy_n(rate + i * coordinates, coordinates, lanes[i].rate);
      std::copy_n(rate + first_speed + i * speeds, speeds, lanes[i].rate + coordinates);
    }
  } catch (const std::exception&) {
    // A state that has gone astray in one lane is no reason to fail the others, now or later.
    row.state = row.model->blank_state();
    std::fill(row.wrenches.begin(), row.wrenches.end(), Wrench{});
    if (lanes.size() > 1) {
      for (std::size_t i = 0; i < lanes.size(); ++i) EvaluateRow(RowOf(0), lanes.subspan(i, 1));
      return;
    }
    std::fill_n(lanes[0].rate, state_size(), std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace tcs
