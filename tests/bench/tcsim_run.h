// Runs of tcsim for what they measure.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tcs::bench {

// A run that ended in order, with its results, which go with this.
class TcsimRun {
 public:
  // Runs the scenario, YAML or JSON, with more options of `tcsim run`. None, with a sentence on
  // stderr that begins with `name`, if it did not end in order.
  static std::optional<TcsimRun> Of(const std::string& name, const std::string& scenario,
                                    const std::vector<std::string>& options = {});

  TcsimRun(TcsimRun&& other) noexcept;
  TcsimRun& operator=(TcsimRun&&) = delete;
  ~TcsimRun();

  const nlohmann::json& summary() const { return summary_; }
  // What a client has said: "ROBOT-CLIENT".
  std::string OutputOf(const std::string& client) const;
  double cpu_seconds() const { return cpu_seconds_; }

 private:
  explicit TcsimRun(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path folder_;  // empty: it is another one's by now
  nlohmann::json summary_;
  double cpu_seconds_ = 0;
};

}  // namespace tcs::bench
