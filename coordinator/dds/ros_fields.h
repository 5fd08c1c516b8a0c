// The fields that most messages have in them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "coordinator/dds/ros_types.h"

namespace tcs::dds {

[[nodiscard]] inline TimeMessage ToTime(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return {static_cast<std::int32_t>(stamp_ns / kSecond_ns),
          static_cast<std::uint32_t>(stamp_ns % kSecond_ns)};
}

inline Vector3Message ToVector3(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

inline QuaternionMessage ToQuaternion(const std::array<double, 4>& q) {
  return {q[0], q[1], q[2], q[3]};
}

// A covariance of three numbers, or of six, the last three of which are of turns. The numbers are
// independent.
inline void SetDiagonal(double (&covariance)[9], double variance) {
  for (int i = 0; i < 3; ++i) covariance[4 * i] = variance;
}
inline void SetDiagonal(double (&covariance)[36], double variance, double of_turns) {
  for (int i = 0; i < 6; ++i) covariance[7 * i] = i < 3 ? variance : of_turns;
}

inline void SetHeader(HeaderMessage* header, std::int64_t stamp_ns, std::string_view frame) {
  header->stamp = ToTime(stamp_ns);
  SetText(&header->frame_id, frame);
}

}  // namespace tcs::dds
