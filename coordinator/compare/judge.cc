#include "coordinator/compare/judge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "coordinator/compare/correction.h"
#include "coordinator/compare/figure_names.h"
#include "coordinator/compare/rank_sum.h"
#include "coordinator/compare/side_warnings.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/text.h"

namespace tcs::compare {

namespace {

constexpr std::size_t kFewestParts = 8;
constexpr std::size_t kMostTrialsAdvised = 1000;

std::vector<std::string> FiguresOf(const Side& side) {
  std::set<std::string> names;
  for (const auto& [label, cell] : side.cells) {
    for (const auto& [name, sample] : cell.samples) names.insert(name);
  }
  return {names.begin(), names.end()};
}

bool IsCounted(MeasureUnit unit) {
  return unit == MeasureUnit::kCount || unit == MeasureUnit::kShare;
}

double Typical(const std::vector<double>& values, MeasureUnit unit) {
  const report::Spread spread = report::SpreadOf(values);
  return IsCounted(unit) ? spread.mean : spread.median;
}

WorseWhen DirectionOf(const std::string& figure, const Measure& kind, const JudgeOptions& options) {
  if (IsAmong(figure, options.more_is_better)) return WorseWhen::kLess;
  if (IsAmong(figure, options.less_is_better)) return WorseWhen::kMore;
  return kind.worse;
}

class Judgement {
 public:
  Judgement(const Side& a, const Side& b, const JudgeOptions& options)
      : a_(a), b_(b), options_(options), are_fixed_(a.IsFixed() && b.IsFixed()) {}

  Comparison Take() {
    for (const auto& [label, cell] : a_.cells) {
      const auto other = b_.cells.find(label);
      if (other != b_.cells.end()) Compare(label, cell, other->second);
    }
    comparison_.warnings =
        WarningsOf(a_, b_, {only_b_.begin(), only_b_.end()}, {rarer_.begin(), rarer_.end()});
    Correct();
    for (Pending& pending : pending_) {
      pending.finding.outcome = OutcomeOf(pending);
      comparison_.findings.push_back(std::move(pending.finding));
    }
    std::stable_sort(comparison_.findings.begin(), comparison_.findings.end(),
                     [](const Finding& x, const Finding& y) {
                       if (x.outcome != y.outcome) return x.outcome < y.outcome;
                       const auto size = [](const Finding& f) {
                         return std::abs(f.Relative().value_or(1e300));
                       };
                       return size(x) > size(y);
                     });
    WarnOfEvidence();
    return std::move(comparison_);
  }

 private:
  struct Pending {
    Finding finding;
    WorseWhen worse = WorseWhen::kUnknown;
    std::size_t a = 0, b = 0;  // values
  };

  void Compare(const std::string& label, const Cell& a, const Cell& b) {
    for (const auto& [name, sample] : a.samples) {
      if (!IsWanted(name, sample.kind)) continue;
      const auto other = b.samples.find(name);
      if (other == b.samples.end()) {
        comparison_.gone.push_back(label.empty() ? name : name + " at " + label);
        continue;
      }
      // Trials that never got so far have no value: without a warning b would look well.
      if (ShareOf(b, other->second) < ShareOf(a, sample)) rarer_.insert(name);
      Compare(label, name, a, b, sample, other->second);
    }
    for (const auto& [name, sample] : b.samples) {
      if (IsWanted(name, sample.kind) && !a.samples.contains(name)) only_b_.insert(name);
    }
  }

  // The share of trials that have the figure.
  static double ShareOf(const Cell& cell, const Sample& sample) {
    return static_cast<double>(sample.values.size()) /
           static_cast<double>(std::max<std::size_t>(1, cell.trials));
  }

  bool IsWanted(const std::string& name, const Measure& kind) const {
    return options_.measures.empty() ? kind.is_compared : IsAmong(name, options_.measures);
  }

