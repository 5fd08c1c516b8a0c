#include "coordinator/scenario/mistakes.h"

#include <algorithm>
#include <limits>

namespace tcs {

void Mistakes::Add(const ScenarioMistake& mistake) {
  const auto is_same = [&](const ScenarioMistake& other) {
    return other.message == mistake.message;
  };
  if (mistake.message.empty() || std::any_of(all_.begin(), all_.end(), is_same)) return;
  all_.push_back(mistake);
}

bool Mistakes::IsOfMissing(std::string_view text) const {
  return std::any_of(missing_.begin(), missing_.end(), [text](const std::string& name) {
    return text == name || (text.starts_with(name) && text[name.size()] == '/') ||
           (text.starts_with(name) && text[name.size()] == '.');
  });
}

std::vector<std::string> Mistakes::Sentences(const std::string& file) const {
  std::vector<ScenarioMistake> sorted = all_;
  const auto line = [&file](const ScenarioMistake& mistake) {
    return mistake.place.source == file ? mistake.place.line : std::numeric_limits<int>::max();
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const auto& a, const auto& b) { return line(a) < line(b); });
  std::vector<std::string> sentences;
  for (const ScenarioMistake& mistake : sorted) sentences.push_back(mistake.message);
  return sentences;
}

}  // namespace tcs
