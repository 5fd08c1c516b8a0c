// What is wrong with something the user gave: one sentence for the user, which says where it is and
// how to mend it. A scenario's mistakes begin with "FILE:LINE: ".
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
