#include "coordinator/world/scenario_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "coordinator/channel/forwarding_outlet.h"
#include "coordinator/world/reading_quantities.h"

namespace tcs {

namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// The place of `number` in the list; a number that is not there is added.
std::size_t PlaceIn(std::vector<int>* numbers, std::size_t number) {
  const auto found = std::ranges::find(*numbers, static_cast<int>(number));
  const auto place = static_cast<std::size_t>(found - numbers->begin());
  if (found == numbers->end()) numbers->push_back(static_cast<int>(number));
  return place;
}

// The angle about the x, y or z axis, in that order of turning about fixed axes (REP-103).
double AngleOf(std::size_t axis, const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  switch (axis) {
    case 0:
      return std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
    case 1:
      return std::asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0));
    default:
      return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  }
}

// The value of kMotionQuantities[part].
double MotionOf(std::size_t part, const std::array<double, 3>& position,
                const std::array<double, 4>& orientation, const std::array<double, 3>& linear,
                const std::array<double, 3>& angular) {
  const std::size_t axis = part % 3;
  switch (part / 3) {
    case 0:
      return position[axis];
    case 1:
      return linear[axis];
    case 2:
      return angular[axis];
    default:
      return AngleOf(axis, orientation);
  }
}

}  // namespace

class ScenarioMetrics::HeardOutlet final : public ForwardingOutlet {
 public:
  HeardOutlet(ScenarioMetrics& metrics, std::size_t sensor, std::unique_ptr<Outlet> outlet)
      : ForwardingOutlet(std::move(outlet)), metrics_(metrics), sensor_(sensor) {}

  bool Send(const Reading& reading, VirtualTime arrives) override {
    metrics_.Hear(sensor_, reading);
    return ForwardingOutlet::Send(reading, arrives);
  }

 private:
  ScenarioMetrics& metrics_;
  std::size_t sensor_;
  std::unique_ptr<Outlet> outlet_;
};

void ScenarioMetrics::Open(const Scenario& scenario) {
  scenario_ = &scenario;
  const auto add = [&](const MetricSpec& spec, std::string_view from) {
    const VirtualDuration every = spec.every > VirtualDuration{} ? spec.every : scenario.csv_period;
    // The first multiple of `every` that is not before `from`.
    const std::int64_t before = (spec.from.ns() + every.ns() - 1) / every.ns();
    const auto next = VirtualTime::FromNanoseconds(before * every.ns());
    metrics_.push_back({&spec, from, spec.expression.Needs(), every, next, next});
  };
  for (const MetricSpec& spec : scenario.metrics) add(spec, kMetricFromScenario);
  for (const MetricSpec& spec : scenario.kept) add(spec, kMetricFromExpectations);
  values_.resize(scenario.quantities.size(), kNotKnown);
  commanded_.resize(scenario.quantities.size());
  for (const QuantitySpec& quantity : scenario.quantities) {
    std::size_t place = 0;
    if (quantity.kind == QuantitySpec::Kind::kBody) place = PlaceIn(&bodies_, quantity.index);
    if (quantity.kind == QuantitySpec::Kind::kLink) place = PlaceIn(&links_, quantity.index);
    if (quantity.kind == QuantitySpec::Kind::kJoint) place = PlaceIn(&joints_, quantity.index);
    place_of_.push_back(place);
  }
  body_states_.resize(bodies_.size());
  link_states_.resize(links_.size());
  joint_states_.resize(joints_.size());
}

std::unique_ptr<Outlet> ScenarioMetrics::Wrap(std::size_t sensor, std::unique_ptr<Outlet> outlet) {
  const bool is_heard =
      std::ranges::any_of(scenario_->quantities, [sensor](const QuantitySpec& quantity) {
        return quantity.kind == QuantitySpec::Kind::kReading && quantity.index == sensor;
      });
  if (!is_heard) return outlet;
  return std::make_unique<HeardOutlet>(*this, sensor, std::move(outlet));
}

void ScenarioMetrics::WriteInto(MetricBook& book, CommandLog& commands) {
  book_ = &book;
  for (Metric& metric : metrics_) {
    metric.number = book.NumberOf(metric.from, metric.spec->name, metric.spec->asked);
  }
  std::erase_if(metrics_, [](const Metric& metric) { return metric.number < 0; });
  if (std::ranges::find(scenario_->quantities, QuantitySpec::Kind::kCommand, &QuantitySpec::kind) ==
      scenario_->quantities.end()) {
    return;
  }
  commands.Tell([this](CommandLog::Moment moment, std::string_view channel, std::string_view target,
                       std::string_view quantity,
                       double value) { HearCommand(moment, channel, target, quantity, value); });
}

