#include "coordinator/fit/fit_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/fit/fragment.h"

namespace tcs::fit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MeasuredRun RunOf(const std::string& name, const MeasuredClient& client) {
  MeasuredRun run;
  run.folder = "measured";
  run.scenario = "chase";
  run.clients[name] = client;
  return run;
}

TEST(FitTable, SaysCostsAndDistributionsSideBySide) {
  MeasuredClient client;
  client.activations = {{10'000, 10, 0}, {20'000, 20, 0}, {30'000, 30, 0}};
  client.whole = {60'000, 60, 0};
  const MeasuredRun run = RunOf("r/controller", client);
  EXPECT_EQ(FitTable(run, FitAll(run)),
            "measured | with these costs   a call  an allocation     charged in all  activations' "
            "median         95 % below            longest  misfit\n"
            "r/controller                 1.00 us              -  60.0 us | 60.0 us    20.0 us | "
            "20.0 us  29.0 us | 29.0 us  30.0 us | 30.0 us     0 %\n");
  EXPECT_THAT(FitWarnings(run, FitAll(run)), IsEmpty());
}

TEST(FitTable, WithoutActivationsItSaysTheSumsAlone) {
  MeasuredClient client;
  client.whole = {60'000, 60, 0};
  const MeasuredRun run = RunOf("r/late", client);
  EXPECT_THAT(FitTable(run, FitAll(run)), HasSubstr("60.0 us | 60.0 us"));
}

TEST(FitWarnings, NameWhoComputesWithoutEither) {
  MeasuredClient client;
  client.whole = {2e9, 0, 0};
  const MeasuredRun run = RunOf("r/spinner", client);
  EXPECT_THAT(FitWarnings(run, FitAll(run)),
              ElementsAre("r/spinner has computed 2.00 s without a call or an allocation, which "
                          "fixed accounting cannot charge: run it with --accounting measured"));
  EXPECT_THAT(FragmentOf(run, FitAll(run)), HasSubstr("\nrobots: {}\n"));
}

TEST(FitWarnings, NameWhoComputesLongFromOneToTheNext) {
  MeasuredClient client;
  client.whole = {2e9, 10, 10};
  const MeasuredRun run = RunOf("r/detector", client);
  EXPECT_THAT(FitWarnings(run, FitAll(run)),
              ElementsAre(HasSubstr("r/detector computes 100 ms from one call or allocation to")));
}

TEST(FitWarnings, NameWhoseCallsDoNotTell) {
  MeasuredClient client;
  client.activations = {{0, 10, 0}, {100'000, 10, 0}};
  client.whole = {100'000, 20, 0};
  const MeasuredRun run = RunOf("r/moody", client);
  EXPECT_THAT(FitWarnings(run, FitAll(run)),
              ElementsAre(HasSubstr("a single one 100 % more or less")));
}

TEST(Fragment, IsAPieceOfAScenario) {
  MeasuredRun run = RunOf("hunter/controller", {1, {60'000, 60, 0}, {}});
  run.clients["hunter/null"] = {1, {9'000, 5, 2}, {}};
  run.clients["prey/1.5"] = {0.5, {4'000, 0, 2}, {}};
  run.clients["prey/idle"] = {0.5, {0, 0, 0}, {}};
  run.scenario = "chase\nof two";
  EXPECT_EQ(FragmentOf(run, FitAll(run)),
            "# What calls and allocations cost each client of chase of two, measured in measured.\n"
            "# By `tcsim fit`, for `tcsim run SCENARIO --accounting fixed --overlay THIS`.\n"
            "robots:\n"
            "  hunter:  # speed 1\n"
            "    clients:\n"
            "      controller: {fixed_call_cost: 1000ns}\n"
            "      'null': {fixed_call_cost: 1000ns, fixed_allocation_cost: 2000ns}\n"
            "  prey:  # speed 0.5\n"
            "    clients:\n"
            "      '1.5': {fixed_allocation_cost: 2000ns}\n");
}

}  // namespace
}  // namespace tcs::fit
