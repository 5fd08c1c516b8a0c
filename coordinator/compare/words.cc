#include "coordinator/compare/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "coordinator/report/measure_words.h"
#include "coordinator/report/text.h"
#include "coordinator/text/text_table.h"

namespace tcs::compare {

namespace {

using WordsJson = nlohmann::ordered_json;

constexpr std::size_t kMostSentences = 5, kMostRows = 40;

std::string NameOf(const Finding& finding) {
  return finding.cell.empty() ? finding.figure
                              : fmt::format("{} at {}", finding.figure, finding.cell);
}

std::string SignedText(double value, MeasureUnit unit) {
  const std::string sign = value < 0 ? "-" : value > 0 ? "+" : "";
  return sign + report::MeasureText(std::abs(value), unit);
}

std::string RelativeText(const Finding& finding) {
  const auto relative = finding.Relative();
  if (!relative) return finding.difference.size == 0 ? "0 %" : "from 0";
  const double percent = 100 * *relative;
  return std::abs(percent) >= 1000 ? fmt::format("{:+.0f} x", 1 + *relative)
                                   : fmt::format("{:+.3g} %", percent);
}

std::string IntervalText(const Finding& finding) {
  const Difference& of = finding.difference;
  if (of.low == of.high) return SignedText(of.size, finding.unit);
  return fmt::format("{} to {}", SignedText(of.low, finding.unit),
                     SignedText(of.high, finding.unit));
}

std::string ChanceText(const Finding& finding) {
  if (finding.evidence == Evidence::kFixed) return "no";
  if (!finding.probability) return "not known";
  if (*finding.probability < 0.0001) return "< 0.0001";
  return fmt::format("{:.4f}", *finding.probability);
}

std::string_view WordOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kWorse:
      return "worse";
    case Outcome::kChanged:
      return "changed";
    case Outcome::kBetter:
      return "better";
    case Outcome::kSmall:
      return "small";
    case Outcome::kChance:
      return "chance";
    case Outcome::kUnjudged:
      return "unjudged";
  }
  return "";
}

std::string_view WordOf(Evidence evidence) {
  switch (evidence) {
    case Evidence::kTrials:
      return "trials";
    case Evidence::kParts:
      return "parts";
    case Evidence::kFixed:
      return "fixed";
    case Evidence::kNone:
      return "none";
  }
  return "";
}

std::string_view WordOf(MeasureUnit unit) {
  switch (unit) {
    case MeasureUnit::kCount:
      return "count";
    case MeasureUnit::kShare:
      return "share";
    case MeasureUnit::kSeconds:
      return "seconds";
    case MeasureUnit::kNumber:
      return "number";
  }
  return "";
}

// Why the difference is not chance.
std::string WhyReal(const Finding& finding) {
  switch (finding.evidence) {
    case Evidence::kFixed:
      return finding.figure == "run.failed"
                 ? "that is a fact"
                 : "with set costs runs repeat, so the difference is real for these seeds";
    case Evidence::kParts:
      return "the runs do not vary so much in themselves";
    case Evidence::kTrials:
    case Evidence::kNone:
      break;
  }
  const double probability = std::max(1e-4, finding.probability.value_or(1));
  return fmt::format(
      "chance makes that less than once in {} such comparisons",
      report::Grouped(static_cast<std::int64_t>(std::floor(1 / probability + 1e-9))));
}

std::string Sentence(const Finding& finding) {
  const bool worse = finding.outcome == Outcome::kWorse;
  return fmt::format("! {}: {} is {}, was {}: {} ({}); {}\n", worse ? "worse" : "changed",
                     NameOf(finding), report::MeasureText(finding.after, finding.unit),
                     report::MeasureText(finding.before, finding.unit), RelativeText(finding),
                     IntervalText(finding), WhyReal(finding));
}

std::string SizeText(const Side& side) {
  if (side.is_run) return side.folder + " (a run)";
  std::size_t trials = 0;
  for (const auto& [label, cell] : side.cells) trials += cell.trials + cell.failed;
  const std::string cells =
      side.keys.empty()
          ? ""
          : fmt::format(" over {} values of {}", side.cells.size(), report::Listed(side.keys));
  return fmt::format("{} ({}{})", side.folder,
                     report::Count(static_cast<std::int64_t>(trials), "trial"), cells);
}

bool IsShown(const Finding& finding) {
  return finding.outcome != Outcome::kChance && finding.outcome != Outcome::kSmall;
}

