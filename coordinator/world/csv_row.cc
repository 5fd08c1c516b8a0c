#include "coordinator/world/csv_row.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

namespace tcs {

CsvTime::CsvTime(VirtualTime at) {
  const auto end =
      fmt::format_to_n(text_, sizeof text_, "{:.9f}", static_cast<double>(at.ns()) * 1e-9).out;
  size_ = static_cast<std::size_t>(end - text_);
}

void AppendBodiesCsvRow(VirtualTime at, std::string_view name,
                        const std::array<double, 3>& position_m,
                        const std::array<double, 4>& orientation_xyzw,
                        const std::array<double, 3>& linear_velocity_mps,
                        const std::array<double, 3>& angular_velocity_radps, std::string* text) {
  fmt::format_to(std::back_inserter(*text), "{:.9f},{},{},{},{},{}\n",
                 static_cast<double>(at.ns()) * 1e-9, name, fmt::join(position_m, ","),
                 fmt::join(orientation_xyzw, ","), fmt::join(linear_velocity_mps, ","),
                 fmt::join(angular_velocity_radps, ","));
}

}  // namespace tcs
