// Finds the lines that tell of metrics in a program's output, which comes in pieces. Pure. The
// finder keeps at most the beginning of one such line.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace tcs {

class MetricLineFinder {
 public:
  // Gets a line without its line end; `number` counts from 1 among all lines. Of a line that is too
  // long it gets the beginning, which is too long, too.
  using OnLine = std::function<void(std::string_view line, std::int64_t number)>;

  // The output goes on with `piece`.
  void Feed(std::string_view piece, const OnLine& on_line);
  // The output has ended, perhaps without a line's end.
  void Finish(const OnLine& on_line);

 private:
  std::string begun_;         // a line that may be a metric line, and has no end yet
  bool is_in_other_ = false;  // within a line that is no metric line
  std::int64_t ended_ = 0;    // lines
};

}  // namespace tcs
