#include "coordinator/cli/trials_expected.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "coordinator/cli/print.h"
#include "coordinator/expect/expect_json.h"
#include "coordinator/os/files.h"
#include "coordinator/os/say.h"
#include "coordinator/trials/outcome.h"

namespace tcs {

namespace {

std::vector<std::string> WarningsIn(const std::string& summary) {
  try {
    return nlohmann::json::parse(summary).at("warnings").get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

// The label of a plan's only group says nothing, and is left out.
std::string InGroup(const TrialsPlan& plan, const std::string& group) {
  return plan.vary.empty() ? "" : " (" + group + ")";
}

}  // namespace

bool JudgedTrials::IsAsExpected() const {
  return refused.empty() && std::ranges::all_of(judgements, &TrialsJudgement::Holds);
}

JudgedTrials JudgeTrials(const TrialsPlan& plan, const std::vector<Scenario>& scenarios,
                         const std::string& folder, bool strict) {
  const std::vector<std::string> labels = GroupLabels(plan);
  std::vector<GroupJudge> judges;
  for (std::size_t group = 0; group < scenarios.size(); ++group) {
    const std::string label = plan.vary.empty() ? "" : labels[group];
    judges.emplace_back(scenarios[group].expectations, label);
  }
  JudgedTrials judged;
  for (const Trial& trial : TrialsOf(plan)) {
    const std::string text = ReadText(folder + "/" + trial.folder + "/summary.json");
    if (!OutcomeFromJson(text, trial.seed).has_value()) continue;
    judges[trial.group].Add(trial.seed, ExpectationsFromSummary(text));
    if (!strict) continue;
    for (const std::string& warning : WarningsIn(text)) {
      judged.refused.push_back(
          fmt::format("seed {}{}: {}", trial.seed, InGroup(plan, labels[trial.group]), warning));
    }
  }
  for (const GroupJudge& judge : judges) {
    judged.judgements.insert(judged.judgements.end(), judge.judgements().begin(),
                             judge.judgements().end());
  }
  return judged;
}

void PrintJudged(const JudgedTrials& judged) {
  const auto failed = std::ranges::count_if(
      judged.judgements, [](const TrialsJudgement& one) { return !one.Holds(); });
  const auto all = static_cast<std::ptrdiff_t>(judged.judgements.size());
  if (all > 0) Print("{} of {} expectations hold\n", all - failed, all);
  std::fflush(stdout);
  for (const TrialsJudgement& one : judged.judgements) {
    if (one.Holds()) continue;
    Say(fmt::format("not as expected{}: {}", one.group.empty() ? "" : " with " + one.group,
                    SentenceOf(one)));
  }
  if (judged.refused.empty()) return;
  Say(fmt::format("trials had warnings ({}), and with --strict each is an error; the first: {}",
                  judged.refused.size(), judged.refused.front()));
}

std::string WriteJunit(const std::string& path, const TrialsPlan& plan, const JudgedTrials& judged,
                       const std::vector<std::string>& failures) {
  std::vector<JunitSuite> suites;
  for (const std::string& label : GroupLabels(plan)) {
    JunitSuite& suite = suites.emplace_back(JunitSuite{.name = label, .cases = {}});
    for (const TrialsJudgement& one : judged.judgements) {
      if (plan.vary.empty() || one.group == label) suite.cases.push_back(JunitCaseOf(one));
    }
  }
  JunitSuite trials{.name = "trials", .cases = {}};
  for (const std::string& failure : failures) {
    trials.cases.push_back({"tcsim", "does not fail", failure, failure});
  }
  for (const std::string& warning : judged.refused) {
    trials.cases.push_back({"tcsim", "has no warning", warning, warning});
  }
  if (trials.cases.empty()) trials.cases.push_back({"tcsim", "all are done", "", ""});
  suites.push_back(std::move(trials));
  return WriteWhole(path, JunitText(suites));
}

}  // namespace tcs
