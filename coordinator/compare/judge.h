// Judges which figures became worse from one side to the other, by how much, and whether chance
// explains it. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/compare/difference.h"
#include "coordinator/compare/side.h"

namespace tcs::compare {

struct JudgeOptions {
  double tolerance = 0.05;            // a share of the figure's value before
  double confidence = 0.99;           // the share of equal sides of which nothing is said
  std::vector<std::string> measures;  // empty: the figures that are compared unasked
  std::vector<std::string> more_is_better,
      less_is_better;  // figures, or metrics with all of theirs
};

// The evidence that a difference is a real one.
enum class Evidence {
  kTrials,  // the rank-sum test over trials
  kParts,   // that test over parts of one run each: not how much runs differ from each other
  kFixed,   // runs with set costs repeat to the byte: whatever differs does so again
  kNone,
};

enum class Outcome {
  kWorse,
  kChanged,  // it is not known which way is the better one
  kBetter,
  kSmall,    // there is a difference, within the tolerance
  kChance,   // no difference that chance would not make
  kUnjudged  // beyond the tolerance, and nothing says whether by chance
};

struct Finding {
  std::string cell, figure;
  MeasureUnit unit = MeasureUnit::kNumber;
  // Medians over the trials; of counts and shares means.
  double before = 0, after = 0;
  Difference difference;
  Evidence evidence = Evidence::kNone;
  std::optional<double> probability;  // of chance, corrected for all that was tested
  Outcome outcome = Outcome::kChance;

  // The difference as a share of `before`; none if `before` is 0.
  [[nodiscard]] std::optional<double> Relative() const;
};

struct Comparison {
  std::vector<Finding> findings;  // by outcome, the greatest differences first
  std::vector<std::string> warnings;
  bool is_blind = false;  // there are too few trials to tell anything from chance
  // Figures of a that b does not have anywhere, "FIGURE at VALUES": a client that starved has no
  // such figure.
  std::vector<std::string> gone;

  [[nodiscard]] std::size_t Count(Outcome outcome) const;
  // Worse, changed or gone.
  [[nodiscard]] bool IsWorse() const;
};

// Compares the figures that both sides have in cells that both sides have. A warning names what
// cannot be compared.
[[nodiscard]] Comparison Judge(const Side& a, const Side& b, const JudgeOptions& options);

// Why the sides cannot be compared at all, or an option names nothing; else empty.
[[nodiscard]] std::string WhyNotComparable(const Side& a, const Side& b,
                                           const JudgeOptions& options);

}  // namespace tcs::compare
