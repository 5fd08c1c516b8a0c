// Text from elsewhere (scenario files, programs, names of topics) as a terminal may be given it.
#pragma once

#include <string>
#include <string_view>

namespace tcs {

// With everything that a terminal would obey rather than show written out: control characters,
// bytes that are no UTF-8, and what changes the direction of writing, as "\n", "\t" or "\x1b".
[[nodiscard]] std::string Visible(std::string_view text);

// The same of a text of several lines, whose ends stay.
[[nodiscard]] std::string VisibleLines(std::string_view text);

}  // namespace tcs
