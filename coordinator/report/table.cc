#include "coordinator/report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// Of UTF-8 whose characters all take one place.
std::size_t Places(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

std::string Padded(const std::string& text, std::size_t places, bool to_the_right) {
  const std::string space(places - std::min(places, Places(text)), ' ');
  return to_the_right ? space + text : text + space;
}

}  // namespace

void Table::Row(std::vector<std::string> cells, bool is_quiet) {
  rows_.push_back({std::move(cells), is_quiet});
}

std::string Table::Html() const {
  std::string head, body;
  for (const Column& column : columns_) {
    head += fmt::format("<th scope=\"col\"{}>{}</th>", column.is_number ? " class=\"n\"" : "",
                        Escaped(column.title));
  }
  for (const Cells& row : rows_) {
    body += row.is_quiet ? "<tr class=\"quiet\">" : "<tr>";
    for (std::size_t i = 0; i < row.texts.size(); ++i) {
      body +=
          fmt::format("<{0}{1}{2}>{3}</{0}>", i == 0 ? "th" : "td", i == 0 ? " scope=\"row\"" : "",
                      columns_[i].is_number ? " class=\"n\"" : "", Escaped(row.texts[i]));
    }
    body += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table>"
      "<thead><tr>{1}</tr></thead><tbody>\n{2}</tbody></table></div>\n<p "
      "class=\"caption\">{0}</p>\n",
      Escaped(caption_), head, body);
}

std::string Table::Text() const {
  std::vector<std::string> lines(rows_.size() + 1);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t places = Places(columns_[i].title);
    for (const Cells& row : rows_) places = std::max(places, Places(row.texts[i]));
    const bool right = columns_[i].is_number;
    const char* gap = i == 0 ? "" : "  ";
    lines[0] += gap + Padded(columns_[i].title, places, right);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      lines[r + 1] += gap + Padded(rows_[r].texts[i], places, right);
    }
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace tcs::report
