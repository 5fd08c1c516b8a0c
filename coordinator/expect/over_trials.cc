#include "coordinator/expect/over_trials.h"

#include <fmt/format.h>

#include <algorithm>

namespace tcs {

namespace {

std::string HowOften(const TrialsJudgement& judgement) {
  const ShareInterval interval = judgement.Interval();
  return fmt::format(
      "held in {} of {} trials (95 % confidence: {:.1f} % to {:.1f} % of such trials)",
      judgement.held, judgement.trials, 100 * interval.low, 100 * interval.high);
}

}  // namespace

bool TrialsJudgement::Holds() const {
  // 0.95 of 20 is 19, whatever rounding makes of it.
  constexpr double kRounding = 1e-9;
  return trials > 0 && static_cast<double>(held) >=
                           expected.share * static_cast<double>(trials) * (1 - kRounding);
}

GroupJudge::GroupJudge(const std::vector<ExpectationSpec>& expectations, const std::string& group) {
  for (const ExpectationSpec& expected : expectations) {
    judgements_.push_back({.expected = expected, .group = group, .what = {}});
  }
}

void GroupJudge::Add(std::uint64_t seed, const std::vector<Judgement>& judgements) {
  for (TrialsJudgement& judgement : judgements_) {
    const auto found = std::ranges::find_if(judgements, [&](const Judgement& one) {
      return one.expected.subject == judgement.expected.subject &&
             one.expected.figure == judgement.expected.figure;
    });
    ++judgement.trials;
    if (found != judgements.end() && found->holds) {
      ++judgement.held;
      continue;
    }
    if (!judgement.what.empty()) continue;
    judgement.first_seed = seed;
    judgement.what = found != judgements.end() ? found->what : "its run did not judge it";
  }
}

std::string SentenceOf(const TrialsJudgement& judgement) {
  const ExpectationSpec& expected = judgement.expected;
  std::string sentence = fmt::format("{}{}: {} {} {}", expected.place, expected.subject,
                                     expected.figure, BoundText(expected), HowOften(judgement));
  if (expected.share < 1) sentence += fmt::format(", expected in {:g} %", 100 * expected.share);
  if (!judgement.what.empty()) {
    sentence += fmt::format("; with seed {} {}", judgement.first_seed, judgement.what);
  }
  return sentence;
}

JunitCase JunitCaseOf(const TrialsJudgement& judgement) {
  const ExpectationSpec& expected = judgement.expected;
  const std::string sentence = SentenceOf(judgement);
  return {expected.subject, expected.figure + " " + BoundText(expected),
          judgement.Holds() ? "" : sentence, sentence};
}

}  // namespace tcs
