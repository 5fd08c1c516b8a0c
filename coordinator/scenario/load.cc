#include "coordinator/scenario/load.h"

#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "coordinator/scenario/load_dds.h"
#include "coordinator/scenario/overlay.h"
#include "coordinator/scenario/read_text.h"
#include "coordinator/scenario/sections.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;

std::vector<Setting> ReadOverlay(const std::string& path) {
  return SettingsOfOverlay(path, ReadText(path, "a piece of a scenario"));
}

void Append(std::vector<Setting> more, std::vector<Setting>* settings) {
  std::move(more.begin(), more.end(), std::back_inserter(*settings));
}

std::string FolderOf(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path folder = fs::canonical(absolute.parent_path(), error);
  return (error ? absolute.parent_path() : folder).string();
}

void LoadHead(const YamlMap& top, Scenario* scenario) {
  if (const YamlValue* name = top.Find("name")) {
    scenario->name = name->AsText();
    if (scenario->name.empty()) name->Fail("is empty; write a name, or leave the key out");
  }
  scenario->duration = top.Require("duration", "duration: 20s").AsPositiveDuration();
  if (const YamlValue* drift = top.Find("drift")) {
    scenario->drift_bound = drift->AsPositiveDuration();
  }
  if (const YamlValue* patience = top.Find("patience")) {
    scenario->patience = HostDuration::Nanoseconds(patience->AsPositiveDuration().ns());
  }
  if (const YamlValue* seed = top.Find("seed")) scenario->seed = seed->AsUnsigned64();
  if (const YamlValue* period = top.Find("csv_period")) {
    scenario->csv_period = period->AsPositiveDuration();
  }
  if (const YamlValue* contacts = top.Find("csv_contacts")) {
    scenario->csv_contacts = contacts->AsBoolean();
  }
}

// Free bodies pass through each other, on every engine; ODE has no other bodies.
void CheckContacts(const YamlMap& top, Scenario* scenario) {
  if (!scenario->csv_contacts || (scenario->world && !scenario->world->models.empty())) return;
  const YamlValue& contacts = *top.Find("csv_contacts");
  scenario->warnings.push_back(
      contacts.place().Prefix() + contacts.name() +
      " finds none to write, for nothing touches anything: free bodies have no shapes, and there "
      "is "
      "no model that moves; describe what touches under models, or remove it");
}

// `mistakes`: where all mistakes are noted; null: the first mistake is thrown.
Scenario Load(const std::string& path, const ScenarioOverrides& overrides, Mistakes* mistakes) {
  std::vector<Setting> settings;
  for (const std::string& overlay : overrides.overlays) {
    Append(ReadOverlay(overlay), &settings);
  }
  Append(SettingsOfOptions(overrides.set), &settings);
  const YamlMap top =
      ParseYaml(path, ReadText(path, "a scenario file"), settings, mistakes).AsMap();
  top.AllowOnly({"name", "duration", "drift", "patience", "seed", "csv_period", "csv_contacts",
                 "dynamics", "bodies", "models", "robots", "network", "channels", "chains", "clock",
                 "ros", "metrics", "expect"});
  Scenario scenario;
  scenario.path = path;
  for (const Setting& setting : settings) scenario.set.push_back(setting.text);
  scenario.name = fs::path(path).stem().string();
  top.place().Try([&] { LoadHead(top, &scenario); });
  const bool is_shortened =
      overrides.duration.has_value() && *overrides.duration < scenario.duration;
  scenario.duration = overrides.duration.value_or(scenario.duration);
  scenario.drift_bound = overrides.drift.value_or(scenario.drift_bound);
  if (overrides.patience) scenario.patience = HostDuration::Nanoseconds(overrides.patience->ns());
  scenario.seed = overrides.seed.value_or(scenario.seed);

  const Variables variables{scenario.seed, FolderOf(path), overrides.result_directory,
                            overrides.run};
  const YamlValue& all = top.place();
  const bool has_world = all.Try([&] { LoadWorld(top, variables, &scenario); });
  // Sections that are about bodies cannot be right if nobody has read the bodies.
  if (!has_world) return scenario;
  CheckContacts(top, &scenario);
  all.Try([&] { LoadRobots(top, variables, &scenario); });
  all.Try([&] { LoadNetwork(top, &scenario); });
  all.Try([&] { LoadChannels(top, variables, &scenario); });
  all.Try([&] { LoadChains(top, &scenario); });
  if (!all.HasMistakes()) CheckDdsTransports(top, &scenario);
  all.Try([&] { LoadMetrics(top, &scenario); });
  all.Try([&] { LoadExpect(top, is_shortened, &scenario); });
  // The world gives the clock, also a world with nothing else in it.
  if (scenario.clock && !scenario.world) scenario.world.emplace();
  return scenario;
}

}  // namespace

LoadResult<Scenario> LoadScenario(const std::string& path, const ScenarioOverrides& overrides) {
  try {
    return Load(path, overrides, nullptr);
  } catch (const ScenarioMistake& mistake) {
    return LoadError{mistake.message};
  }
}

std::variant<Scenario, std::vector<LoadError>> CheckScenario(const std::string& path,
                                                             const ScenarioOverrides& overrides) {
  Mistakes mistakes;
  std::vector<LoadError> errors;
  try {
    Scenario scenario = Load(path, overrides, &mistakes);
    if (mistakes.empty()) return scenario;
  } catch (const ScenarioMistake& mistake) {
    mistakes.Add(mistake);
  }
  for (const std::string& sentence : mistakes.Sentences(path)) errors.push_back({sentence});
  return errors;
}

LoadResult<std::vector<std::string>> LoadOverlay(const std::string& path) {
  try {
    std::vector<std::string> texts;
    for (Setting& setting : ReadOverlay(path)) texts.push_back(std::move(setting.text));
    return texts;
  } catch (const ScenarioMistake& mistake) {
    return LoadError{mistake.message};
  }
}

}  // namespace tcs
