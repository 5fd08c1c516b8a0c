// The figures of a run by name, as reports, comparisons and trials.json have them: the misses of a
// client are "rover/controller.misses", wherever they are asked for.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tcs {

enum class MeasureUnit { kNumber, kCount, kShare, kSeconds };

// Which way it may not go. Of figures that people name tcs knows nothing.
enum class WorseWhen { kMore, kLess, kUnknown };

struct Measure {
  double value = 0;
  MeasureUnit unit = MeasureUnit::kNumber;
  WorseWhen worse = WorseWhen::kUnknown;
  bool is_compared = false;  // `tcsim compare` looks at it unasked
};

// A figure of one kind of thing, which each of them may have or lack.
struct FigureName {
  std::string_view name;
  MeasureUnit unit;
};
[[nodiscard]] const std::vector<FigureName>& FiguresOfClient();
[[nodiscard]] const std::vector<FigureName>& FiguresOfChain();
[[nodiscard]] const std::vector<FigureName>& FiguresOfMetric();
[[nodiscard]] const std::vector<FigureName>& FiguresOfRun();

using Measures = std::map<std::string, Measure, std::less<>>;

// All that the text of a summary.json has: "CLIENT.misses", ".missed" (their share),
// ".response_p99" and so on, "chain NAME.age_p99", "NAME.last" of a metric, "run.drift". What it
// has no value of is left out. None if it is no such text.
[[nodiscard]] std::optional<Measures> MeasuresFromSummary(const std::string& text);

struct NameOrWhyNot {
  std::string name, why_not;  // one of both is empty
};

// The one of `names` that `wanted` means: itself, or the only one that ends in "/WANTED" or
// ".WANTED", so that a robot's or a section's name can be left out. Else the sentence that says why
// not; `what` is what they are: "measure".
[[nodiscard]] NameOrWhyNot FindName(std::string_view wanted, const std::vector<std::string>& names,
                                    std::string_view what);

}  // namespace tcs
