// A line of bodies.csv, and the times of all tables of the world.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "shm/virtual_time.h"

namespace tcs {

inline constexpr std::string_view kBodiesCsvHead =
    "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps\n";

// A time in seconds, as all these tables have it.
class CsvTime {
 public:
  explicit CsvTime(VirtualTime at);
  std::string_view text() const { return {text_, size_}; }

 private:
  char text_[32];
  std::size_t size_;
};

void AppendBodiesCsvRow(VirtualTime at, std::string_view name,
                        const std::array<double, 3>& position_m,
                        const std::array<double, 4>& orientation_xyzw,
                        const std::array<double, 3>& linear_velocity_mps,
                        const std::array<double, 3>& angular_velocity_radps, std::string* text);

}  // namespace tcs