VirtualTime ScenarioMetrics::NextStop() const {
  VirtualTime next = VirtualTime::Never();
  if (book_ == nullptr) return next;
  for (const Metric& metric : metrics_) next = std::min(next, metric.next);
  return next;
}

void ScenarioMetrics::Hear(std::size_t sensor, const Reading& reading) {
  const auto hear = [&](const ReadingQuantity& told) {
    for (std::size_t i = 0; i < scenario_->quantities.size(); ++i) {
      const QuantitySpec& quantity = scenario_->quantities[i];
      if (quantity.kind == QuantitySpec::Kind::kReading && quantity.index == sensor &&
          quantity.field == told.field && (quantity.of.empty() || quantity.of == told.of)) {
        values_[i] = told.values[quantity.part];
      }
    }
  };
  ForEachQuantity(reading, scenario_->sensors[sensor].fields, hear);
}

// The target is MODEL/JOINT, MODEL/ROTOR, or what a channel of one thing moves.
void ScenarioMetrics::HearCommand(CommandLog::Moment moment, std::string_view channel,
                                  std::string_view target, std::string_view quantity,
                                  double value) {
  const std::string_view of = target.substr(target.find('/') + 1);
  for (std::size_t i = 0; i < scenario_->quantities.size(); ++i) {
    const QuantitySpec& wanted = scenario_->quantities[i];
    if (wanted.kind == QuantitySpec::Kind::kCommand && wanted.field == quantity &&
        (wanted.of.empty() || wanted.of == of) &&
        scenario_->commands[wanted.index].name == channel) {
      std::deque<Commanded>& commanded = commanded_[i];
      // No value is taken any more for a time before this command was sent.
      while (commanded.size() > 1 && commanded[1].acts < moment.sent) commanded.pop_front();
      commanded.push_back({moment.sent + moment.latency, value});
    }
  }
}

void ScenarioMetrics::Read(Dynamics& dynamics) {
  const VirtualTime now = dynamics.Now();
  if (!bodies_.empty()) dynamics.Read(now, bodies_, body_states_);
  if (!links_.empty()) dynamics.ReadLinks(now, links_, link_states_);
  if (!joints_.empty()) dynamics.ReadJoints(now, joints_, joint_states_);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const QuantitySpec& quantity = scenario_->quantities[i];
    switch (quantity.kind) {
      case QuantitySpec::Kind::kBody: {
        const BodyState& s = body_states_[place_of_[i]];
        values_[i] = MotionOf(quantity.part, s.position_m, s.orientation_xyzw,
                              s.linear_velocity_mps, s.angular_velocity_radps);
        break;
      }
      case QuantitySpec::Kind::kLink: {
        const LinkState& s = link_states_[place_of_[i]];
        values_[i] = MotionOf(quantity.part, s.pose.position_m, s.pose.orientation_xyzw,
                              s.linear_velocity_mps, s.angular_velocity_radps);
        break;
      }
      case QuantitySpec::Kind::kJoint: {
        const JointState& s = joint_states_[place_of_[i]];
        values_[i] = std::array{s.position, s.velocity, s.effort}[quantity.part];
        break;
      }
      case QuantitySpec::Kind::kCommand:
        // A command for this instant may come in later.
        while (!commanded_[i].empty() && commanded_[i].front().acts < now) {
          values_[i] = commanded_[i].front().value;
          commanded_[i].pop_front();
        }
        break;
      case QuantitySpec::Kind::kReading:
        break;
    }
  }
}

void ScenarioMetrics::Evaluate(Dynamics& dynamics) {
  const VirtualTime now = dynamics.Now();
  if (NextStop() > now) return;
  Read(dynamics);
  for (Metric& metric : metrics_) {
    if (metric.next > now) continue;
    Take(metric, now);
    metric.next += metric.every;
    if (metric.spec->until && metric.next - VirtualTime{} > *metric.spec->until) {
      metric.next = VirtualTime::Never();
    }
  }
}

void ScenarioMetrics::Take(Metric& metric, VirtualTime now) {
  if (!std::ranges::all_of(metric.needs,
                           [this](std::size_t i) { return std::isfinite(values_[i]); }))
    return;
  const double value = metric.spec->expression.Evaluate(values_);
  if (!IsMetricValue(value)) return;
  if (metric.from == kMetricFromExpectations) {
    const bool is_within =
        value >= metric.spec->least.value_or(value) && value <= metric.spec->most.value_or(value);
    book_->Add(metric.number, now.ns(), value, false, !is_within);
    return;
  }
  const bool has_line = metric.next_line <= now;
  while (metric.next_line <= now) metric.next_line += scenario_->csv_period;
  const bool may_be_first = metric.spec->asked != MetricFigure::kFirstTimeWhen || value != 0;
  book_->Add(metric.number, now.ns(), value, has_line, may_be_first);
}

}  // namespace tcs
