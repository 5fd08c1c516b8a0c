// The predator's controller. Over and over: (1) read the state, (2) send it to the planner, (3)
// wait for the plan, coasting, (4) execute the beginning of the plan, 100 commands a second.

#include <chrono>
#include <optional>
#include <utility>

#include "examples/predator_prey/common/dds_waitset.h"
#include "examples/predator_prey/common/monotonic_clock.h"
#include "examples/predator_prey/common/predator_topics.h"
#include "examples/predator_prey/common/program.h"
#include "examples/predator_prey/common/ticks.h"
#include "examples/predator_prey/predator_controller/plan_follower.h"
#include "examples/predator_prey/predator_controller/plan_requester.h"

namespace predator_prey {
namespace {

struct Options {
  DdsOptions dds;
  std::string prey = "prey";  // namespace of its topics
  double request_timeout_s = 3.0;
  FollowerOptions follower;
};

// Where a body was last seen.
class Sight {
 public:
  Sight(const DdsEntity& participant, const std::string& name_space)
      : odometry_(OdometryTopic(participant, name_space)) {}

  const DdsEntity& has_news() const { return odometry_.has_samples(); }

  void Update() {
    if (const auto newest = odometry_.TakeNewest()) body_ = FromMessage(*newest);
  }

  const std::optional<BodyState>& body() const { return body_; }

 private:
  Reader<OdometryMessage> odometry_;
  std::optional<BodyState> body_;
};

void Run(const Options& options) {
  const DdsEntity participant = JoinDomain(options.dds);
  Sight predator(participant, options.dds.predator);
  Sight prey(participant, options.prey);
  Writer<WrenchMessage> wrenches(WrenchTopic(participant, options.dds.predator));
  PlanRequester planner(participant, options.dds.predator, options.request_timeout_s);
  PlanFollower follower(options.follower);

  Waitset waitset(participant);
  waitset.Attach(predator.has_news());
  waitset.Attach(prey.has_news());
  waitset.Attach(planner.has_plan());
  Ticks ticks(std::chrono::duration_cast<Ticks::Clock::duration>(
      std::chrono::duration<double>(options.follower.period_s)));

  for (;;) {
    waitset.WaitUntil(ticks.next());
    predator.Update();
    prey.Update();
    bool act = ticks.Take() > 0;
    if (auto reply = planner.TakeReply()) {
      follower.Start(std::move(reply->steps), MonotonicSeconds());
      act = true;  // at once, not at the next tick
    }
    if (!act || !predator.body() || !prey.body()) continue;

    const double now_s = MonotonicSeconds();
    const std::optional<Wrench> control = follower.Control(now_s, *predator.body());
    if (!control) planner.RequestIfIdle(now_s, *predator.body(), *prey.body());
    wrenches.Write(ToMessage(control.value_or(Wrench{})));
  }
}

void AddFollowerOptions(CommandLine& command_line, FollowerOptions& follower) {
  const auto add = [&command_line](const char* name, double& value, const char* help) {
    command_line.Add(name, value, help, Accept::kNotNegative);
  };
  add("--execute", follower.execute_s, "how much of a plan is executed [s]");
  add("--kp", follower.kp_per_s2, "feedback of position [1/s²]");
  add("--kd", follower.kd_per_s, "feedback of velocity [1/s]");
  add("--mass", follower.mass_kg, "[kg]");
  add("--inertia", follower.inertia_kgm2, "[kg m²]");
  add("--max-force", follower.max_force_n, "per axis [N]");
  add("--max-torque", follower.max_torque_nm, "per axis [N m]");
}

}  // namespace
}  // namespace predator_prey

int main(int argc, char** argv) {
  using namespace predator_prey;
  Options options;
  CommandLine command_line("Controls the predator along the plans of predator_planner.",
                           "predator_controller");
  AddDdsOptions(command_line, options.dds);
  AddNamespace(command_line, "--prey-namespace", options.prey, "namespace of the prey's topics");
  command_line.Add("--request-timeout", options.request_timeout_s,
                   "ask again when a plan does not come for so long [s]", Accept::kPositive);
  AddFollowerOptions(command_line, options.follower);
  return command_line.Run(argc, argv, [&] { Run(options); });
}
