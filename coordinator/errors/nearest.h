// "Did you mean …?"
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tcs {

// That of `known` which `written` most likely means; none if nothing is near enough to be a slip of
// the fingers.
[[nodiscard]] std::optional<std::string> Nearest(std::string_view written,
                                                 const std::vector<std::string>& known);

// "did you mean 'mass'?", or all that is known: "the keys here are a, b and c" for `kind` "keys".
[[nodiscard]] std::string Suggest(std::string_view written, const std::vector<std::string>& known,
                                  std::string_view kind);

}  // namespace tcs
