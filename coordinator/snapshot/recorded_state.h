// The state of the world at one moment of a run, from the tables that it has written: numbers as
// they stand there, which is to the last bit.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/scenario/duration.h"

namespace tcs::snapshot {

struct RecordedState {
  std::int64_t at_ns = 0;
  // x, y, z; qx, qy, qz, qw; velocity; angular velocity: of bodies and links by name.
  std::map<std::string, std::vector<std::string>> bodies;
  // Position and velocity, of joints with one coordinate: MODEL/JOINT.
  std::map<std::string, std::vector<std::string>> joints;
};

// Of the run in `folder` at `at_ns`; none: the last that was written whole. What is wrong is one
// sentence; so is a time that the tables do not have, with those next to it.
[[nodiscard]] LoadResult<RecordedState> ReadState(const std::string& folder,
                                                  std::optional<std::int64_t> at_ns);

}  // namespace tcs::snapshot
