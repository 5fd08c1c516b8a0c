#include "coordinator/compare/figure_names.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace tcs::compare {

bool NameMeans(const std::string& wanted, const std::string& figure) {
  if (figure.ends_with("." + wanted)) return true;
  for (std::size_t from = 0;;) {
    const std::string_view rest = std::string_view(figure).substr(from);
    if (rest == wanted) return true;
    if (rest.starts_with(wanted) && rest[wanted.size()] == '.') return true;
    const std::size_t next = figure.find('/', from);
    if (next == std::string::npos) return false;
    from = next + 1;
  }
}

bool IsAmong(const std::string& figure, const std::vector<std::string>& wanted) {
  return std::any_of(wanted.begin(), wanted.end(),
                     [&](const std::string& name) { return NameMeans(name, figure); });
}

}  // namespace tcs::compare
