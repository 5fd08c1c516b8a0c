// Plans how the arm takes parts off the belt and puts them into the bin. The belt does not wait:
// for each part the planner guesses how long planning and moving will take, plans to where the part
// will be then, and gives the part up when it has become too late for it. While the arm goes to a
// part, its way to the bin is planned; while it goes to the bin, its way to the next part.
//
//   planner SEED [PREFIX]     PREFIX: what comes before the sockets' names
//   in   arm/planner_joints  {"joints": {NAME: {"position": rad}, ...}}
//        arm/parts           {"part": NUMBER, "x": m, "y": m, "yaw": rad, "time": s, "belt": m/s}
//   out  arm/trajectory      (trajectory.h)
//        line/given_up       {"part": NUMBER, "why": TEXT}
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "examples/arm/cell.h"
#include "examples/arm/collisions.h"
#include "examples/arm/path_planner.h"
#include "examples/arm/pick.h"
#include "examples/arm/timing.h"
#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"

namespace arm {

using examples::Json;
using examples::Seconds;
using examples::Socket;
using examples::Ticks;

namespace {

constexpr unsigned kTries = 16;  // ways for each plan
constexpr double kDetour = 1.4;  // by which a way takes longer than the straight one
constexpr double kLookS = 0.1;   // between two places where a part could be taken
constexpr double kSpareS = 0.02;
constexpr double kMoreS = 0.5;  // to plan for where there is no hurry and nothing was found
constexpr std::array<double, 2> kNearRad = {-1, 1};  // how the last joint can be turned

// A way to take a part: where the tool is over it, and what it does from there.
struct Chance {
  double at_s;  // when the tool is at the part
  std::vector<Points> picks;

  double begin_s() const { return at_s - kDownS; }
  std::vector<Joints> Goals() const {
    std::vector<Joints> goals;
    for (const Points& pick : picks) goals.push_back(pick.front().position);
    return goals;
  }
  double QuickestFrom(const Joints& from) const {
    double least_s = 1e9;
    for (const Points& pick : picks) {
      least_s = std::min(least_s, QuickestS(from, pick.front().position));
    }
    return least_s;
  }
};

// Points that follow others.
Points Joined(Points points, const Points& more) {
  const double from_s = points.back().at_s;
  for (std::size_t i = 1; i < more.size(); ++i) {
    points.push_back({from_s + more[i].at_s, more[i].position, more[i].velocity});
  }
  return points;
}

class Picker {
 public:
  // What comes before the sockets' names.
  explicit Picker(std::string prefix)
      : prefix_(std::move(prefix)),
        paths_(std::max(1u, std::thread::hardware_concurrency()), kTries) {
    for (const double near_rad : kNearRad) {
      const auto over_bin = ToolDownAt(kOverBin, 0, near_rad);
      if (over_bin && IsFree(*over_bin)) over_bin_.push_back(*over_bin);
    }
  }

  void Run() {
    Ticks ticks(50);
    while (!FindSelf()) ticks.WaitForNext();
    for (;; ticks.WaitForNext()) {
      while (const auto message = parts_in_.Receive()) Remember(*message);
      while (!parts_.empty()) {
        const Part part = parts_.front();
        parts_.pop_front();
        if (Take(part)) PutAway();
        while (const auto message = parts_in_.Receive()) Remember(*message);
      }
    }
  }

 private:
  // Where the arm is at the beginning.
  bool FindSelf() {
    const auto message = joints_.ReceiveNewest();
    if (!message) return false;
    for (int i = 0; i < kJoints; ++i) {
      rest_[i] = message->at("joints").at(kArm[static_cast<std::size_t>(i)].name).at("position");
    }
    free_s_ = Seconds();
    return true;
  }

  void Remember(const Json& message) {
    parts_.push_back({message.at("part"), message.at("x"), message.at("y"), message.at("yaw"),
                      message.at("time"), message.at("belt")});
  }

