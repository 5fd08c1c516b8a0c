#include "coordinator/report/table.h"

#include <fmt/format.h>

#include <utility>

#include "coordinator/report/text.h"

namespace tcs::report {

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
  TextTable table(columns_);
  for (const Cells& row : rows_) table.Row(row.texts);
  return table.Text();
}

}  // namespace tcs::report
