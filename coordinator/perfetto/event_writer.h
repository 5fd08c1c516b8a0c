// Events of a trace, as text after others (Chrome's JSON format, as Perfetto reads it). Times are
// virtual nanoseconds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/perfetto/gzip_file.h"
#include "coordinator/perfetto/schedule.h"

namespace tcs::perfetto {

class EventWriter {
 public:
  // The file outlives this. It has events already if `has_events`.
  EventWriter(GzipFile& file, bool has_events, int last_pid)
      : file_(file), has_events_(has_events), last_pid_(last_pid) {}
  ~EventWriter();
  EventWriter(const EventWriter&) = delete;
  EventWriter& operator=(const EventWriter&) = delete;

  // Adds a group of counters, and returns its number.
  int AddGroup(std::string_view name);
  // Values are finite numbers, as JSON has them, under their names.
  using Values = std::span<const std::pair<std::string_view, std::string_view>>;
  void Counter(int group, std::string_view name, std::int64_t at_ns, Values values);
  // Something happened at one instant.
  void Instant(const Row& row, std::string_view name, std::int64_t at_ns);
  // One end of an arrow.
  struct End {
    const Row& row;
    std::string_view name;
    std::int64_t at_ns;
  };
  void Flow(const End& from, const End& to);

 private:
  void Event(std::string_view json);
  void FlowEnd(const End& end, std::uint64_t flow, std::string_view direction);

  GzipFile& file_;
  bool has_events_;
  int last_pid_;
  std::uint64_t flows_ = 0;
  std::string text_;  // not in the file yet
};

}  // namespace tcs::perfetto
