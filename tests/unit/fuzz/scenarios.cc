#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/errors/visible.h"
#include "coordinator/scenario/load.h"
#include "tests/unit/fuzz/fuzz.h"
#include "tests/unit/fuzz/mutate.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs::fuzz {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> ScenarioTokens() {
  std::string list(2'000, '['), map, names;
  for (int i = 0; i < 1'000; ++i) map += "{a: ";
  for (int i = 0; i < 20'000; ++i) names += "\nk" + std::to_string(i) + ": 1";
  return {"\t",
          ": ",
          "- ",
          "{",
          "}",
          "[",
          "]",
          "&a ",
          "*a",
          "<<: *a\n",
          "!!binary ",
          "!!map ",
          "|\n",
          ">\n",
          "\"",
          "'",
          "#",
          "\n---\n",
          "\n...\n",
          "%YAML 9",
          "~",
          "null",
          "1e309",
          "-1",
          "0",
          "-0",
          "nan",
          ".inf",
          "1e-320",
          "99999999999999999999",
          "0x10",
          "1_000",
          "${seed}",
          "${HOME}",
          "${NOWHERE}",
          "$${",
          "${",
          "\xff",
          "\x1b[31m",
          "\r\n",
          "\r",
          "µs",
          "1h",
          "1ns",
          "300y",
          "1e18s",
          "true",
          "[]",
          "{}",
          "? ",
          "! ",
          "@",
          "`",
          "/dev/zero",
          "/etc",
          "..",
          "./controller",
          std::string(1, '\0'),
          std::string(10'000, 'a'),
          list,
          map,
          names,
          "\xef\xbb\xbf",
          "\xe2\x80\xa8",
          "&a [*a]",
          "&a {x: *a}",
          "\\",
          "\xc2\x85",
          "-9223372036854775808",
          "9223372036854775807"};
}

// The scenarios to damage; what the examples' files name is made to be there.
std::vector<std::string> Corpus(const ScenarioFolder& folder) {
  std::vector<std::string> corpus{std::string(kGoodScenario), std::string(kGoodDdsScenario)};
  for (const auto& entry : fs::recursive_directory_iterator(TCS_EXAMPLES)) {
    if (entry.path().extension() == ".yaml") corpus.push_back(TextOf(entry.path()));
    std::error_code there_already;
    fs::create_symlink(entry.path(), folder.Path(entry.path().filename().string()), there_already);
  }
  return corpus;
}

// "PATH:LINE: …"; a file as a whole has no line.
bool NamesItsPlace(const std::string& message, const std::string& path) {
  if (message.starts_with("--set ")) return true;
  if (!message.starts_with(path + ":")) return false;
  const std::string rest = message.substr(path.size() + 1);
  const std::size_t digits = rest.find_first_not_of("0123456789");
  if (digits != std::string::npos && digits > 0 && rest.substr(digits, 2) == ": ") return true;
  return rest.starts_with(" is larger than 1 MiB");
}

std::string WrongWith(const LoadError& error, const std::string& path) {
  if (!NamesItsPlace(error.message, path)) {
    return "a refusal does not say where: " + Visible(error.message);
  }
  if (error.message.size() > path.size() + 100'000) return "a refusal is of endless length";
  return {};
}

// What is wrong with how the loader takes the scenario, or nothing: up to its first mistake, and
// for all of them.
std::string Load(const std::string& path, const std::vector<std::string>& set, bool* refused) {
  const ScenarioOverrides overrides{
      .overlays = {}, .set = set, .duration = {}, .drift = {}, .seed = {}};
  const auto loaded = LoadScenario(path, overrides);
  const auto* error = std::get_if<LoadError>(&loaded);
  *refused = error != nullptr;
  if (error != nullptr) {
    if (std::string wrong = WrongWith(*error, path); !wrong.empty()) return wrong;
  }
  const auto checked = CheckScenario(path, overrides);
  const auto* mistakes = std::get_if<std::vector<LoadError>>(&checked);
  if ((mistakes != nullptr) != *refused) {
    return *refused ? "a check finds nothing of: " + Visible(error->message)
                    : "a check refuses what a run takes: " + Visible(mistakes->front().message);
  }
  if (mistakes == nullptr) return {};
  for (const LoadError& mistake : *mistakes) {
    if (std::string wrong = WrongWith(mistake, path); !wrong.empty()) return "checked: " + wrong;
  }
  return {};
}

}  // namespace

Tally FuzzScenarios(int count, std::uint64_t seed) {
  const ScenarioFolder folder;
  const std::vector<std::string> corpus = Corpus(folder), tokens = ScenarioTokens();
  const std::vector<std::string> keys{
      "duration=",        "drift=",       "robots=", "bodies.a.mass=", "robots..",
      "dynamics.engine=", "channels[0]=", "=",       "robots[0][0]="};
  Tally tally;
  for (int number = 0; number < count; ++number) {
    Mutator mutator(seed * 1'000'003 + static_cast<std::uint64_t>(number), tokens);
    const std::string text = mutator.Damage(corpus[mutator.Below(corpus.size())], corpus);
    std::vector<std::string> set;
    if (mutator.OneIn(5)) {
      set.push_back(mutator.Damage(keys[mutator.Below(keys.size())] + "1", keys));
    }
    const std::string path = folder.Write("damaged.yaml", text);
    const auto wrong = tally.Count([&](bool* refused) { return Load(path, set, refused); });
    // Any file is read as an overlay, though what it says may then be refused.
    const auto lost = tally.Count([&](bool* no_overlay) {
      const auto overlay = LoadOverlay(path);
      const auto* error = std::get_if<LoadError>(&overlay);
      *no_overlay = error != nullptr;
      return error == nullptr ? "" : WrongWith(*error, path);
    });
    if (lost.has_value()) SayWrong("scenarios", number, *lost, text);
    if (wrong.has_value()) {
      SayWrong("scenarios", number, *wrong + (set.empty() ? "" : " with --set " + Visible(set[0])),
               text);
    }
  }
  return tally;
}

}  // namespace tcs::fuzz
