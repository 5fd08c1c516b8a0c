#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;

class LoadNetworkTest : public testing::Test {
 protected:
  // Three robots, the first of which may be more than its clients; the network is on line 7.
  static std::string Text(const std::string& network, const std::string& of_first = "") {
    return "duration: 1\nseed: 1\nrobots:\n  a: {" + of_first +
           "clients: {c: {command: [sh]}}}\n  b: {clients: {c: {command: [sh]}}}\n"
           "  c: {clients: {c: {command: [sh]}}}\n" +
           network + "\n";
  }
  Scenario Load(const std::string& network, const std::string& of_first = "") {
    return ScenarioOf(LoadScenario(folder_.Write("s.yaml", Text(network, of_first))));
  }
  std::string Refusal(const std::string& network, const std::string& of_first = "") {
    return Complaint(folder_, Text(network, of_first));
  }

  ScenarioFolder folder_;
};

TEST_F(LoadNetworkTest, WithoutOneAllRobotsShareTheHosts) {
  EXPECT_FALSE(Load("").network.has_value());
}

TEST_F(LoadNetworkTest, RobotsAreNumberedWhereTheySayNothing) {
  EXPECT_THAT(Load("network: {}").network->addresses,
              ElementsAre("10.42.0.1", "10.42.0.2", "10.42.0.3"));
  EXPECT_THAT(Load("network: {}", "address: 192.168.1.7, ").network->addresses,
              ElementsAre("192.168.1.7", "10.42.0.2", "10.42.0.3"));
}

TEST_F(LoadNetworkTest, ALinkSaysWhatIsOtherThanTheRest) {
  const Scenario scenario = Load(
      "network: {latency: 20ms, loss: 0.01, bandwidth: 10 Mbit/s, links: ["
      "{between: [a, b], latency: 5ms}, {from: c, to: a, jitter: 1ms, queue: 64kB}]}");
  const NetworkSpec& network = *scenario.network;
  for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 0)}) {
    const LinkSpec& link =
        network.Link(static_cast<std::size_t>(from), static_cast<std::size_t>(to));
    EXPECT_EQ(link.latency, VirtualDuration::Milliseconds(5));
    EXPECT_EQ(link.loss, 0.01);
    EXPECT_EQ(link.bandwidth_bps, 10e6);
  }
  EXPECT_EQ(network.Link(2, 0).jitter, VirtualDuration::Milliseconds(1));
  EXPECT_EQ(network.Link(2, 0).queue_bytes, 64'000);
  EXPECT_EQ(network.Link(2, 0).latency, VirtualDuration::Milliseconds(20));
  EXPECT_EQ(network.Link(0, 2).jitter, VirtualDuration{});
}

TEST_F(LoadNetworkTest, MistakesAreSentencesWithTheirPlace) {
  const std::string at = "s.yaml:7: ";
  EXPECT_EQ(Refusal("network: {loss: 2}"), at + "network.loss is 2; it is a share, from 0 to 1");
  EXPECT_EQ(Refusal("network: {bandwidth: 10}"),
            at + "network.bandwidth is '10'; write it like 10Mbit/s, with bit/s, kbit/s, Mbit/s or "
                 "Gbit/s");
  EXPECT_EQ(Refusal("network: {bandwidth: 1bit/s}"),
            at + "network.bandwidth is 1bit/s; it must be between 1kbit/s and 1000Gbit/s");
  EXPECT_EQ(Refusal("network: {queue: 10B}"),
            at + "network.queue is 10B; it must be between 1500B, one packet, and 1000MB");
  EXPECT_EQ(Refusal("network: {latencey: 2ms}"),
            at + "unknown key 'latencey' in network; did you mean 'latency'?");
  EXPECT_EQ(Refusal("network: {links: [{latency: 1ms}]}"),
            at + "network.links[0] does not say which robots it joins; write between: [A, B] for "
                 "both directions, or from: A and to: B for one");
  EXPECT_EQ(Refusal("network: {links: [{between: [a, a]}]}"),
            at + "network.links[0] joins a robot to itself; its own programs meet without a link");
  EXPECT_EQ(Refusal("network: {links: [{from: a, to: bb}]}"),
            at + "network.links[0].to names the unknown robot 'bb'; did you mean 'b'?");
}

TEST_F(LoadNetworkTest, AddressesAreOfOneRobotEachAndNeedANetwork) {
  EXPECT_EQ(Refusal("", "address: 10.42.0.1, "),
            "s.yaml:4: robots.a.address is for scenarios with a network; add network: {} at the "
            "top level");
  EXPECT_EQ(
      Refusal("network: {}", "address: 127.0.0.1, "),
      "s.yaml:4: robots.a.address is '127.0.0.1'; write the IPv4 address of one computer, like "
      "10.42.0.1");
  EXPECT_EQ(Refusal("network: {}", "address: 10.42.0.2, "),
            "s.yaml:5: robots.b has the address 10.42.0.2, which is that of a; give each robot one "
            "of its own");
}

TEST_F(LoadNetworkTest, ChannelsOnUdpAreAtRobotsAddresses) {
  const std::string world =
      "duration: 1\ndynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\n"
      "robots: {r: {clients: {c: {command: [sh]}}}}\nnetwork: {}\nchannels:\n"
      "  eyes: {type: udp_json, sensors: {bodies: [b], to: \"";
  EXPECT_EQ(Complaint(folder_, world + "10.42.0.1:47010\"}}\n"), "");
  EXPECT_EQ(
      Complaint(folder_, world + "127.0.0.1:47010\"}}\n"),
      "s.yaml:7: channels.eyes.sensors.to has the address 127.0.0.1, which is no robot's: with "
      "`network` each robot has its own 127.0.0.1; write the address of the robot whose body "
      "it is, like 10.42.0.1");
}

}  // namespace
}  // namespace tcs
