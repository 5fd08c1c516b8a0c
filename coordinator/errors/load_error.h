// A mistake in something that the user gave: one sentence for the user, which says what is wrong,
// where, and how to mend it. A scenario's mistakes begin with "FILE:LINE: ".
#pragma once

#include <string>
#include <variant>

namespace tcs {

struct LoadError {
  std::string message;
};

// Either what was asked for or why it cannot be had.
template <class T>
using LoadResult = std::variant<T, LoadError>;

}  // namespace tcs
