#include "coordinator/trials/slurm/environment.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace tcs {

namespace {

// True if Slurm, or the shell that its script is for, replaces the variable.
bool IsReplaced(std::string_view name) {
  constexpr std::array<std::string_view, 7> kNames{"ENVIRONMENT", "HOSTNAME", "OLDPWD", "PWD",
                                                   "SHLVL",       "TMPDIR",   "_"};
  return name.rfind("SLURM", 0) == 0 || name.rfind("SBATCH", 0) == 0 ||
         std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

}  // namespace

std::vector<SlurmVariable> ReadEnvironment() {
  std::vector<SlurmVariable> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) continue;
    SlurmVariable& variable = variables.emplace_back();
    variable.name = text.substr(0, equals);
    if (IsReplaced(variable.name)) variable.value = text.substr(equals + 1);
  }
  return variables;
}

void TakeEnvironment(const std::vector<SlurmVariable>& environment) {
  std::vector<std::pair<std::string, std::string>> taken;
  for (const SlurmVariable& variable : environment) {
    const char* here = std::getenv(variable.name.c_str());
    if (variable.value.has_value()) {
      taken.emplace_back(variable.name, *variable.value);
    } else if (here != nullptr) {
      taken.emplace_back(variable.name, here);
    }
  }
  clearenv();
  for (const auto& [name, value] : taken) setenv(name.c_str(), value.c_str(), 1);
}

}  // namespace tcs
