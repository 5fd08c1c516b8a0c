// Tables, for the page and for a terminal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "coordinator/text/text_table.h"

namespace tcs::report {

using Column = TextColumn;

// All texts of a table are plain.
class Table {
 public:
  explicit Table(std::string caption, std::vector<Column> columns)
      : caption_(std::move(caption)), columns_(std::move(columns)) {}
  // As many cells as there are columns. A quiet row is one to compare with.
  void Row(std::vector<std::string> cells, bool is_quiet = false);
  [[nodiscard]] std::string Html() const;
  // A line for each row, under a line of titles; numbers stand to the right.
  [[nodiscard]] std::string Text() const;

 private:
  struct Cells {
    std::vector<std::string> texts;
    bool is_quiet = false;
  };
  std::string caption_;
  std::vector<Column> columns_;
  std::vector<Cells> rows_;
};

}  // namespace tcs::report
