// One line on stderr, `tcs: ` before it.
#pragma once

namespace tcs::dds {

[[gnu::format(printf, 1, 2)]] void Say(const char* format, ...);

}  // namespace tcs::dds
