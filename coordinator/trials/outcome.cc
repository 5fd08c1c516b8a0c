#include "coordinator/trials/outcome.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "coordinator/text/csv.h"

namespace tcs {

std::optional<TrialOutcome> OutcomeFromJson(const std::string& text, std::uint64_t seed) {
  try {
    const auto json = nlohmann::json::parse(text);
    if (json.at("interrupted").get<bool>() || json.at("seed").get<std::uint64_t>() != seed) {
      return {};
    }
    // The summary of a run without clients has no such object.
    for (const auto& client : json.value("clients", nlohmann::json::object())) {
      if (client.at("ended_at_ns").get<std::int64_t>() >= 0 &&
          client.at("wait_status").get<int>() != 0) {
        return {};
      }
    }
    return TrialOutcome{json.at("virtual_ns"), json.at("real_ns"), json.at("drift_ns"),
                        json.at("staleness_ns"), json.at("overhead_percent")};
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

std::string ReadText(const std::string& path) { return ReadFile(path).value_or(""); }

std::optional<TrialOutcome> ReadOutcome(const std::string& folder, std::uint64_t seed) {
  return OutcomeFromJson(ReadText(folder + "/summary.json"), seed);
}

std::string LastWords(const std::string& said) {
  const std::string mark = "tcsim: ", warning = "tcsim: warning: ",
                    waiting = "tcsim: other runs of tcsim have";
  const auto begins = [](const std::string& line, const std::string& with) {
    return line.compare(0, with.size(), with) == 0;
  };
  std::string sentence, last;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || begins(line, waiting) || begins(line, warning)) continue;
    last = line;
    if (begins(line, mark)) sentence = line.substr(mark.size());
  }
  return sentence.empty() ? last : sentence;
}

}  // namespace tcs
