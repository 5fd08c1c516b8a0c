// What several tests encode.
#pragma once

#include <cstdint>

#include "simbody_bridge/dynamics.h"

namespace tcs::dds {

inline constexpr std::int64_t kStamp = 1'700'000'000'250'000'000;

inline BodyState Flying() { return {{1, 2, 3}, {0, 0, 0.6, 0.8}, {4, 5, 6}, {7, 8, 9}}; }

}  // namespace tcs::dds
