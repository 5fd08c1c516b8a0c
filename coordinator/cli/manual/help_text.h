// `--help` as it stands on a terminal.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "coordinator/cli/manual/description.h"

namespace CLI {
class FormatterBase;
}

namespace tcs {

struct HelpStyle {
  std::size_t columns = 80;  // the most that a line may have; 40 at least are used
  bool is_coloured = false;
};

// `parent`: as for UsageOf.
[[nodiscard]] std::string HelpText(const DescribedCommand& command, const std::string& parent,
                                   const HelpStyle& style);

// The formatter that CLI11 asks for help: for stdout as it is, a terminal of that width or a file.
// Colours obey NO_COLOR.
[[nodiscard]] std::shared_ptr<CLI::FormatterBase> HelpFormatter();

}  // namespace tcs
