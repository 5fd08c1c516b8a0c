// Whether trials came to what their scenario expects, each bound in its share of the trials. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/expect/judge.h"
#include "coordinator/expect/junit.h"
#include "coordinator/expect/share_interval.h"

namespace tcs {

// The judgement of one expectation, in one group of trials.
struct TrialsJudgement {
  ExpectationSpec expected;
  std::string group;  // the group's label
  std::int64_t held = 0, trials = 0;
  std::uint64_t first_seed = 0;  // of the first trial in which it did not hold
  std::string what;              // of that trial: "misses was 17, expected at most 0"

  [[nodiscard]] ShareInterval Interval() const { return ClopperPearson(held, trials); }
  // True if the share of trials in which the expectation held is the wanted one at least. False
  // without trials.
  [[nodiscard]] bool Holds() const;
};

// Counts the trials of one group.
class GroupJudge {
 public:
  GroupJudge(const std::vector<ExpectationSpec>& expectations, const std::string& group);
  // `judgements`: of a trial that is done, by its summary.json; an expectation that is not among
  // them did not hold.
  void Add(std::uint64_t seed, const std::vector<Judgement>& judgements);
  [[nodiscard]] const std::vector<TrialsJudgement>& judgements() const { return judgements_; }

 private:
  std::vector<TrialsJudgement> judgements_;
};

// "hover/controller: misses at most 0 held in 29 of 30 trials (82.8 % to 99.9 % …)…"
[[nodiscard]] std::string SentenceOf(const TrialsJudgement& judgement);

[[nodiscard]] JunitCase JunitCaseOf(const TrialsJudgement& judgement);

}  // namespace tcs
