#include "coordinator/cli/manual/help_text.h"

#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <utility>

namespace tcs {

namespace {

constexpr std::size_t kNarrowest = 40, kWidest = 100, kIndent = 2, kMostHeading = 30;

// The lines of `text`, none longer than `width` unless a word is.
std::vector<std::string> Wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

class Writer {
 public:
  explicit Writer(const HelpStyle& style)
      : width_(std::clamp(style.columns, kNarrowest, kWidest)), is_coloured_(style.is_coloured) {}

  void Paragraph(const std::string& text) {
    for (const std::string& line : Wrapped(text, width_)) text_ += line + "\n";
  }

  void Section(const std::string& title) { text_ += "\n" + Bold(title) + "\n"; }

  // Headings in a column, texts in one beside it; a heading that is too long has a line of its own.
  void Table(const std::vector<std::pair<std::string, std::string>>& rows) {
    std::size_t longest = 0;
    for (const auto& [heading, text] : rows) {
      if (heading.size() <= kMostHeading) longest = std::max(longest, heading.size());
    }
    const std::size_t column = std::min(kIndent + longest + 2, width_ / 2);
    for (const auto& [heading, text] : rows) Row(heading, text, column);
  }

  void Example(const DescribedExample& example) {
    // A command line that is too long is continued as a shell takes it.
    std::string command;
    for (const std::string& part : Wrapped(example.line, width_ - 2 * kIndent - 2)) {
      command += command.empty() ? part : " \\\n" + std::string(2 * kIndent, ' ') + part;
    }
    text_ += std::string(kIndent, ' ') + Bold(command) + "\n";
    for (const std::string& line : Wrapped(example.purpose, width_ - 3 * kIndent)) {
      text_ += std::string(3 * kIndent, ' ') + line + "\n";
    }
  }

  std::string Take() { return std::move(text_); }

 private:
  std::string Bold(const std::string& text) const {
    return is_coloured_ ? "\033[1m" + text + "\033[0m" : text;
  }

  void Row(const std::string& heading, const std::string& text, std::size_t column) {
    text_ += std::string(kIndent, ' ') + Bold(heading);
    if (text.empty()) text_ += "\n";
    std::size_t at = kIndent + heading.size();
    for (const std::string& line :
         text.empty() ? std::vector<std::string>() : Wrapped(text, width_ - column)) {
      if (at + 2 > column && at != 0) {
        text_ += "\n";
        at = 0;
      }
      text_ += std::string(column - at, ' ') + line + "\n";
      at = 0;
    }
  }

  std::size_t width_;
  bool is_coloured_;
  std::string text_;
};

HelpStyle StyleOfStdout() {
  winsize size{};
  const bool is_terminal = isatty(STDOUT_FILENO) == 1;
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return {known ? size.ws_col : 80u, is_terminal && getenv("NO_COLOR") == nullptr};
}

std::vector<std::pair<std::string, std::string>> RowsOf(
    const std::vector<DescribedOption>& options) {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const DescribedOption& option : options)
    rows.emplace_back(Heading(option), FullText(option));
  return rows;
}

}  // namespace

std::string HelpText(const DescribedCommand& command, const std::string& parent,
                     const HelpStyle& style) {
  Writer writer(style);
  writer.Paragraph(command.text);
  writer.Section("Usage");
  writer.Table({{UsageOf(command, parent), ""}});
  if (!command.commands.empty()) {
    writer.Section("Commands");
    std::vector<std::pair<std::string, std::string>> rows;
    for (const DescribedCommand& sub : command.commands) rows.emplace_back(sub.name, sub.text);
    writer.Table(rows);
  }
  if (!command.arguments.empty()) {
    writer.Section("Arguments");
    writer.Table(RowsOf(command.arguments));
  }
  if (!command.options.empty()) {
    writer.Section("Options");
    writer.Table(RowsOf(command.options));
  }
  if (!command.examples.empty()) {
    writer.Section("Examples");
    for (const DescribedExample& example : command.examples) writer.Example(example);
  }
  if (!command.commands.empty()) {
    writer.Section("More");
    writer.Table({{"tcsim COMMAND --help", "the options of a command, with examples"},
                  {"man tcsim-COMMAND", "the same as a manual page, where tcs is installed"}});
  }
  return writer.Take();
}

std::shared_ptr<CLI::FormatterBase> HelpFormatter() {
  return std::make_shared<CLI::FormatterLambda>([](const CLI::App* app, const std::string&,
                                                   CLI::AppFormatMode) {
    const CLI::App* parent = app->get_parent();
    return HelpText(Describe(*app), parent == nullptr ? "" : parent->get_name(), StyleOfStdout());
  });
}

}  // namespace tcs
