// A table for a terminal: under a line of titles one line for each row, columns as wide as what is
// in them, numbers to the right. Text is UTF-8, whose characters all take one place.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tcs {

struct TextColumn {
  std::string title;
  bool is_number = true;
};

class TextTable {
 public:
  explicit TextTable(std::vector<TextColumn> columns);

  // As many cells as there are columns.
  void Row(std::vector<std::string> cells);
  // A line of its own under the last row, which no column becomes wider by.
  void Note(std::string line);

  // Ends with a line's end; no line ends with spaces.
  [[nodiscard]] std::string Text() const;

 private:
  struct Line {
    std::vector<std::string> cells;
    std::vector<std::string> notes;
  };

  [[nodiscard]] std::string LineOf(const std::vector<std::string>& cells) const;

  std::vector<TextColumn> columns_;
  std::vector<std::size_t> widths_;
  std::vector<Line> lines_;  // the titles are the first
};

}  // namespace tcs
