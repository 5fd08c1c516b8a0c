#include "coordinator/cli/manual/completion.h"

#include <fmt/format.h>

namespace tcs {

namespace {

std::string Joined(const std::vector<std::string>& words, const char* between = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

// The commands that run another program: the words behind their arguments are that program's.
bool RunsAnother(const DescribedCommand& command) {
  return !command.arguments.empty() && command.arguments[0].names[0] == "command";
}

std::string LongOptions(const DescribedCommand& command) {
  std::vector<std::string> names;
  for (const DescribedOption& option : command.options) names.push_back(option.names.back());
  return Joined(names);
}

// A case of bash for what may follow an option; empty where nothing is known of the option's value.
std::string BashValues(const DescribedOption& option) {
  std::string complete;
  if (!option.choices.empty()) {
    complete = fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", Joined(option.choices));
  } else if (option.value == "FOLDER") {
    complete = "_tcsim_files -d";
  } else if (option.value == "FILE") {
    complete = "_tcsim_files -f";
  } else if (!option.value.empty()) {
    complete = "COMPREPLY=()";
  } else {
    return {};
  }
  return fmt::format("        {}) {}; return ;;\n", Joined(option.names, "|"), complete);
}

std::string Quoted(const std::string& text) {  // for zsh, within single quotes and brackets
  std::string quoted;
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else {
      quoted += c;
    }
  }
  return quoted;
}

std::string ZshAction(const DescribedOption& option) {
  if (!option.choices.empty()) return "(" + Joined(option.choices) + ")";
  if (option.value == "FOLDER") return "_files -/";
  if (option.value == "FILE") return "_files";
  return " ";
}

std::string ZshSpecs(const DescribedCommand& command) {
  std::string specs;
  for (const DescribedOption& option : command.options) {
    for (const std::string& name : option.names) {
      // With "=", zsh knows the value in the same word and in the next one.
      const bool joined = !option.value.empty() && name.starts_with("--");
      specs += fmt::format("        '*{}{}[{}]", name, joined ? "=" : "", Quoted(FullText(option)));
      if (!option.value.empty()) {
        specs += fmt::format(":{}:{}", Quoted(option.value), ZshAction(option));
      }
      specs += "' \\\n";
    }
  }
  return specs +
         (RunsAnother(command) ? "        '*:::program:_normal'\n" : "        '*:file:_files'\n");
}

}  // namespace

std::string BashCompletion(const DescribedCommand& program) {
  std::vector<std::string> names;
  for (const DescribedCommand& sub : program.commands) names.push_back(sub.name);
  std::string text = fmt::format(
      R"(# bash completion for {0}; written by `{0} generate`

_tcsim_files() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "$1" -- "$word")
}}

_tcsim() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} options=
  # In --option=value, bash has the sign as a word of its own.
  if [[ $word == = ]]; then
    word=
  elif [[ $before == = ]]; then
    before=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{1} {2}' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
)",
      program.name, Joined(names), LongOptions(program));
  for (const DescribedCommand& sub : program.commands) {
    text += fmt::format("    {})\n", sub.name);
    if (RunsAnother(sub)) {
      text +=
          "      local i\n"
          "      for ((i = 2; i < COMP_CWORD; ++i)); do\n"
          "        if [[ ${COMP_WORDS[i]} == -- ]]; then\n"
          "          if ((COMP_CWORD == i + 1)); then\n"
          "            COMPREPLY=($(compgen -c -- \"$word\"))\n"
          "          else\n"
          "            _tcsim_files -f\n"
          "          fi\n"
          "          return\n"
          "        fi\n"
          "      done\n";
    }
    text += "      case $before in\n";
    for (const DescribedOption& option : sub.options) text += BashValues(option);
    text += fmt::format("      esac\n      options='{}'\n      ;;\n", LongOptions(sub));
  }
  text +=
      "    *) return ;;\n"
      "  esac\n"
      "  if [[ $word == -* ]]; then\n"
      "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
      "  else\n"
      "    _tcsim_files -f\n"
      "  fi\n"
      "}\n\n"
      "complete -F _tcsim " +
      program.name + "\n";
  return text;
}

std::string ZshCompletion(const DescribedCommand& program) {
  std::string text = fmt::format(
      "#compdef {0}\n"
      "# zsh completion for {0}; written by `{0} generate`\n\n"
      "_tcsim() {{\n"
      "  local state line\n"
      "  _arguments -C '1:command:->command' '*::argument:->argument' && return\n"
      "  case $state in\n"
      "    command)\n"
      "      local -a commands=(\n",
      program.name);
  for (const DescribedCommand& sub : program.commands) {
    text += fmt::format("        '{}:{}'\n", sub.name, Quoted(sub.text));
  }
  text +=
      "      )\n"
      "      _describe -t commands command commands\n"
      "      ;;\n"
      "    argument)\n"
      "      case $line[1] in\n";
  for (const DescribedCommand& sub : program.commands) {
    // -S: a word behind "--" is no option, and "--" no program.
    text += fmt::format("        {})\n      _arguments -S \\\n{}          ;;\n", sub.name,
                        ZshSpecs(sub));
  }
  text +=
      "      esac\n"
      "      ;;\n"
      "  esac\n"
      "}\n\n"
      "_tcsim \"$@\"\n";
  return text;
}

}  // namespace tcs
