// The predator's planner: waits for a request, plans, answers; one line on stderr for each plan.

#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <cstdint>
#include <cstdio>
#include <limits>

#include "examples/predator_prey/common/dds_waitset.h"
#include "examples/predator_prey/common/predator_topics.h"
#include "examples/predator_prey/common/program.h"
#include "examples/predator_prey/predator_planner/pursuit_planner.h"

namespace predator_prey {
namespace {

struct Options {
  DdsOptions dds;
  std::uint32_t seed = 1;
  PlannerOptions planner;
};

void Log(const PlanReply& reply) {
  std::fprintf(stderr, "predator_planner: plan %llu: %.3f s, %llu states, %s, %.2f s long\n",
               static_cast<unsigned long long>(reply.id), reply.planning_time_s,
               static_cast<unsigned long long>(reply.states_explored),
               reply.steps.empty()  ? "no plan"
               : reply.reaches_goal ? "catches the prey"
                                    : "comes nearer",
               reply.plan_duration_s);
}

void Run(const Options& options) {
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(options.seed);
  PursuitPlanner planner(options.planner);

  const DdsEntity participant = JoinDomain(options.dds);
  // In this order: who finds a writer of plans asks it for one.
  Reader<PlanRequestMessage> requests(PlanRequestTopic(participant, options.dds.predator));
  Writer<PlanMessage> plans(PlanTopic(participant, options.dds.predator));
  Waitset waitset(participant);
  waitset.Attach(requests.has_samples());

  for (;;) {
    waitset.Wait();
    const auto request = requests.TakeNewest();
    if (!request) continue;
    const PlanReply reply = planner.Plan(FromMessage(*request));
    plans.Write(PlanToWrite(reply).message());
    Log(reply);
    planner.Forget();
  }
}

}  // namespace
}  // namespace predator_prey

int main(int argc, char** argv) {
  using namespace predator_prey;
  Options options;
  CommandLine command_line("Plans how the predator catches the prey.", "predator_planner");
  AddDdsOptions(command_line, options.dds);
  command_line.Add("--seed", options.seed, "seed of the planner's random numbers, 1 or more",
                   Accept::kPositive);
  command_line.Add("--budget", options.planner.budget_s, "how long to plan [s]", Accept::kPositive);
  command_line.AddUnlessTold("--iterations", options.planner.iterations,
                             "plan for so many iterations, however long they take, not for a time",
                             1, std::numeric_limits<int>::max());
  command_line.AddBetween("--reply-duration", options.planner.reply_s,
                          "how much of a plan to send back [s]", 0.01, 1.0);
  command_line.Add("--flee-distance", options.planner.model.flee_distance_m,
                   "the prey is taken to flee when the predator is nearer [m]",
                   Accept::kNotNegative);
  return command_line.Run(argc, argv, [&] { Run(options); });
}
