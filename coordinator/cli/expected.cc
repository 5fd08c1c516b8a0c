#include "coordinator/cli/expected.h"

#include <fmt/format.h>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/engine/failures.h"

namespace tcs {

namespace {

std::string Warnings(std::size_t count) {
  return count == 1 ? "a warning" : fmt::format("{} warnings", count);
}

}  // namespace

void PrintJudgements(const std::vector<Judgement>& judgements, std::size_t not_judged) {
  const std::vector<const Judgement*> failed = Failed(judgements);
  if (!judgements.empty()) {
    Print("{} of {} expectations hold\n", judgements.size() - failed.size(), judgements.size());
  }
  if (not_judged > 0) {
    Print("{} only after the end that was asked for: not judged\n",
          not_judged == 1 ? "1 expectation begins"
                          : fmt::format("{} expectations begin", not_judged));
  }
  for (const Judgement* judgement : failed) Say("not as expected: " + SentenceOf(*judgement));
}

int RefuseWarnings(const Scenario& scenario) {
  for (const std::string& warning : scenario.warnings) Say("warning: " + warning);
  return Fail(
      fmt::format("the scenario has {}, and with --strict each is an error; correct it, or "
                  "leave --strict out",
                  Warnings(scenario.warnings.size())));
}

void SayRefused(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  Say(fmt::format("the run had {}, and with --strict each is an error; the first: {}",
                  Warnings(warnings.size()), warnings.front()));
}

JunitSuite JunitSuiteOf(const Scenario& scenario, const RunReport& report,
                        const std::vector<Judgement>& judgements,
                        const std::vector<std::string>& refused) {
  JunitSuite suite{scenario.name, static_cast<double>(report.real_ns) * 1e-9, {}};
  for (const ClientReport& client : report.clients) {
    const std::string failure = HasFailed(client) ? HowItEnded(client) : "";
    suite.cases.push_back({client.name, "does not fail", failure, failure});
  }
  for (JunitCase& one : JunitCases(judgements)) suite.cases.push_back(std::move(one));
  for (const std::string& warning : refused) {
    suite.cases.push_back({"tcsim", "has no warning", warning, warning});
  }
  return suite;
}

}  // namespace tcs
