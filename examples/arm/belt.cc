// Not the arm's: the belt that parts come along on, the camera that sees them come, and the judge
// of what becomes of them. A part is taken when the cup is at it, moves with it and is turned as it
// is; one at a time, until the arm has let go of it over the bin.
//
//   belt SEED PARTS [PREFIX]     PREFIX: what comes before the sockets' names
//   in   line/tool      {"position": [...], "orientation": [...], "linear_velocity": [...]} of the
//   cup
//        line/given_up  {"part": NUMBER, "why": TEXT}, by the arm's planner
//   out  arm/parts      {"part": NUMBER, "x": m, "y": m, "yaw": rad, "time": s, "belt": m/s}
//                       once each, when the camera sees it; time: of CLOCK_MONOTONIC
//   prints what becomes of each part, and a line that sums it up
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "examples/arm/cell.h"
#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"

namespace arm {

using examples::Json;
using examples::Seconds;
using examples::Socket;
using examples::Ticks;

namespace {

constexpr double kBeltMps = 0.2;
constexpr double kNearM = 0.006, kSlowMps = 0.03, kTurnRad = 0.05;  // where a part is sucked on
constexpr double kBinM = 0.05, kCameM = 0.1;
constexpr double kAfterS = 5;  // for the last part's way to the bin, or why it was missed

struct Tool {
  Vector3d at_m, velocity_mps;
  double yaw_rad;
};

Tool ToolOf(const Json& odometry) {
  const auto vector = [](const Json& list) { return Vector3d(list.at(0), list.at(1), list.at(2)); };
  const Json& q = odometry.at("orientation");
  const Eigen::Quaterniond turn(q.at(3), q.at(0), q.at(1), q.at(2));
  const Vector3d x = turn * Vector3d::UnitX();
  return {vector(odometry.at("position")), turn * vector(odometry.at("linear_velocity")),
          std::atan2(x.y(), x.x())};
}

struct OnBelt {
  int number;
  double x, yaw_rad, seen_s;
  double nearest_m = 1e9;  // that the cup came

  Vector3d At(double now_s) const { return {x, kCameraY + kBeltMps * (now_s - seen_s), kPartTop}; }
};

class Line {
 public:
  Line(unsigned seed, int parts, std::string prefix)
      : prefix_(std::move(prefix)), random_(seed), left_(parts), next_s_(Seconds() + 1) {
    TellMissed();
  }

  bool IsOver() const { return left_ == 0 && belt_.empty() && Seconds() > over_s_; }

  void Step() {
    while (const auto message = given_up_.Receive()) {
      why_[message->at("part")] = message->at("why");
    }
    if (left_ > 0 && Seconds() >= next_s_) Offer();
    if (const auto odometry = tool_.ReceiveNewest()) Judge(ToolOf(*odometry));
    while (!belt_.empty() && belt_.front().At(Seconds()).y() > kGoneY) Lose();
  }

  void SumUp() const {
    std::map<std::string, int> reasons;
    for (const OnBelt& part : missed_) {
      const auto why = why_.find(part.number);
      ++reasons[why != why_.end()         ? why->second
                : part.nearest_m < kCameM ? "the tool was not with it"
                                          : "still being planned"];
    }
    std::printf("parts offered %d, taken %d, in the bin %d, missed %zu", offered_, taken_, binned_,
                missed_.size());
    const char* between = ": ";
    for (const auto& [why, count] : reasons) {
      std::printf("%s%d %s", between, count, why.c_str());
      between = ", ";
    }
    std::printf("\n");
    std::fflush(stdout);
  }

 private:
  double Draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  void Offer() {
    --left_;
    const OnBelt part{++offered_, kBeltX + Draw(-0.05, 0.05), Draw(-1, 1), Seconds()};
    belt_.push_back(part);
    next_s_ += Draw(3.6, 5);
    const Vector3d at = part.At(part.seen_s);
    tool_.Send(prefix_ + "arm/parts", {{"part", part.number},
                                       {"x", at.x()},
                                       {"y", at.y()},
                                       {"yaw", part.yaw_rad},
                                       {"time", part.seen_s},
                                       {"belt", kBeltMps}});
  }

  void Judge(const Tool& tool) {
    if (holds_ != 0) {
      if ((tool.at_m - kOverBin).norm() > kBinM) return;
      std::printf("%.3f s: part %d is in the bin\n", Seconds(), holds_);
      holds_ = 0;
      ++binned_;
      return;
    }
    for (auto part = belt_.begin(); part != belt_.end(); ++part) {
      const double far_m = (tool.at_m - part->At(Seconds())).norm();
      part->nearest_m = std::min(part->nearest_m, far_m);
      const double slip_mps = (tool.velocity_mps - Vector3d(0, kBeltMps, 0)).norm();
      // A part has no front: half a turn is none.
      const double turned_rad = std::remainder(tool.yaw_rad - part->yaw_rad, M_PI);
      if (far_m > kNearM || slip_mps > kSlowMps || std::abs(turned_rad) > kTurnRad) continue;
      std::printf("%.3f s: part %d is taken, %.1f mm, %.1f mm/s and %.2f rad off\n", Seconds(),
                  part->number, 1e3 * far_m, 1e3 * slip_mps, turned_rad);
      holds_ = part->number;
      over_s_ = Seconds() + kAfterS;
      ++taken_;
      belt_.erase(part);
      return;
    }
  }

  // A figure that scenario.yaml expects something of.
  void TellMissed() const {
    std::printf("tcs-metric missed_parts %zu %.3f\n", missed_.size(), Seconds());
    std::fflush(stdout);  // it may be ended before it sums up
  }

  void Lose() {
    const OnBelt& part = belt_.front();
    std::printf("%.3f s: part %d is missed; the tool came as near as %.0f mm\n", Seconds(),
                part.number, 1e3 * part.nearest_m);
    missed_.push_back(part);
    TellMissed();
    over_s_ = Seconds() + kAfterS;
    belt_.pop_front();
  }

  const std::string prefix_;  // of the sockets' names
  Socket tool_{prefix_ + "line/tool"}, given_up_{prefix_ + "line/given_up"};
  std::mt19937 random_;
  int left_;
  double next_s_, over_s_ = 0;
  std::list<OnBelt> belt_;
  int offered_ = 0, taken_ = 0, binned_ = 0, holds_ = 0;
  std::vector<OnBelt> missed_;
  std::map<int, std::string> why_;
};

}  // namespace
}  // namespace arm

int main(int argc, char** argv) {
  arm::Line line(argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 1,
                 argc > 2 ? std::atoi(argv[2]) : 12, argc > 3 ? argv[3] : "");
  examples::Ticks ticks(500);
  while (!line.IsOver()) {
    ticks.WaitForNext();
    line.Step();
  }
  line.SumUp();
}
