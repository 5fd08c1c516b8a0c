// Names in what tcs writes for itself to read again as a piece of a scenario.
#pragma once

#include <string>
#include <string_view>

namespace tcs {

// The text as YAML has it on one line, in quotes where it would be something else without: arm,
// 'null', '1.0', 'it''s'. It is one that can be shown; as a key, of no more than 500 bytes.
[[nodiscard]] std::string YamlText(std::string_view text);

}  // namespace tcs
