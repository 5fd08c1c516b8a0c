#include "coordinator/cli/duration_option.h"

#include <variant>

#include "coordinator/scenario/duration.h"

namespace tcs {

std::string TakeDuration(const std::string& name, const std::string& text,
                         std::optional<VirtualDuration>* to, Zero zero) {
  if (text.empty()) return {};
  auto parsed = ParseDuration(text);
  if (const auto* error = std::get_if<LoadError>(&parsed))
    return "--" + name + ": " + error->message;
  *to = std::get<VirtualDuration>(parsed);
  if (**to > VirtualDuration{} || zero == Zero::kAllowed) return {};
  return "--" + name + ": " + text + " is not positive; give a time such as 1ms or 20s";
}

}  // namespace tcs
