// The quantities that a reading tells, number by number. Measurements of hundreds of numbers are
// left out: scans, clouds, images.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

struct ReadingQuantity {
  std::string_view of;             // the body, the joint or the frame
  std::string_view field;          // as in the scenario and in JSON: "linear_velocity"
  std::string_view title;          // with its unit, for people: "linear velocity (m per s)"
  std::span<const double> values;  // the components: 1, 3 or 4
};

// `fields` are the quantities that a sensor of bodies tells of them. A quantity that is not known
// yet is left out.
void ForEachQuantity(const Reading& reading, const std::vector<SensorField>& fields,
                     const std::function<void(const ReadingQuantity&)>& tell);

}  // namespace tcs
