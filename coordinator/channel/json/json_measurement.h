// Measurements of robots' sensors, as JSON (docs/SCENARIO.md).
#pragma once

#include <string>

#include "coordinator/channel/channel.h"

namespace tcs {

// {"time":1.23,"frame_id":"imu_link",...}, no line end. `reading` has a measurement. Numbers as in
// json_codec.h.
[[nodiscard]] std::string EncodeMeasurement(const Reading& reading);

}  // namespace tcs
