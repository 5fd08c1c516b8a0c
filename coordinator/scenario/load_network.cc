// `network` of a scenario file, and the addresses of its robots.
#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/sections.h"

namespace tcs {
namespace {

constexpr std::size_t kMostRobots = 250;  // 10.42.0.1 and on
constexpr double kSlowestBps = 1e3, kFastestBps = 1e12;
constexpr std::int64_t kLeastQueue = 1500, kMostQueue = std::int64_t{1} << 30;  // bytes

struct FactorUnit {
  std::string_view name;
  double factor;
};
constexpr FactorUnit kBandwidths[] = {
    {"bit/s", 1}, {"kbit/s", 1e3}, {"Mbit/s", 1e6}, {"Gbit/s", 1e9}};
constexpr FactorUnit kSizes[] = {{"", 1}, {"B", 1}, {"kB", 1e3}, {"MB", 1e6}};

// A number and one of the units, with or without a space between.
double LoadQuantity(const YamlValue& value, std::span<const FactorUnit> units,
                    const char* example) {
  const std::string text = value.AsText();
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string_view name(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (name.starts_with(' ')) name.remove_prefix(1);
  const auto unit = std::find_if(units.begin(), units.end(),
                                 [&](const FactorUnit& one) { return one.name == name; });
  if (error != std::errc() || unit == units.end() || !std::isfinite(number)) {
    value.Fail("is '" + text + "'; write it like " + example);
  }
  return number * unit->factor;
}

double LoadBandwidth(const YamlValue& value) {
  const double bps =
      LoadQuantity(value, kBandwidths, "10Mbit/s, with bit/s, kbit/s, Mbit/s or Gbit/s");
  if (bps < kSlowestBps || bps > kFastestBps) {
    value.Fail("is " + value.AsText() + "; it must be between 1kbit/s and 1000Gbit/s");
  }
  return bps;
}

std::int64_t LoadQueue(const YamlValue& value) {
  const double bytes = LoadQuantity(value, kSizes, "64kB, with B, kB or MB");
  if (bytes < kLeastQueue || bytes > kMostQueue) {
    value.Fail("is " + value.AsText() + "; it must be between 1500B, one packet, and 1000MB");
  }
  return static_cast<std::int64_t>(std::llround(bytes));
}

double LoadLoss(const YamlValue& value) {
  const double loss = value.AsNonNegativeNumber(" (0.01 is one packet of a hundred)");
  if (loss > 1) value.Fail("is " + value.AsText() + "; it is a share, from 0 to 1");
  return loss;
}

const std::vector<std::string>& LinkKeys() {
  static const std::vector<std::string> keys = {"latency", "jitter", "loss", "bandwidth", "queue"};
  return keys;
}

// Loads the values over those that `link` has already.
LinkSpec LoadLink(const YamlMap& map, LinkSpec link) {
  if (const YamlValue* v = map.Find("latency")) link.latency = v->AsDuration();
  if (const YamlValue* v = map.Find("jitter")) link.jitter = v->AsDuration();
  if (const YamlValue* v = map.Find("loss")) link.loss = LoadLoss(*v);
  if (const YamlValue* v = map.Find("bandwidth")) link.bandwidth_bps = LoadBandwidth(*v);
  if (const YamlValue* v = map.Find("queue")) link.queue_bytes = LoadQueue(*v);
  return link;
}

std::size_t FindRobot(const YamlValue& value, const Scenario& scenario) {
  const std::string name = value.AsText();
  std::vector<std::string> known;
  for (const RobotSpec& robot : scenario.robots) known.push_back(robot.name);
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) {
    value.Fail("names the unknown robot '" + name + "'; " + Suggest(name, known, "robots"));
  }
  return static_cast<std::size_t>(found - known.begin());
}

// Loads one element of `links`: {between: [a, b], ...} or {from: a, to: b, ...}.
void LoadLinkBetween(const YamlValue& value, const Scenario& scenario, NetworkSpec* network) {
  const YamlMap map = value.AsMap();
  std::vector<std::string> keys = LinkKeys();
  keys.insert(keys.begin(), {"between", "from", "to"});
  map.AllowOnly(keys);
  const YamlValue* between = map.Find("between");
  const bool one_way = map.Find("from") != nullptr || map.Find("to") != nullptr;
  if ((between != nullptr) == one_way) {
    value.Fail(
        "does not say which robots it joins; write between: [A, B] for both directions, or from: A "
        "and to: B for one");
  }
  std::size_t from = 0, to = 0;
  if (between != nullptr) {
    const std::vector<YamlValue> ends = between->AsList("[predator, prey]");
    if (ends.size() != 2) between->Fail("must name two robots, like [predator, prey]");
    from = FindRobot(ends[0], scenario);
    to = FindRobot(ends[1], scenario);
  } else {
    from = FindRobot(map.Require("from", "from: predator"), scenario);
    to = FindRobot(map.Require("to", "to: prey"), scenario);
  }
  if (from == to) value.Fail("joins a robot to itself; its own programs meet without a link");
  const std::size_t robots = network->addresses.size();
  LinkSpec& there = network->links[from * robots + to];
  there = LoadLink(map, there);
  if (between == nullptr) return;
  LinkSpec& back = network->links[to * robots + from];
  back = LoadLink(map, back);
}

std::string LoadAddress(const YamlValue& value) {
  const std::string text = value.AsText();
  in_addr parsed{};
  const bool is_ipv4 = inet_pton(AF_INET, text.c_str(), &parsed) == 1;
  const std::uint32_t address = ntohl(parsed.s_addr), last = address & 0xff, first = address >> 24;
  if (!is_ipv4 || first == 0 || first == 127 || first >= 224 || last == 0 || last == 255) {
    value.Fail("is '" + text + "'; write the IPv4 address of one computer, like 10.42.0.1");
  }
  return text;
}

// The addresses of all robots; robots that say none are numbered.
std::vector<std::string> LoadAddresses(const YamlMap& top, const YamlValue& network) {
  const YamlMap robots = RobotsOf(top).AsMap();
  if (robots.entries().size() > kMostRobots) {
    network.Fail("has " + std::to_string(robots.entries().size()) + " robots; at most " +
                 std::to_string(kMostRobots) + " fit into one network");
  }
  std::vector<std::string> addresses;
  for (const YamlMap::Entry& robot : robots.entries()) {
    const YamlMap map = robot.value.AsMap();
    const YamlValue* own = map.Find("address");
    const std::string address =
        own != nullptr ? LoadAddress(*own) : "10.42.0." + std::to_string(addresses.size() + 1);
    const auto same = std::find(addresses.begin(), addresses.end(), address);
    if (same != addresses.end()) {
      (own != nullptr ? *own : robot.value)
          .Fail("has the address " + address + ", which is that of " +
                robots.entries()[static_cast<std::size_t>(same - addresses.begin())].key +
                "; give each robot one of its own");
    }
    addresses.push_back(address);
  }
  return addresses;
}

void RefuseAddresses(const YamlMap& top) {
  const YamlMap robots = RobotsOf(top).AsMap();
  for (const YamlMap::Entry& robot : robots.entries()) {
    const YamlMap map = robot.value.AsMap();
    if (const YamlValue* address = map.Find("address")) {
      address->Fail("is for scenarios with a network; add network: {} at the top level");
    }
  }
}

}  // namespace

void LoadNetwork(const YamlMap& top, Scenario* scenario) {
  const YamlValue* value = top.Find("network");
  if (value == nullptr) return RefuseAddresses(top);
  const YamlMap map = value->AsMap();
  std::vector<std::string> keys = LinkKeys();
  keys.push_back("links");
  map.AllowOnly(keys);
  NetworkSpec& network = scenario->network.emplace();
  network.seed = SeedOf(scenario->seed, "network");
  network.addresses = LoadAddresses(top, *value);
  network.links.assign(network.addresses.size() * network.addresses.size(), LoadLink(map, {}));
  if (const YamlValue* links = map.Find("links")) {
    for (const YamlValue& link : links->AsList("[{between: [predator, prey], latency: 20ms}]")) {
      LoadLinkBetween(link, *scenario, &network);
    }
  }
}

}  // namespace tcs
