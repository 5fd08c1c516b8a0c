// The schedule that a run has written (trace.json), read again: its events as they are, and which
// row was busy when.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/errors/load_error.h"

namespace tcs::perfetto {

// A row of a trace: a thread of a process, as the trace's format has them.
struct Row {
  int pid = 0, tid = 0;
  std::vector<std::pair<std::int64_t, std::int64_t>> busy;  // from, until; ns, in order
};

class Schedule {
 public:
  // The error is one sentence.
  [[nodiscard]] static LoadResult<Schedule> Read(const std::string& path);

  // The events without the file's beginning and end; between two of them a comma.
  std::string_view events() const { return events_; }
  int last_pid() const { return last_pid_; }

  // Null if there is no such row. The first thread of a client has the client's name.
  const Row* Find(const std::string& name) const;
  // The row of the client's thread that stopped at that time, or began, or was busy; else the row
  // of the client's first thread. Null if there is none.
  const Row* ThatStopped(const std::string& client, std::int64_t at_ns) const;
  const Row* ThatBegan(const std::string& client, std::int64_t at_ns) const;

 private:
  enum class Edge { kEnd, kBegin };
  const Row* At(const std::string& client, std::int64_t at_ns, Edge edge) const;
  void TakeLine(std::string_view line);

  std::string text_;
  std::string_view events_;
  int last_pid_ = 0;
  std::map<std::string, Row, std::less<>> rows_;  // by name
  std::map<int, std::string> names_;              // by thread
};

}  // namespace tcs::perfetto