  void Compare(const std::string& label, const std::string& name, const Cell& cell_a,
               const Cell& cell_b, const Sample& a, const Sample& b) {
    Pending pending;
    Finding& finding = pending.finding;
    finding.cell = label;
    finding.figure = name;
    finding.unit = b.kind.unit;
    finding.before = Typical(a.values, finding.unit);
    finding.after = Typical(b.values, finding.unit);
    pending.worse = DirectionOf(name, b.kind, options_);
    pending.a = a.values.size();
    pending.b = b.values.size();
    const bool are_single =
        cell_a.trials + cell_a.failed <= 1 && cell_b.trials + cell_b.failed <= 1;
    if (are_fixed_ && a.seeds == b.seeds) {
      finding.evidence = Evidence::kFixed;
      finding.difference = PairedDifference(a.values, b.values, finding.unit);
    } else if (are_single) {
      CompareSingle(name, cell_a, cell_b, &finding);
    } else {
      finding.evidence = Evidence::kTrials;
      finding.difference = IsCounted(finding.unit) ? MeanDifference(a.values, b.values)
                                                   : ShiftBetween(a.values, b.values);
      finding.probability = RankSumProbability(a.values, b.values);
    }
    pending_.push_back(std::move(pending));
  }

  static Difference PairedDifference(const std::vector<double>& a, const std::vector<double>& b,
                                     MeasureUnit unit) {
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) differences[i] = b[i] - a[i];
    const auto [least, most] = std::minmax_element(differences.begin(), differences.end());
    return {Typical(differences, unit), *least, *most};
  }

  static void CompareSingle(const std::string& name, const Cell& a, const Cell& b,
                            Finding* finding) {
    const double size = finding->after - finding->before;
    finding->difference = {size, size, size};
    // A program's failure is a fact, whatever made the program fail.
    if (name == "run.failed") finding->evidence = Evidence::kFixed;
    const auto first = a.parts.find(name), second = b.parts.find(name);
    if (first == a.parts.end() || second == b.parts.end()) return;
    if (std::min(first->second.size(), second->second.size()) < kFewestParts) return;
    finding->evidence = Evidence::kParts;
    const Difference between = IsCounted(finding->unit)
                                   ? MeanDifference(first->second, second->second)
                                   : ShiftBetween(first->second, second->second);
    finding->difference.low = std::min(size, between.low);
    finding->difference.high = std::max(size, between.high);
    finding->probability = RankSumProbability(first->second, second->second);
  }

  void Correct() {
    std::vector<double> probabilities;
    for (const Pending& pending : pending_) {
      if (pending.finding.probability) probabilities.push_back(*pending.finding.probability);
    }
    tested_ = probabilities.size();
    const std::vector<double> corrected = Corrected(probabilities);
    auto next = corrected.begin();
    for (Pending& pending : pending_) {
      if (pending.finding.probability) pending.finding.probability = *next++;
    }
  }

  bool IsBeyond(const Finding& finding) const {
    return std::abs(finding.difference.size) >
           options_.tolerance * std::abs(finding.before) + 1e-12 * std::abs(finding.before);
  }

  Outcome OutcomeOf(const Pending& pending) const {
    const Finding& finding = pending.finding;
    const double size = finding.difference.size;
    if (finding.evidence == Evidence::kNone) {
      return IsBeyond(finding) ? Outcome::kUnjudged : Outcome::kSmall;
    }
    const bool is_real = finding.evidence == Evidence::kFixed
                             ? finding.difference.low != 0 || finding.difference.high != 0
                             : finding.probability.value_or(1) < 1 - options_.confidence;
    if (!is_real) return Outcome::kChance;
    if (!IsBeyond(finding)) return Outcome::kSmall;
    if (pending.worse == WorseWhen::kUnknown) return Outcome::kChanged;
    return (size > 0) == (pending.worse == WorseWhen::kMore) ? Outcome::kWorse : Outcome::kBetter;
  }

  void Warn(std::string sentence) { comparison_.warnings.push_back(std::move(sentence)); }

  // In runs with set costs every difference is real, if their seeds are the same.
  void WarnOfSeeds() {
    const auto seed_of = [](const Side& side) {
      return side.cells.begin()->second.samples.begin()->second.seeds.front();
    };
    const std::uint64_t a = seed_of(a_), b = seed_of(b_);
    if (a == b) return;
    Warn(fmt::format(
        "{} has the seed {}, and {} has {}: with set costs runs of one seed repeat, and "
        "whatever differs is real, but nobody can tell what another seed does; compare "
        "runs of one seed, or sets of trials (tcsim trials)",
        a_.folder, a, b_.folder, b));
  }

