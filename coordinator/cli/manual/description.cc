#include "coordinator/cli/manual/description.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace tcs {

namespace {

// "TEXT:{consistent,callback}" has the choices consistent and callback.
std::vector<std::string> ChoicesIn(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t begin = type.find('{'), end = type.find('}');
  const bool is_one_list = begin != std::string::npos && end == type.size() - 1;
  if (!is_one_list) return choices;
  std::istringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

// Takes "FILE: " from the text's beginning.
std::string TakeValueName(std::string* text) {
  constexpr std::string_view kOfNames = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789=,./@[]";
  const std::size_t end = text->find_first_not_of(kOfNames);
  const bool has_name = end != std::string::npos && end > 0 && text->compare(end, 2, ": ") == 0;
  if (!has_name) return {};
  std::string name = text->substr(0, end);
  text->erase(0, end + 2);
  return name;
}

DescribedOption DescribeOption(const CLI::Option& option) {
  DescribedOption described;
  described.text = option.get_description();
  if (option.get_positional()) {
    described.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  }
  described.value = TakeValueName(&described.text);
  const bool takes_value = option.get_items_expected_max() > 0;
  if (takes_value) {
    const std::string type = option.get_type_name();
    described.choices = ChoicesIn(type);
    described.unless_told = option.get_default_str();
    if (described.value.empty() && !described.choices.empty()) {
      for (const std::string& choice : described.choices) {
        described.value += (described.value.empty() ? "" : "|") + choice;
      }
    }
    // Only the type itself: the text says in words which values the type may have.
    if (described.value.empty()) described.value = type.substr(0, type.find_first_of(": ("));
    if (described.value.empty()) described.value = "VALUE";
  } else {
    described.value.clear();
  }
  described.is_required = option.get_required();
  described.repeats = option.get_items_expected_max() > 1 && option.get_positional();
  return described;
}

std::vector<DescribedExample> ExamplesIn(const std::string& footer) {
  std::vector<DescribedExample> examples;
  std::istringstream lines(footer);
  for (std::string line, purpose; std::getline(lines, line);) {
    std::getline(lines, purpose);
    examples.push_back({line, purpose});
  }
  return examples;
}

}  // namespace

DescribedCommand Describe(const CLI::App& app) {
  DescribedCommand command;
  command.name = app.get_name();
  command.text = app.get_description();
  command.examples = ExamplesIn(app.get_footer());
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    (option->get_positional() ? command.arguments : command.options)
        .push_back(DescribeOption(*option));
  }
  for (const CLI::App* sub : app.get_subcommands(nullptr)) {
    if (!sub->get_group().empty()) command.commands.push_back(Describe(*sub));
  }
  return command;
}

std::string UsageOf(const DescribedCommand& command, const std::string& parent) {
  std::string usage = parent.empty() ? command.name : parent + " " + command.name;
  if (!command.commands.empty()) return usage + " COMMAND [OPTIONS]";
  if (!command.options.empty()) usage += " [OPTIONS]";
  for (const DescribedOption& argument : command.arguments) {
    const std::string name = argument.names[0] + (argument.repeats ? "..." : "");
    usage += argument.is_required ? " " + name : " [" + name + "]";
  }
  return usage;
}

std::string Heading(const DescribedOption& option) {
  std::string heading;
  for (const std::string& name : option.names) heading += (heading.empty() ? "" : ", ") + name;
  const bool is_argument = option.names[0][0] != '-';
  return is_argument || option.value.empty() ? heading : heading + " " + option.value;
}

std::string FullText(const DescribedOption& option) {
  if (option.unless_told.empty()) return option.text;
  return option.text + " (default: " + option.unless_told + ")";
}

}  // namespace tcs
