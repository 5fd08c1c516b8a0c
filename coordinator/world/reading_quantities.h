// What a reading tells, number by number. Not what is of hundreds of numbers: scans, clouds,
// images.
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
  std::span<const double> values;  // its components: 1, 3 or 4
};

// What a sensor of bodies tells of them is in `fields`. What is not known yet is left out.
void ForEachQuantity(const Reading& reading, const std::vector<SensorField>& fields,
                     const std::function<void(const ReadingQuantity&)>& tell);

}  // namespace tcs
