#include "coordinator/cli/new_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <variant>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/preload_library.h"
#include "coordinator/cli/print.h"
#include "coordinator/os/files.h"
#include "coordinator/scenario/executable.h"

namespace tcs {

namespace {

namespace fs = std::filesystem;

// True if a robot may have the name (CheckName in yaml_reader.h), and a CMake project, too.
bool IsName(const std::string& name) {
  constexpr const char* kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !name.empty() && name.size() <= 64 && name[0] != '-' &&
         name.find_first_not_of(kAllowed) == std::string::npos;
}

bool IsInstalled(const std::string& program) {
  const auto found = FindExecutable(program, ".");
  return std::holds_alternative<std::string>(found);
}

void Replace(const std::string& what, const std::string& with, std::string* text) {
  for (std::size_t at = 0; (at = text->find(what, at)) != std::string::npos; at += with.size()) {
    text->replace(at, what.size(), with);
  }
}

std::string TextOf(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

const CLI::App* AddNew(CLI::App* app, NewArguments* arguments) {
  CLI::App* command =
      app->add_subcommand("new", "write a first scenario, and a controller that flies");
  command->add_option("name", arguments->name, "the folder to make, and the robot's name")
      ->required();
  command
      ->add_option(
          "--language", arguments->language,
          "the language of the controller (default: Python, or C where there is no Python)")
      ->check(CLI::IsMember({"python", "c"}));
  return command;
}

int NewCommand(const NewArguments& arguments) {
  const std::string& name = arguments.name;
  if (!IsName(name)) {
    return Fail("'" + name +
                "' cannot be used as a name; use up to 64 letters, digits, '_' and '-'");
  }
  std::error_code error;
  if (fs::exists(name, error) || error) {
    return Fail("'" + name + "' exists already; choose another name, or remove it");
  }
  const bool is_python =
      arguments.language.empty() ? IsInstalled("python3") : arguments.language == "python";
  const fs::path data = DataFolder(), from = data / "templates" / (is_python ? "python" : "c");
  if (!fs::is_directory(from, error)) {
    return Fail("the templates are missing: " + from.string() + "; install or build tcs again");
  }
  fs::create_directory(name, error);
  if (error) return Fail("the folder '" + name + "' cannot be made: " + error.message());
  for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
    std::string text = TextOf(entry.path());
    Replace("@NAME@", name, &text);
    Replace("@SCHEMA@", (data / "scenario.schema.json").string(), &text);
    const std::string to = name + "/" + entry.path().filename().string();
    if (const std::string mistake = WriteWhole(to, text, Withstands::kCrash); !mistake.empty()) {
      return Fail(mistake);
    }
  }
  Print("{}/ has scenario.yaml and {}; now:\n", name,
        is_python ? "controller.py" : "controller.c, with a CMakeLists.txt");
  Print("  cd {}\n", name);
  if (!is_python)
    Print("  cmake -B build && cmake --build build    # or: cc -O2 controller.c -o controller\n");
  Print("  tcsim run\n");
  return kSucceeded;
}

}  // namespace tcs