std::string TableOf(const Comparison& comparison) {
  TextTable table({{"", false},
                   {"figure", false},
                   {"A"},
                   {"B"},
                   {"difference"},
                   {"95 % interval"},
                   {"chance"}});
  std::size_t rows = 0;
  for (const Finding& finding : comparison.findings) {
    if (!IsShown(finding) || ++rows > kMostRows) continue;
    table.Row({std::string(WordOf(finding.outcome)), NameOf(finding),
               report::MeasureText(finding.before, finding.unit),
               report::MeasureText(finding.after, finding.unit), RelativeText(finding),
               IntervalText(finding), ChanceText(finding)});
  }
  if (rows == 0) return {};
  if (rows > kMostRows) table.Note(fmt::format("and {} more: --json has all", rows - kMostRows));
  return table.Text();
}

std::string AboutGone(const std::vector<std::string>& gone) {
  const std::size_t shown = std::min(gone.size(), kMostSentences);
  std::vector<std::string> names(gone.begin(), gone.begin() + static_cast<std::ptrdiff_t>(shown));
  if (shown < gone.size()) names.push_back(fmt::format("{} more", gone.size() - shown));
  return fmt::format(
      "! gone: B has no {}: it is called otherwise, or the client never got so far\n",
      report::Listed(names));
}

// No all-clear where nobody can tell.
std::string NothingSaid(const Comparison& comparison) {
  if (comparison.is_blind) return "nothing can be told from chance: there are too few trials\n";
  const std::size_t unjudged = comparison.Count(Outcome::kUnjudged);
  if (unjudged == 0) return "nothing became worse in B\n";
  return fmt::format(
      "nothing is known to have become worse in B, but {} beyond the tolerance, and one run of "
      "each "
      "does not tell whether by chance\n",
      unjudged == 1 ? "one figure differs" : fmt::format("{} figures differ", unjudged));
}

WordsJson JsonOf(const Side& side) {
  WordsJson cells = WordsJson::array();
  for (const auto& [label, cell] : side.cells) {
    cells.push_back({{"values", label}, {"trials", cell.trials}, {"failed", cell.failed}});
  }
  return {{"folder", side.folder},
          {"scenario", side.scenario},
          {"accounting", side.accounting},
          {"is_run", side.is_run},
          {"cells", cells}};
}

}  // namespace

std::string CompareText(const Side& a, const Side& b, const Comparison& comparison,
                        const JudgeOptions& options) {
  std::string text = fmt::format("A: {}\nB: {}\n", SizeText(a), SizeText(b));
  const std::size_t worse = comparison.Count(Outcome::kWorse);
  const std::size_t changed = comparison.Count(Outcome::kChanged);
  std::size_t said = 0;
  for (const Finding& finding : comparison.findings) {
    const bool counts = finding.outcome == Outcome::kWorse || finding.outcome == Outcome::kChanged;
    if (counts && ++said <= kMostSentences) text += Sentence(finding);
  }
  if (said > kMostSentences) text += fmt::format("! and {} more\n", said - kMostSentences);
  if (!comparison.gone.empty()) text += AboutGone(comparison.gone);
  if (said == 0 && comparison.gone.empty()) text += NothingSaid(comparison);
  if (const std::string table = TableOf(comparison); !table.empty()) text += "\n" + table;
  text += fmt::format(
      "\n{} compared: {} worse, {} changed, {} better, {} within {:g} %, {} not told from chance, "
      "{} "
      "not judged\n",
      report::Count(static_cast<std::int64_t>(comparison.findings.size()), "figure"), worse,
      changed, comparison.Count(Outcome::kBetter), comparison.Count(Outcome::kSmall),
      100 * options.tolerance, comparison.Count(Outcome::kChance),
      comparison.Count(Outcome::kUnjudged));
  return text;
}

std::string CompareJson(const Side& a, const Side& b, const Comparison& comparison,
                        const JudgeOptions& options) {
  WordsJson json{{"a", JsonOf(a)},
                 {"b", JsonOf(b)},
                 {"tolerance", options.tolerance},
                 {"confidence", options.confidence},
                 {"worse", comparison.IsWorse()},
                 {"warnings", comparison.warnings},
                 {"gone", comparison.gone},
                 {"figures", WordsJson::array()}};
  for (const Finding& finding : comparison.findings) {
    const auto optional = [](const std::optional<double>& value) {
      return value ? WordsJson(*value) : WordsJson();
    };
    json["figures"].push_back({{"figure", finding.figure},
                               {"values", finding.cell},
                               {"unit", WordOf(finding.unit)},
                               {"outcome", WordOf(finding.outcome)},
                               {"a", finding.before},
                               {"b", finding.after},
                               {"difference", finding.difference.size},
                               {"low", finding.difference.low},
                               {"high", finding.difference.high},
                               {"relative", optional(finding.Relative())},
                               {"evidence", WordOf(finding.evidence)},
                               {"chance", optional(finding.probability)}});
  }
  return json.dump(2, ' ', false, WordsJson::error_handler_t::replace) + "\n";
}

}  // namespace tcs::compare
