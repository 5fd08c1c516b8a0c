#include "coordinator/report/html.h"

#include <fmt/format.h>

#include "coordinator/report/text.h"

namespace tcs::report {

void Table::Row(const std::vector<std::string>& cells, bool is_quiet) {
  rows_ += is_quiet ? "<tr class=\"quiet\">" : "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool number = columns_[i].is_number;
    const char* tag = i == 0 ? "th" : "td";
    rows_ += fmt::format("<{0}{1}{2}>{3}</{0}>", tag, i == 0 ? " scope=\"row\"" : "",
                         number ? " class=\"n\"" : "", Escaped(cells[i]));
  }
  rows_ += "</tr>\n";
}

std::string Table::Html() const {
  std::string head;
  for (const Column& column : columns_) {
    head += fmt::format("<th scope=\"col\"{}>{}</th>", column.is_number ? " class=\"n\"" : "",
                        Escaped(column.title));
  }
  return fmt::format(
      "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table>"
      "<thead><tr>{1}</tr></thead><tbody>\n{2}</tbody></table></div>\n<p "
      "class=\"caption\">{0}</p>\n",
      Escaped(caption_), head, rows_);
}

}  // namespace tcs::report
