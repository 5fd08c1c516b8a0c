#include "coordinator/text/spoken.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace tcs {

std::string Spoken(std::int64_t ns) {
  constexpr std::array<std::pair<double, const char*>, 4> kUnits = {
      {{1e9, "s"}, {1e6, "ms"}, {1e3, "us"}, {1, "ns"}}};
  for (const auto& [size, name] : kUnits) {
    const double value = static_cast<double>(ns) / size;
    if (std::abs(value) < 0.9995 && size > 1) continue;
    const int digits = std::abs(value) >= 99.95 ? 0 : std::abs(value) >= 9.995 ? 1 : 2;
    std::string text = fmt::format("{:.{}f}", value, digits);
    if (text.find('.') != std::string::npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.back() == '.') text.pop_back();
    }
    return text + " " + name;
  }
  return "0 s";
}

}  // namespace tcs
