// The metrics that a scenario names, as it describes them: plain values, already checked.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/metrics/expression.h"
#include "coordinator/metrics/metric_figures.h"
#include "shm/virtual_time.h"

namespace tcs {

// The quantities of how a body or a link moves, in the world's frame; SI units.
inline constexpr std::array<std::string_view, 12> kMotionQuantities = {
    "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "roll", "pitch", "yaw"};

// A number of the world, or of what goes over a channel.
struct QuantitySpec {
  enum class Kind { kBody, kLink, kJoint, kReading, kCommand };
  Kind kind = Kind::kBody;
  // The index of the body, link or joint, as Dynamics numbers them; of the sensor or the channel of
  // commands, in the scenario's lists.
  std::size_t index = 0;
  // The index in kMotionQuantities or kJointQuantities; of a reading, the component.
  std::size_t part = 0;
  // For a reading and a command: the thing that the quantity is of (a body, a joint, a rotor;
  // empty: there is but one such thing), and the field.
  std::string of{}, field{};
};

struct MetricSpec {
  std::string name;
  MetricFigure asked = MetricFigure::kLast;
  Expression expression;  // of Scenario::quantities; a condition if a condition is asked for
  VirtualDuration from{};
  std::optional<VirtualDuration> until{};  // `from` and `until` are included
  VirtualDuration every{};                 // 0: Scenario::csv_period
  // For an expectation: the bounds between which the value is to stay. The first time is that of
  // the first value outside the bounds.
  std::optional<double> least{}, most{};
};

}  // namespace tcs
