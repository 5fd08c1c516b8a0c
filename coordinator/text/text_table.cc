#include "coordinator/text/text_table.h"

#include <algorithm>
#include <utility>

#include "shm/check.h"

namespace tcs {

namespace {

std::size_t Places(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

}  // namespace

TextTable::TextTable(std::vector<TextColumn> columns)
    : columns_(std::move(columns)), widths_(columns_.size()) {
  std::vector<std::string> titles;
  for (const TextColumn& column : columns_) titles.push_back(column.title);
  Row(std::move(titles));
}

void TextTable::Row(std::vector<std::string> cells) {
  TCS_CHECK(cells.size() == columns_.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    widths_[i] = std::max(widths_[i], Places(cells[i]));
  }
  lines_.push_back({std::move(cells), {}});
}

void TextTable::Note(std::string line) { lines_.back().notes.push_back(std::move(line)); }

std::string TextTable::LineOf(const std::vector<std::string>& cells) const {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string space(widths_[i] - Places(cells[i]), ' ');
    line += i == 0 ? "" : "  ";
    line += columns_[i].is_number ? space + cells[i] : cells[i] + space;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string TextTable::Text() const {
  std::string text;
  for (const Line& line : lines_) {
    text += LineOf(line.cells) + "\n";
    for (const std::string& note : line.notes) text += note + "\n";
  }
  return text;
}

}  // namespace tcs
