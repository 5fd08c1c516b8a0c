// The lines that clients of a run that goes on write, and when.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "coordinator/report/csv_tail.h"
#include "coordinator/report/replay.h"

namespace tcs::report {

class SaidTail {
 public:
  explicit SaidTail(std::string folder);

  // Appends the lines that have been ended since the last look, up to as many as a page holds.
  void Look(Replay* replay);

 private:
  struct Stream {
    std::size_t read = 0;  // of its file
    std::string begun;     // a line without its end
  };
  void Take(const CsvFields& fields, Replay* replay);

  std::string folder_;
  CsvTail table_;
  std::map<std::pair<std::string, std::string>, Stream> streams_;  // by client and name
  std::size_t lines_ = 0, marks_ = 0;
};

}  // namespace tcs::report
