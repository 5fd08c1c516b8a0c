// The names that expressions of metrics may have in them, in a scenario. Internal to LoadScenario.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/scenario/scenario.h"

namespace tcs {

class MetricNames final : public ExpressionNames {
 public:
  // Of a scenario whose world and channels are loaded. Quantities that are named are appended to
  // `quantities`, each once; `scenario` and `quantities` outlive this.
  MetricNames(const Scenario& scenario, std::vector<QuantitySpec>* quantities);

  [[nodiscard]] std::variant<std::size_t, std::string> ValueOf(std::string_view name) override;
  [[nodiscard]] std::variant<std::array<std::size_t, 3>, std::string> PlaceOf(
      std::string_view name) override;

 private:
  void AddMoving(const std::string& name, QuantitySpec::Kind kind, std::size_t index);
  void AddJoints(const WorldSpec& world);
  void AddSensor(const Scenario& scenario, std::size_t index);
  void AddCommands(const CommandChannelSpec& channel, std::size_t index);
  void Add(const std::string& of, const std::string& quantity, QuantitySpec spec);
  void AddComponents(const std::string& of, const std::string& field, std::size_t components,
                     const QuantitySpec& spec);
  [[nodiscard]] std::string WhyUnknown(std::string_view name) const;
  std::size_t Numbered(const std::string& name, const QuantitySpec& spec);

  std::vector<QuantitySpec>& quantities_;
  std::map<std::string, QuantitySpec, std::less<>> known_;               // by whole name
  std::map<std::string, std::vector<std::string>, std::less<>> things_;  // by thing: what it has
  std::map<std::string, QuantitySpec, std::less<>> places_;              // things that have a place
  std::map<std::string, std::size_t, std::less<>> numbers_;              // of the named quantities
};

}  // namespace tcs