  // Warns of figures that may be worse, and are not called so.
  void WarnOfEvidence() {
    const bool are_runs = a_.is_run && b_.is_run;
    if (are_runs && are_fixed_) WarnOfSeeds();
    if (are_runs && !are_fixed_) {
      Warn(
          "from one run of each nobody can tell how much runs differ by chance; response times, "
          "execution times and misses are judged by how they vary within the runs, the others not "
          "at all: compare sets of trials (tcsim trials)");
    }
    std::size_t fewest = 0;  // of the figure that most trials have
    for (const Pending& pending : pending_) {
      if (pending.finding.evidence != Evidence::kTrials) continue;
      fewest = std::max(fewest, std::min(pending.a, pending.b));
    }
    const double limit =
        (1 - options_.confidence) / static_cast<double>(std::max<std::size_t>(1, tested_));
    if (fewest == 0 || LeastRankSumProbability(fewest, fewest) < limit) return;
    comparison_.is_blind = true;
    std::size_t enough = fewest;
    while (enough < kMostTrialsAdvised && LeastRankSumProbability(enough, enough) >= limit)
      ++enough;
    Warn(
        fmt::format("{} are too few to tell any difference of {} from chance: make at least {} of "
                    "each, or choose figures with --measure",
                    report::Count(static_cast<std::int64_t>(fewest), "trial"),
                    report::Count(static_cast<std::int64_t>(tested_), "figure"), enough));
  }

  const Side& a_;
  const Side& b_;
  const JudgeOptions& options_;
  const bool are_fixed_;
  std::vector<Pending> pending_;
  std::set<std::string> only_b_, rarer_;
  std::size_t tested_ = 0;
  Comparison comparison_;
};

}  // namespace

std::optional<double> Finding::Relative() const {
  if (before == 0) return {};
  return difference.size / std::abs(before);
}

std::size_t Comparison::Count(Outcome outcome) const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const Finding& finding) { return finding.outcome == outcome; }));
}

bool Comparison::IsWorse() const {
  return Count(Outcome::kWorse) + Count(Outcome::kChanged) + gone.size() > 0;
}

Comparison Judge(const Side& a, const Side& b, const JudgeOptions& options) {
  return Judgement(a, b, options).Take();
}

std::string WhyNotComparable(const Side& a, const Side& b, const JudgeOptions& options) {
  if (a.is_run != b.is_run) {
    const Side &run = a.is_run ? a : b, &trials = a.is_run ? b : a;
    return fmt::format(
        "{} is one run, and {} are trials; compare runs with runs (that is a folder like "
        "{}/seed-0001) "
        "or trials with trials",
        run.folder, trials.folder, trials.folder);
  }
  if (a.keys != b.keys) {
    const auto said = [](const Side& side) {
      return side.keys.empty() ? std::string("nothing")
                               : fmt::format("{}", fmt::join(side.keys, ", "));
    };
    return fmt::format("{} varies {}, and {} varies {}; compare trials over the same keys",
                       a.folder, said(a), b.folder, said(b));
  }
  const bool meet = std::any_of(a.cells.begin(), a.cells.end(),
                                [&](const auto& cell) { return b.cells.contains(cell.first); });
  if (!meet) {
    return fmt::format("{} and {} have no values of {} in common (the one has {}, the other {})",
                       a.folder, b.folder, fmt::join(a.keys, ", "), a.cells.begin()->first,
                       b.cells.begin()->first);
  }
  std::vector<std::string> figures = FiguresOf(a);
  const std::vector<std::string> others = FiguresOf(b);
  figures.insert(figures.end(), others.begin(), others.end());
  for (const auto* names : {&options.measures, &options.more_is_better, &options.less_is_better}) {
    for (const std::string& name : *names) {
      if (std::any_of(figures.begin(), figures.end(),
                      [&](const std::string& figure) { return NameMeans(name, figure); })) {
        continue;
      }
      return FindName(name, FiguresOf(a), "measure").why_not;
    }
  }
  return {};
}

}  // namespace tcs::compare
