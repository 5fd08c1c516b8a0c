// Reading of a table that a run still writes.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

class CsvTail {
 public:
  // The fate of a line. A line that is left for later comes again, first, at the next look, and the
  // lines behind it come after it.
  enum class Taken { kYes, kLater };
  enum class Found {
    kMore,     // or nothing
    kReplaced  // the file is another one than before, or gone
  };

  // The columns as in ReadCsv; the first `needed` columns have to be there, and lines have only
  // those fields if another column is not there.
  CsvTail(std::string path, std::vector<std::string_view> columns, std::size_t needed);

  // Calls `take` for each whole line that has come since the last look. There may be no file yet. A
  // file without these columns has no lines. Reads a limited amount at once; the rest comes next
  // time.
  Found Look(const std::function<Taken(const CsvFields&)>& take);

 private:
  bool Open();
  void TakeHead(std::string_view line);

  std::string path_;
  std::vector<std::string_view> columns_;
  std::size_t needed_;
  UniqueFd file_;
  ino_t inode_ = 0;
  off_t offset_ = 0;  // read so far
  std::string text_;  // and not taken yet
  std::vector<std::size_t> places_;
  bool has_head_ = false;
};

}  // namespace tcs::report
