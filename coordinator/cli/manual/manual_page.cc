#include "coordinator/cli/manual/manual_page.h"

#include <fmt/format.h>

namespace tcs {

namespace {

// Escapes text that man would take for itself: escapes, and lines that would be man's commands.
std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if ((c == '.' || c == '\'') && escaped.empty()) {
      escaped += "\\&";
      escaped += c;
    } else if (c == '`' || c == '\'') {
      escaped += c == '`' ? "\\(ga" : "\\(aq";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Bold(const std::string& text) { return "\\fB" + Escaped(text) + "\\fR"; }
std::string Italic(const std::string& text) { return "\\fI" + Escaped(text) + "\\fR"; }

std::string Capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

std::string Options(const std::vector<DescribedOption>& options) {
  std::string text;
  for (const DescribedOption& option : options) {
    std::string names;
    const bool is_argument = option.names[0][0] != '-';
    for (const std::string& name : option.names) {
      names += (names.empty() ? "" : ", ") + (is_argument ? Italic(name) : Bold(name));
    }
    if (!is_argument && !option.value.empty()) names += " " + Italic(option.value);
    text += ".TP\n" + names + "\n" + Escaped(Capitalised(FullText(option))) + ".\n";
  }
  return text;
}

std::string ExitStatus() {
  return ".SH EXIT STATUS\n"
         ".TP\n0\nAll went well.\n"
         ".TP\n1\nThe run went to its end, but a program of it failed.\n"
         ".TP\n2\nNothing was run, or not to its end; one sentence on the standard error says "
         "why.\n"
         ".TP\n3\nSomething is worse than it may be: the scenario expects it otherwise, a warning "
         "came "
         "under \\fB\\-\\-strict\\fR, or \\fBtcsim compare\\fR found it.\n"
         ".TP\n128+N\nThe run was ended by the signal N.\n"
         ".P\n.B tcsim exec\nhas its program\\(aqs exit status; 127 if there is no such program.\n";
}

}  // namespace

std::string ManualPage(const DescribedCommand& command, const std::string& parent,
                       const DescribedCommand& all, const std::string& version) {
  const bool is_program = parent.empty();
  const std::string name = is_program ? command.name : parent + "-" + command.name;
  std::string page = fmt::format(".TH {} 1 \"\" \"tcs {}\" \"User Commands\"\n", name, version);
  page += fmt::format(".SH NAME\n{} \\- {}\n", Escaped(name), Escaped(command.text));
  page += ".SH SYNOPSIS\n";
  const std::string usage = UsageOf(command, parent);
  const std::string called = is_program ? command.name : parent + " " + command.name;
  page += Bold(called) + Escaped(usage.substr(called.size())) + "\n";
  if (is_program) {
    page +=
        ".SH DESCRIPTION\n"
        "tcs runs unmodified robot programs (controllers, planners, DDS nodes) in a "
        "simulation in which computing takes time: a planner that needs 0.8 s of processor time "
        "finds the world 0.8 s older when it is done. Programs run in virtual time; a scheduler "
        "runs them against the physics and charges the processor time that they really use.\n"
        ".SH COMMANDS\n";
    for (const DescribedCommand& sub : command.commands) {
      page += ".TP\n" + Bold(sub.name) + "\n" + Escaped(Capitalised(sub.text)) + ". See " +
              Bold(name + "-" + sub.name) + "(1).\n";
    }
  }
  if (!command.arguments.empty()) page += ".SH ARGUMENTS\n" + Options(command.arguments);
  if (!command.options.empty()) page += ".SH OPTIONS\n" + Options(command.options);
  if (!command.examples.empty()) {
    page += ".SH EXAMPLES\n";
    for (const DescribedExample& example : command.examples) {
      page += ".TP\n" + Bold(example.line) + "\n" + Escaped(Capitalised(example.purpose)) + ".\n";
    }
  }
  page += ExitStatus();
  page += ".SH SEE ALSO\n";
  if (is_program) {
    page +=
        "The documentation and the examples that are installed with tcs, in\n"
        ".I share/doc/tcsim\nand\n.I share/tcs/examples\n.\n";
  } else {
    page += Bold(all.name) + "(1)";
    for (const DescribedCommand& sub : all.commands) {
      if (sub.name != command.name) page += ", " + Bold(all.name + "-" + sub.name) + "(1)";
    }
    page += "\n";
  }
  return page;
}

}  // namespace tcs