  // Where the part can be taken first, if planning ends at the time `planned_s` and the way takes
  // so much longer than the straight one.
  std::optional<Chance> FirstChance(const Part& part, double planned_s, double detour) const {
    for (double at_s = std::max(part.TimeAt(kFirstY), planned_s + kDownS);
         at_s < part.TimeAt(kLastY); at_s += kLookS) {
      const Chance chance = ChanceAt(part, at_s);
      if (chance.picks.empty()) continue;
      const double leave_s = chance.begin_s() - detour * chance.QuickestFrom(rest_);
      if (leave_s > std::max(planned_s, free_s_)) return chance;
    }
    return std::nullopt;
  }

  static Chance ChanceAt(const Part& part, double at_s) {
    Chance chance{at_s, {}};
    for (const double near_rad : kNearRad) {
      if (auto pick = Pick(part, at_s, near_rad)) chance.picks.push_back(std::move(*pick));
    }
    return chance;
  }

  // Has the arm take the part, if it can be planned in time.
  bool Take(const Part& part) {
    double detour = kDetour;
    for (int tries = 0;; ++tries) {
      const double start_s = Seconds();
      const auto chance = FirstChance(part, start_s + takes_s_ + spare_s_, detour);
      if (!chance) {
        if (tries == 0) takes_s_ *= 0.8;  // it may take less than was thought
        GiveUp(part, tries == 0 ? "passed while it was busy" : "plan too late");
        return false;
      }
      const double quickest_s = chance->QuickestFrom(rest_);
      const double leave_by_s = chance->begin_s() - detour * quickest_s;
      const auto plan = paths_.Find(rest_, chance->Goals(), leave_by_s);
      const double took_s = Seconds() - start_s;
      takes_s_ = 1.2 * std::max(took_s, 0.6 * takes_s_);
      if (!plan) {
        Say(part, "nothing", took_s, 0);
        continue;
      }
      const double leave_s = chance->begin_s() - plan->points.back().at_s;
      const double left_s = leave_s - std::max(Seconds() + spare_s_, free_s_);
      Say(part, left_s < 0 ? "too late" : "in time", took_s, left_s);
      if (left_s >= 0) {
        Send(leave_s, Joined(plan->points, chance->picks[plan->goal]));
        return true;
      }
      detour = std::max(detour, 1.05 * plan->points.back().at_s / quickest_s);
    }
  }

  void PutAway() {
    std::optional<PathPlanner::Plan> plan;
    const double start_s = Seconds();
    // What is found while the arm takes the part; else what is found first.
    for (double until_s = free_s_; !plan; until_s = Seconds() + kMoreS) {
      plan = paths_.Find(rest_, over_bin_, until_s);
    }
    std::printf("%.3f s: to the bin, planned in %.0f ms\n", start_s, 1e3 * (Seconds() - start_s));
    std::fflush(stdout);
    Send(std::max(Seconds() + spare_s_, free_s_), plan->points);
  }

  void Send(double start_s, const Points& points) {
    const Trajectory trajectory(start_s, points);
    const double before_s = Seconds();
    joints_.Send(prefix_ + "arm/trajectory", trajectory.ToJson());
    spare_s_ = kSpareS + 3 * (Seconds() - before_s);
    free_s_ = trajectory.end_s();
    rest_ = points.back().position;
  }

  void GiveUp(const Part& part, const char* why) {
    joints_.Send(prefix_ + "line/given_up", {{"part", part.number}, {"why", why}});
    std::printf("%.3f s: part %d: %s\n", Seconds(), part.number, why);
    std::fflush(stdout);
  }

  static void Say(const Part& part, const char* what, double took_s, double left_s) {
    std::printf("%.3f s: part %d, planned in %.0f ms: %s, %.0f ms left\n", Seconds(), part.number,
                1e3 * took_s, what, 1e3 * left_s);
    std::fflush(stdout);
  }

  const std::string prefix_;
  Socket joints_{prefix_ + "arm/planner_joints"}, parts_in_{prefix_ + "arm/parts"};
  PathPlanner paths_;
  std::vector<Joints> over_bin_;
  std::deque<Part> parts_;
  Joints rest_;            // where the arm is once it has done what it was sent,
  double free_s_ = 0;      // and when
  double takes_s_ = 0.05;  // what planning is expected to take,
  double spare_s_ = 0.1;   // and the trajectory's way to the controller
};

}  // namespace
}  // namespace arm

int main(int argc, char** argv) {
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 1);
  arm::Picker(argc > 2 ? argv[2] : "").Run();
}
