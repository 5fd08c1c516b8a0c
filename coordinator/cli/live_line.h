// The line on the terminal that says how a run is going.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "coordinator/cli/terminal_line.h"
#include "coordinator/tasks/coordinator.h"

namespace tcs {

class LiveLine {
 public:
  explicit LiveLine(std::int64_t duration_ns) : duration_ns_(duration_ns) {}

  // The text to show for `progress`, the more important first: how far the run is, how fast, and
  // when it will be over; then what share of a processor each client had since the last call, the
  // busiest first. Items that do not fit into `columns` are left out.
  std::string Text(const RunProgress& progress, std::size_t columns);

  void Show(const RunProgress& progress);
  void Clear() { line_.Clear(); }

 private:
  // "about 1:20 to go", in real time; empty while nothing can be said.
  std::string ToGo(const RunProgress& progress);

  std::int64_t duration_ns_;
  std::int64_t last_real_ns_ = 0;
  double rate_ = -1;  // virtual time over real time, of late; below 0: not known yet
  std::int64_t last_virtual_ns_ = 0;
  std::map<std::string, std::int64_t> last_charged_ns_;
  TerminalLine line_;
};

}  // namespace tcs
