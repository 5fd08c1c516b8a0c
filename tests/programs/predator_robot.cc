// Plays the predator's robot and its prey, crudely and by itself, for the example's DDS programs:
// tells where both are 100 times a second, lets the wrench act, and listens to what controller and
// planner say to each other. Ends with 0 when plans have been followed, with 1 when something was
// said that should not be or nothing for too long.
//
// The controller must execute plans as they are (--kp 0 --kd 0): then each wrench is one of the
// newest plan, to the bit.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <list>
#include <stdexcept>
#include <string>
#include <vector>

#include "examples/predator_prey/common/dds_waitset.h"
#include "examples/predator_prey/common/predator_topics.h"
#include "examples/predator_prey/common/program.h"
#include "examples/predator_prey/common/ticks.h"

namespace predator_prey {
namespace {

constexpr std::chrono::milliseconds kPeriod{10};
constexpr double kPeriodS = 0.01;
constexpr double kInertiaKgm2 = 0.1;  // the mass is 1 kg
constexpr unsigned kCommandsOfAPlan = 3;

struct Options {
  DdsOptions dds;
  std::string prey = "prey";
  unsigned plans = 2;        // to be followed
  double patience_s = 30.0;  // for all of it
};

void Move(BodyState& body, const Wrench& wrench) {
  body.linear_velocity_mps += kPeriodS * wrench.force_n;
  body.angular_velocity_radps += kPeriodS / kInertiaKgm2 * wrench.torque_nm;
  body.position_m += kPeriodS * body.linear_velocity_mps;
  const double angle_rad = kPeriodS * body.angular_velocity_radps.norm();
  if (angle_rad == 0) return;
  const Eigen::AngleAxisd turn(angle_rad, body.angular_velocity_radps.normalized());
  body.orientation = (turn * body.orientation).normalized();
}

// The twist goes along the body's axes: a rotation matrix's columns, here, unlike in the example.
geometry_msgs_msg_dds__Vector3_ AlongAxes(const BodyState& body, const Eigen::Vector3d& v) {
  const Eigen::Matrix3d axes = body.orientation.toRotationMatrix();
  return {axes.col(0).dot(v), axes.col(1).dot(v), axes.col(2).dot(v)};
}

void WriteOdometry(Writer<OdometryMessage>& writer, std::string name, const BodyState& body) {
  std::string frame = "world";
  OdometryMessage odometry{};
  const dds_time_t now_ns = dds_time();
  odometry.header.stamp = {static_cast<std::int32_t>(now_ns / DDS_NSECS_IN_SEC),
                           static_cast<std::uint32_t>(now_ns % DDS_NSECS_IN_SEC)};
  odometry.header.frame_id = frame.data();
  odometry.child_frame_id = name.data();
  const Eigen::Vector3d& p = body.position_m;
  const Eigen::Quaterniond& q = body.orientation;
  odometry.pose.pose = {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
  odometry.twist.twist = {AlongAxes(body, body.linear_velocity_mps),
                          AlongAxes(body, body.angular_velocity_radps)};
  writer.Write(odometry);
}

bool Equal(const Wrench& a, const Wrench& b) {
  return a.force_n == b.force_n && a.torque_nm == b.torque_nm;
}

// What controller and planner have said.
class Conversation {
 public:
  void Publish(const BodyState& predator) {
    published_.push_back(predator);
    if (published_.size() > 1000) published_.erase(published_.begin());
  }

  // A request must tell a state that was published, with its velocities in the world's frame.
  void Request(const PlanRequest& request) {
    ++requests;
    const BodyState& asked = request.predator;
    const auto is_asked = [&asked](const BodyState& body) {
      return body.position_m == asked.position_m &&
             (body.linear_velocity_mps - asked.linear_velocity_mps).norm() < 1e-9 &&
             (body.angular_velocity_radps - asked.angular_velocity_radps).norm() < 1e-9;
    };
    if (std::none_of(published_.begin(), published_.end(), is_asked)) {
      throw std::runtime_error("a plan was asked for from where the predator never was");
    }
  }

  void Plan(PlanReply plan) {
    plans_.push_back({std::move(plan), 0});
    std::vector<Wrench> early;
    early.swap(early_);
    for (const Wrench& wrench : early) Command(wrench);
    // This robot may have begun to listen while a plan was followed that it has not heard, whose
    // last wrenches come around the time of the first one that it has.
    if (plans_.size() <= 2) early_.clear();
  }

  void Command(const Wrench& wrench) {
    if (Equal(wrench, {})) {
      ++coasting;
      return;
    }
    for (auto plan = plans_.rbegin(); plan != plans_.rend(); ++plan) {
      for (const PlanStep& step : plan->plan.steps) {
        if (!Equal(step.control, wrench)) continue;
        ++plan->commands;
        return;
      }
    }
    // A wrench may overtake its plan, which goes another way; but by no more than a few.
    early_.push_back(wrench);
    if (early_.size() > 20) throw std::runtime_error("wrenches came that are of no plan");
  }

  unsigned plans_followed() const {
    const auto followed = [](const Followed& plan) { return plan.commands >= kCommandsOfAPlan; };
    return static_cast<unsigned>(std::count_if(plans_.begin(), plans_.end(), followed));
  }
  bool all_explained() const { return early_.empty(); }

  unsigned requests = 0;
  unsigned coasting = 0;

 private:
  struct Followed {
    PlanReply plan;
    unsigned commands;
  };

  std::list<BodyState> published_;
  std::vector<Followed> plans_;
  std::vector<Wrench> early_;
};

void Run(const Options& options) {
  const DdsEntity participant = JoinDomain(options.dds);
  const std::string& name = options.dds.predator;
  Writer<OdometryMessage> predator_odometry(OdometryTopic(participant, name));
  Writer<OdometryMessage> prey_odometry(OdometryTopic(participant, options.prey));
  Reader<WrenchMessage> wrenches(WrenchTopic(participant, name));
  Reader<PlanRequestMessage> requests(PlanRequestTopic(participant, name));
  Reader<PlanMessage> plans(PlanTopic(participant, name));
  Waitset waitset(participant);
  waitset.Attach(wrenches.has_samples());
  waitset.Attach(requests.has_samples());
  waitset.Attach(plans.has_samples());

  // The predator's nose points along y, so that its axes are not the world's.
  BodyState predator;
  predator.position_m = {-5, 0, 0};
  predator.orientation = Eigen::AngleAxisd(1.57, Eigen::Vector3d::UnitZ());
  predator.linear_velocity_mps = {0.3, 0.1, -0.2};
  predator.angular_velocity_radps = {0.1, 0.2, 0.5};
  BodyState prey;
  prey.position_m = {5, 0, 0};
  Wrench wrench;
  Conversation heard;
  Ticks ticks(kPeriod);
  const auto end = Ticks::Clock::now() + std::chrono::duration<double>(options.patience_s);

  const auto is_over = [&] {
    return heard.plans_followed() >= options.plans && heard.requests > 0 && heard.coasting > 0 &&
           heard.all_explained();
  };
  while (!is_over()) {
    if (Ticks::Clock::now() > end) {
      throw std::runtime_error(
          "after " + std::to_string(options.patience_s) + " s " + std::to_string(heard.requests) +
          " plans have been asked for and " + std::to_string(heard.plans_followed()) +
          " been followed, " + std::to_string(heard.coasting) + " commands were to coast, and " +
          (heard.all_explained() ? "no wrench" : "wrenches") + " came of no plan");
    }
    waitset.WaitUntil(ticks.next());
    if (const auto request = requests.TakeNewest()) heard.Request(FromMessage(*request));
    if (const auto plan = plans.TakeNewest()) heard.Plan(FromMessage(*plan));
    if (const auto message = wrenches.TakeNewest()) {
      wrench = {.force_n = {message->force.x, message->force.y, message->force.z},
                .torque_nm = {message->torque.x, message->torque.y, message->torque.z}};
      heard.Command(wrench);
    }
    if (ticks.Take() == 0) continue;
    // Not before everybody hears everybody: then nothing that matters is said unheard.
    if (!wrenches.IsMatched() || !requests.IsMatched() || !plans.IsMatched() ||
        !predator_odometry.IsMatched() || !prey_odometry.IsMatched()) {
      continue;
    }
    Move(predator, wrench);
    Move(prey, {});
    heard.Publish(predator);
    WriteOdometry(predator_odometry, "predator", predator);
    WriteOdometry(prey_odometry, "prey", prey);
  }
  std::printf("%u plans asked for, %u followed, %u commands to coast\n", heard.requests,
              heard.plans_followed(), heard.coasting);
}

}  // namespace
}  // namespace predator_prey

int main(int argc, char** argv) {
  using namespace predator_prey;
  Options options;
  CommandLine command_line("Plays the robot of the predator's programs.", "predator_robot");
  AddDdsOptions(command_line, options.dds);
  AddNamespace(command_line, "--prey-namespace", options.prey, "namespace of the prey's topics");
  command_line.Add("--plans", options.plans, "how many plans are to be followed", Accept::kAll);
  command_line.Add("--patience", options.patience_s, "how long all may take [s]",
                   Accept::kPositive);
  return command_line.Run(argc, argv, [&] { Run(options); });
}
