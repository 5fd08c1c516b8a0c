#include "coordinator/world/csv_row.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <span>

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
  // Of 13 numbers, with what is before each.
  std::array<char, 13 * 32> numbers;
  char* end = numbers.data();
  const auto add = [&end](std::span<const double> values) {
    for (const double value : values) end = fmt::format_to(end, FMT_COMPILE(",{}"), value);
  };
  add(position_m);
  add(orientation_xyzw);
  add(linear_velocity_mps);
  add(angular_velocity_radps);
  *text += CsvTime(at).text();
  *text += ',';
  *text += name;
  text->append(numbers.data(), end);
  *text += '\n';
}

}  // namespace tcs
