// A line on the terminal, rewritten in place.
#pragma once

#include <cstddef>
#include <string>

namespace tcs {

class TerminalLine {
 public:
  // True where somebody can see it: stderr is a terminal that can rewrite a line.
  static bool IsSeen();
  // How many characters fit.
  static std::size_t Columns();

  void Show(const std::string& text);
  // Takes the line away again, if one was shown.
  void Clear();

 private:
  bool shown_ = false;
};

}  // namespace tcs
