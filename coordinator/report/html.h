// Tables of a page.
#pragma once

#include <string>
#include <vector>

namespace tcs::report {

struct Column {
  std::string title;
  bool is_number = true;
};

// All texts are plain: they are escaped here.
class Table {
 public:
  explicit Table(std::string caption, std::vector<Column> columns)
      : caption_(std::move(caption)), columns_(std::move(columns)) {}
  // As many cells as there are columns. A quiet row is one to compare with.
  void Row(const std::vector<std::string>& cells, bool is_quiet = false);
  [[nodiscard]] std::string Html() const;

 private:
  std::string caption_;
  std::vector<Column> columns_;
  std::string rows_;
};

}  // namespace tcs::report
