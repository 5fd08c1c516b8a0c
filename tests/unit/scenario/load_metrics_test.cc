// The metrics of a scenario: what they may name, and what is said of what there is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view kWorld = R"(duration: 1s
dynamics: {}
bodies:
  drone: {mass: 1, inertia: [1, 1, 1]}
  prey-2: {mass: 1, inertia: [1, 1, 1]}
models:
  cart: {urdf: cart.urdf}
robots: {r: {clients: {c: {command: [./controller]}}}}
channels:
  eyes: {type: udp_json, sensors: {bodies: [drone, prey-2], to: "127.0.0.1:47001"}}
  imu: {type: udp_json, sensors: {bodies: [drone], to: "127.0.0.1:47002", fields: [angular_rate]}}
  joints: {type: udp_json, sensors: {model: cart, to: "127.0.0.1:47003"}}
  push: {type: udp_json, commands: {body: drone, listen: "127.0.0.1:47004"}}
metrics:
)";

constexpr std::string_view kCart = R"(<robot name="cart">
  <link name="hull"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="wheel"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="axle" type="continuous"><parent link="hull"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
</robot>
)";

class LoadMetricsTest : public testing::Test {
 protected:
  LoadMetricsTest() { folder_.Write("cart.urdf", kCart); }
  Scenario Loaded(const std::string& metrics) const {
    return ScenarioOf(LoadScenario(folder_.Write("s.yaml", std::string(kWorld) + metrics)));
  }
  std::string Refusal(const std::string& metrics) const {
    return Complaint(folder_, std::string(kWorld) + metrics);
  }
  const ScenarioFolder folder_;
};

TEST_F(LoadMetricsTest, AreOfBodiesJointsAndChannels) {
  const Scenario scenario = Loaded(R"(  a: {rms: drone.z - 1.0, from: 2ms, until: 1s, every: 1ms}
  b: {last: cart/axle.velocity}
  c: {max: norm(cart.x, cart/wheel.vy)}
  d: {first_time_when: distance(drone, prey-2) < 0.3, from: 1ms}
  e:
    mean: prey-2.x-drone.x
  f: {min: eyes.prey-2.linear_velocity.z + imu.angular_rate.x}
  g: {max: joints.axle.effort}
  h: {max: push.torque_z}
)");
  ASSERT_EQ(scenario.metrics.size(), 8);
  const MetricSpec& a = scenario.metrics[0];
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.asked, MetricFigure::kRms);
  EXPECT_EQ(a.from, VirtualDuration::Milliseconds(2));
  EXPECT_EQ(a.until, VirtualDuration::Seconds(1));
  EXPECT_EQ(a.every, VirtualDuration::Milliseconds(1));
  EXPECT_EQ(scenario.metrics[3].asked, MetricFigure::kFirstTimeWhen);
  EXPECT_EQ(scenario.metrics[3].from, VirtualDuration::Milliseconds(1));
  const auto named = [&](std::size_t metric) {
    std::vector<std::size_t> needs = scenario.metrics[metric].expression.Needs();
    std::vector<QuantitySpec> quantities;
    for (const std::size_t i : needs) quantities.push_back(scenario.quantities[i]);
    return quantities;
  };
  EXPECT_EQ(named(0)[0].kind, QuantitySpec::Kind::kBody);
  EXPECT_EQ(named(0)[0].part, 2);
  EXPECT_EQ(named(1)[0].kind, QuantitySpec::Kind::kJoint);
  EXPECT_EQ(named(1)[0].part, 1);
  EXPECT_EQ(named(2)[0].kind, QuantitySpec::Kind::kLink);
  EXPECT_EQ(named(2)[0].index, 0);
  EXPECT_EQ(named(2)[1].index, 1);
  EXPECT_EQ(named(3).size(), 6);
  EXPECT_EQ(named(5)[0].of, "prey-2");
  EXPECT_EQ(named(5)[0].field, "linear_velocity");
  EXPECT_EQ(named(7)[0].kind, QuantitySpec::Kind::kCommand);
  EXPECT_EQ(named(7)[0].field, "torque_z");
}

TEST_F(LoadMetricsTest, SayWhatThereIsNot) {
  EXPECT_THAT(Refusal("  a: {rms: dron.z}\n"),
              AllOf(StartsWith("s.yaml:15: metrics.a.rms: "), HasSubstr("'dron.z'"),
                    HasSubstr("did you mean 'drone.z'?")));
  EXPECT_THAT(Refusal("  a: {rms: drone.altitude}\n"),
              HasSubstr("the quantities of drone here are x, y, z, vx"));
  EXPECT_THAT(Refusal("  a: {rms: cart/axel.position}\n"), HasSubstr("'cart/axle.position'?"));
  EXPECT_THAT(Refusal("  a: {rms: nothing_like_it.x}\n"),
              HasSubstr("the bodies, joints and channels here are cart, cart/axle"));
  EXPECT_THAT(Refusal("  a: {max: distance(drone, pray-2)}\n"),
              AllOf(HasSubstr("no body or link 'pray-2'"), HasSubstr("'prey-2'?")));
  EXPECT_THAT(Refusal("  a: {rms: imu.position.x}\n"), HasSubstr("imu.position.x"));
  EXPECT_THAT(Refusal("  a:\n    max: norm(drone.x,\n      drone.q)\n"), StartsWith("s.yaml:16: "));
}

TEST_F(LoadMetricsTest, HaveOneFigure) {
  EXPECT_THAT(Refusal("  a: {from: 1s}\n"), HasSubstr("metrics.a asks for no figure"));
  EXPECT_THAT(Refusal("  a: {max: drone.x, min: drone.x}\n"), HasSubstr("second figure"));
  EXPECT_THAT(Refusal("  a: {maximum: drone.x}\n"), HasSubstr("unknown key 'maximum'"));
  EXPECT_THAT(Refusal("  a: {max: drone.x, untill: 1s}\n"), HasSubstr("did you mean 'until'?"));
  EXPECT_THAT(Refusal("  a: {max: 1 + 1}\n"), HasSubstr("names nothing that changes"));
  EXPECT_THAT(Refusal("  a: {max: }\n"), HasSubstr("no value"));
  EXPECT_THAT(Refusal("  a: {max: drone.x, from: 1s, until: 0.5s}\n"), HasSubstr("before from"));
  EXPECT_THAT(Refusal("  a: {max: drone.x, every: 0s}\n"), HasSubstr("every"));
  EXPECT_THAT(Refusal("  a: {max: norm(drone.x, drone.y}\n"), HasSubstr("')' is wanted"));
  EXPECT_THAT(Refusal("  a b: {max: drone.x}\n"), HasSubstr("'a b'"));
}

TEST_F(LoadMetricsTest, WarnOfWhatHasNoValues) {
  EXPECT_THAT(Loaded("  a: {max: drone.x, from: 2s}\n").warnings,
              ElementsAre(HasSubstr("metrics.a begins after the end")));
}

TEST_F(LoadMetricsTest, NeedAWorld) {
  EXPECT_THAT(Complaint(folder_,
                        "duration: 1s\nrobots: {r: {clients: {c: {command: [./controller]}}}}\n"
                        "metrics: {a: {max: b.x}}\n"),
              HasSubstr("tcs-metric NAME VALUE"));
}

}  // namespace
}  // namespace tcs
