// Finds the lines that tell of metrics in a program's output, which comes in pieces. Pure. What it
// keeps of the output is the beginning of one such line at most.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace tcs {

class MetricLineFinder {
 public:
  // Of a line without its end, which counts from 1 among all lines. Of one that is too long, its
  // beginning, which is too long, too.
  using OnLine = std::function<void(std::string_view line, std::int64_t number)>;

  // The output goes on with `piece`.
  void Feed(std::string_view piece, const OnLine& on_line);
  // The output has ended, perhaps without a line's end.
  void Finish(const OnLine& on_line);

 private:
  std::string begun_;         // a line that may be one, and has no end yet
  bool is_in_other_ = false;  // within a line that is none
  std::int64_t ended_ = 0;    // lines
};

}  // namespace tcs
