// Which thread ran when, in virtual time, as Chrome trace events (JSON): ui.perfetto.dev and
// chrome://tracing open the file. One row per thread under its robot, one for the dynamics.
//
// A thread's slices that follow each other without a gap become one, so that a planner's second is
// one bar and not a thousand. Everything written derives from virtual time: two deterministic runs
// write the same bytes. As in csv_file.h, an event is noted and becomes text together with many
// others. Not thread-safe. A file that cannot be written is reported by Close().
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace tcs {

class ScheduleTrace {
 public:
  ScheduleTrace() = default;
  ~ScheduleTrace();
  ScheduleTrace(const ScheduleTrace&) = delete;
  ScheduleTrace& operator=(const ScheduleTrace&) = delete;

  // Empty on success, else one sentence. Without Open everything below does nothing.
  [[nodiscard]] std::string Open(const std::string& path);

  // A row named `name` in the group `group`. Rows are shown in the order of their making.
  int AddRow(const std::string& group, const std::string& name);
  // Row `row` was busy from `start_ns` to `end_ns`, which may be the same; later slices of a row
  // never begin earlier.
  void Slice(int row, std::int64_t start_ns, std::int64_t end_ns);
  // Something happened at one instant. `what` is a literal.
  void Instant(int row, const char* what, std::int64_t at_ns);

  // Writes what is noted. The file is whole then, and after every other write, so that a run that
  // is killed leaves a whole file.
  void Flush();

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Close();

 private:
  struct Row {
    int group;
    bool has_slice = false;  // not written yet, for more may follow without a gap
    std::int64_t start_ns = 0, end_ns = 0;
  };
  // An event of a row: an instant where `what` says what happened, else a slice.
  struct Noted {
    int row;
    const char* what;
    std::int64_t start_ns, end_ns;
  };
  void Event(std::string_view json);
  void Note(const Noted& noted);
  void NoteSlice(int row);
  void WriteNoted();
  void Write(std::string_view events);

  std::FILE* file_ = nullptr;
  std::string path_;
  bool first_ = true;
  std::vector<std::string> groups_;
  std::vector<Row> rows_;
  std::vector<Noted> noted_;
};

}  // namespace tcs
