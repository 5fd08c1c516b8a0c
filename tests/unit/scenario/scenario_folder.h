// A folder for one test, with scenarios and programs in it; gone afterwards.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "coordinator/scenario/load.h"

namespace tcs {

class ScenarioFolder {
 public:
  // Holds ./controller, a dynamically linked program.
  ScenarioFolder();
  ~ScenarioFolder();
  ScenarioFolder(const ScenarioFolder&) = delete;
  ScenarioFolder& operator=(const ScenarioFolder&) = delete;

  std::string Path(std::string_view name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

  // Each returns the absolute path of what it made.
  std::string Write(std::string_view name, std::string_view text) const;
  std::string WriteExecutable(std::string_view name, std::string_view text) const;
  std::string Copy(std::string_view program, std::string_view name) const;
  // A copy of the dynamically linked program with bytes replaced.
  std::string Patch(std::string_view name, std::size_t offset, std::string_view bytes) const;

 private:
  std::filesystem::path path_;
};

// A scenario without mistakes, which uses every section. Its lines are counted on by the tests.
extern const std::string_view kGoodScenario;

// The same world on DDS.
extern const std::string_view kGoodDdsScenario;

// kGoodScenario, or `text`, with `from`, which must occur once, replaced.
std::string WithReplaced(std::string_view from, std::string_view to,
                         std::string_view text = kGoodScenario);

// What was loaded; a failure of the test and an empty scenario if it was refused.
Scenario ScenarioOf(LoadResult<Scenario> result);

// Why it was refused, in one line, without the "FOLDER/" of a mistake in a file of the folder; ""
// if it was not.
std::string Complaint(const ScenarioFolder& folder, const LoadResult<Scenario>& result);

// The same of the `text` as FOLDER/s.yaml, in which the mistake must be.
std::string Complaint(const ScenarioFolder& folder, std::string_view text);

}  // namespace tcs
