// Which thread had the processor when, in virtual and in real time: dispatches.csv, one line per
// slice.
//
// A slice that follows another one of its row without a gap in virtual time, and with no other row
// in between, lengthens that slice, unless the real time between is too long to be the
// coordinator's turn. Without real times everything written derives from virtual time: two
// deterministic runs write the same bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/trace/csv_file.h"

namespace tcs {

class DispatchLog {
 public:
  [[nodiscard]] std::string Open(const std::string& path, bool with_real_times);
  bool is_open() const { return file_.is_open(); }

  // Rows count from 0, in the order of their making.
  void AddRow(const std::string& name) { rows_.push_back(name); }

  struct Span {
    std::int64_t start_ns = 0, end_ns = 0;
  };
  // `real` counts from the run's start.
  void Slice(int row, Span virtual_time, Span real);

  void Flush() { file_.Flush(); }
  [[nodiscard]] std::string Close();

 private:
  void Write();

  CsvFile file_;
  bool with_real_times_ = false;
  std::vector<std::string> rows_;
  int row_ = -1;  // of the slice that may become longer; -1: none
  Span virtual_, real_;
};

}  // namespace tcs
