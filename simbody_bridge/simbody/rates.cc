#include "simbody_bridge/simbody/rates.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <numeric>

#include "simbody_bridge/masses.h"

namespace tcs {
namespace {

constexpr std::size_t kMostLog2 = 5;  // wider, and a row leaves the cache between two evaluations
// The cost of an evaluation, relative to the cost of each island in it.
constexpr std::size_t kCostOfRow = 3;

// The width of the next row for so many islands: a row may have idle slots, but not many of them.
std::size_t WidthLog2(std::size_t lanes) {
  const auto above = static_cast<std::size_t>(std::bit_width(lanes - 1));
  if (above > kMostLog2) return kMostLog2;
  const std::size_t width = std::size_t{1} << above;
  return above == 0 || 4 * lanes > 3 * width ? above : above - 1;
}

}  // namespace

SimbodyRates::SimbodyRates(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
    : world_(world), loads_(world, islands), islands_(islands) {
  std::map<Masses, std::size_t> known;
  for (const std::vector<int>& bodies : islands) {
    const auto [kind, is_new] = known.try_emplace(MassesOf(world, bodies), kinds_.size());
    if (is_new) {
      kinds_.emplace_back().bodies = bodies;
      kinds_.back().rows.resize(kMostLog2 + 1);
    }
    kind_of_.push_back(kind->second);
  }
  if (kinds_.size() > 1) whole_ = MakeRow(islands);
}

std::unique_ptr<SimbodyRates::Row> SimbodyRates::MakeRow(
    const std::vector<std::vector<int>>& islands) const {
  auto row = std::make_unique<Row>();
  std::vector<int> all;
  for (const std::vector<int>& bodies : islands) {
    row->first_body.push_back(all.size());
    all.insert(all.end(), bodies.begin(), bodies.end());
  }
  row->model = std::make_unique<SimbodyModel>(world_, all);
  row->state = row->model->blank_state();
  row->loads.resize(all.size());
  return row;
}

SimbodyRates::Row& SimbodyRates::RowOf(Kind& kind, std::size_t width_log2) {
  std::unique_ptr<Row>& row = kind.rows[width_log2];
  if (row == nullptr) {
    row = MakeRow(std::vector<std::vector<int>>(std::size_t{1} << width_log2, kind.bodies));
  }
  return *row;
}

void SimbodyRates::Evaluate(std::span<Lane> lanes) {
  std::stable_sort(lanes.begin(), lanes.end(),
                   [this](const Lane& a, const Lane& b) { return KindOf(a) < KindOf(b); });
  if (IsWholeCheaper(lanes)) {
    EvaluateWhole(lanes);
    return;
  }
  while (!lanes.empty()) {
    const std::size_t kind = KindOf(lanes.front());
    const auto other = std::find_if(lanes.begin(), lanes.end(),
                                    [&](const Lane& lane) { return KindOf(lane) != kind; });
    const auto count = static_cast<std::size_t>(other - lanes.begin());
    EvaluateKind(kinds_[kind], lanes.first(count));
    lanes = lanes.subspan(count);
  }
}

// Lanes are in the order of their kinds.
bool SimbodyRates::IsWholeCheaper(std::span<const Lane> lanes) {
  if (whole_ == nullptr) return false;
  std::size_t kinds = 0;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    if (i == 0 || KindOf(lanes[i]) != KindOf(lanes[i - 1])) ++kinds;
  }
  return kCostOfRow * kinds + lanes.size() > kCostOfRow + islands_.size();
}

void SimbodyRates::EvaluateWhole(std::span<const Lane> lanes) {
  slots_.clear();
  for (const Lane& lane : lanes) slots_.push_back(static_cast<std::size_t>(lane.step->island));
  if (EvaluateRow(*whole_, lanes, slots_)) return;
  for (const Lane& lane : lanes) EvaluateAlone(lane);
}

void SimbodyRates::EvaluateKind(Kind& kind, std::span<const Lane> lanes) {
  slots_.resize(std::size_t{1} << kMostLog2);
  std::iota(slots_.begin(), slots_.end(), 0);
  while (!lanes.empty()) {
    const std::size_t width_log2 = WidthLog2(lanes.size());
    const std::size_t count = std::min(lanes.size(), std::size_t{1} << width_log2);
    const std::span<const Lane> now = lanes.first(count);
    if (!EvaluateRow(RowOf(kind, width_log2), now, slots_)) {
      for (const Lane& lane : now) EvaluateAlone(lane);
    }
    lanes = lanes.subspan(count);
  }
}

// A state that has gone astray in one lane is no reason to fail the others.
void SimbodyRates::EvaluateAlone(const Lane& lane) {
  Kind& kind = kinds_[KindOf(lane)];
  if (EvaluateRow(RowOf(kind, 0), {&lane, 1}, {0})) return;
  std::fill_n(lane.rate, kFreeBodyNumbers * lane.step->wrenches.size(),
              std::numeric_limits<double>::quiet_NaN());
}

Load SimbodyRates::LoadIn(const Lane& lane, std::size_t place) const {
  const IslandStep& step = *lane.step;
  if (loads_.IsConstant(step, place)) return LoadOf(step.wrenches[place]);  // and not read the body
  const std::size_t bodies = step.wrenches.size();
  const BodyState body = ReadBody({lane.state, kFreeBodyNumbers * bodies}, static_cast<int>(bodies),
                                  static_cast<int>(place));
  return loads_.At(step, place, lane.after_s, body);
}

// Idle slots stay as they were. False if Simbody refuses one of the states.
bool SimbodyRates::EvaluateRow(Row& row, std::span<const Lane> lanes, const Slots& slots) {
  const auto all_bodies = static_cast<std::size_t>(row.model->body_count());
  const auto for_lanes = [&](const auto& each) {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const std::size_t first = row.first_body[slots[i]], bodies = lanes[i].step->wrenches.size();
      each(lanes[i], first, bodies, kFreeBodyCoordinates * first,
           kFreeBodyCoordinates * all_bodies + kFreeBodySpeeds * first);
    }
  };
  try {
    double* y = &row.state.updY()[0];
    for_lanes(
        [&](const Lane& lane, std::size_t first, std::size_t bodies, std::size_t q, std::size_t u) {
          const std::size_t coordinates = kFreeBodyCoordinates * bodies;
          std::copy_n(lane.state, coordinates, y + q);
          std::copy_n(lane.state + coordinates, kFreeBodySpeeds * bodies, y + u);
          for (std::size_t place = 0; place < bodies; ++place) {
            const Load load = LoadIn(lane, place);
            Load& set = row.loads[first + place];
            if (set == load) continue;
            set = load;
            row.model->SetLoad(row.state, static_cast<int>(first + place), set);
          }
        });
    row.model->system().realize(row.state, SimTK::Stage::Acceleration);
    const double* rate = row.state.getYDot().getContiguousScalarData();
    for_lanes([&](const Lane& lane, std::size_t /*first*/, std::size_t bodies, std::size_t q,
                  std::size_t u) {
      const std::size_t coordinates = kFreeBodyCoordinates * bodies;
      std::copy_n(rate + q, coordinates, lane.rate);
      std::copy_n(rate + u, kFreeBodySpeeds * bodies, lane.rate + coordinates);
    });
    return true;
  } catch (const std::exception&) {
    row.state = row.model->blank_state();
    std::fill(row.loads.begin(), row.loads.end(), Load{});
    return false;
  }
}

}  // namespace tcs
