// Engines' messages run over several lines; ours do not.
#pragma once

#include <algorithm>
#include <string>

namespace tcs {

inline std::string OnOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace tcs
