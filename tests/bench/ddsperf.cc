#include "tests/bench/ddsperf.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>
#include <vector>

#include "coordinator/os/own_network.h"
#include "tests/bench/attempt.h"
#include "tests/bench/child.h"
#include "tests/bench/tcsim_run.h"

namespace tcs::bench {

namespace {

// The first second is for finding each other; ddsperf's pings begin after it.
constexpr char kDuration[] = "-D2";
constexpr double kCosted = 100'000;
constexpr std::chrono::seconds kLongestRun{300};
constexpr char kLoopbackOnly[] =
    "<CycloneDDS><Domain Id=\"any\"><General><Interfaces>"
    "<NetworkInterface name=\"lo\" multicast=\"true\"/>"
    "</Interfaces></General></Domain></CycloneDDS>";

// Nobody's default, and different for two benchmarks at once. From 102 on the ports of a domain are
// among those that the kernel gives to whoever asks for any.
std::string OwnDomain() { return std::to_string(1 + getpid() % 100); }

struct Pair {
  Command first, second;
  bool second_tells;  // who prints the measurement
};

Pair CommandsFor(const DdsperfCase& what, bool gently) {
  // An exit status of 0 says that each has found the other.
  const Command common{"ddsperf", kDuration, "-Qminmatch:1", "-i", OwnDomain()};
  const auto with = [&common](std::vector<std::string> words) {
    Command command = common;
    command.insert(command.end(), words.begin(), words.end());
    return command;
  };
  if (what.exchange == Exchange::kThroughput) {
    return {with({"sub"}), with({"pub", gently ? "100Hz" : "inf", "size", what.size}), false};
  }
  const std::string by = what.exchange == Exchange::kWaitset ? "waitset" : "listener";
  return {with({"pong", by}), with({"ping", gently ? "100Hz" : "inf", "size", what.size, by}),
          true};
}

// What ddsperf has printed, and how many round trips or samples there were in all.
struct Told {
  DdsperfNumbers numbers;
  double count = 0;
};

// The last line of the kind that is looked for.
std::optional<std::smatch> LastMatch(const std::string& text, const std::regex& pattern) {
  std::optional<std::smatch> last;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) last = *at;
  return last;
}

std::optional<Told> Parse(const std::string& said, Exchange exchange) {
  static const std::regex kLatency(" mean ([0-9.]+)us .* 50% ([0-9.]+)us .* cnt ([0-9]+)");
  static const std::regex kRate(" total ([0-9]+) .* rate ([0-9.]+) kS/s");
  Told told;
  if (exchange == Exchange::kThroughput) {
    const auto match = LastMatch(said, kRate);
    if (!match) return std::nullopt;
    told.count = std::stod((*match)[1]);
    told.numbers.samples_per_second = std::stod((*match)[2]) * 1000;
    if (told.numbers.samples_per_second <= 0) return std::nullopt;
  } else {
    const auto match = LastMatch(said, kLatency);
    if (!match) return std::nullopt;
    told.numbers.mean_us = std::stod((*match)[1]);
    told.numbers.median_us = std::stod((*match)[2]);
    told.count = std::stod((*match)[3]);
    if (told.numbers.mean_us <= 0) return std::nullopt;
  }
  if (told.count <= 0) return std::nullopt;
  return told;
}

bool Complain(const std::string& error) {
  fmt::print(stderr, "tcs_bench: dds: {}\n", error);
  return false;
}

// What the two said and what they took, wherever they ran.
struct Outcome {
  std::string said;
  double real_seconds = 0;  // 0: as long as by their own clocks
  double cpu_seconds = 0;
};

std::optional<Outcome> RunNatively(const Pair& pair) {
  const auto results = RunTogether({pair.first, pair.second}, kLongestRun);
  for (const ChildResult& result : results) {
    if (!result.error.empty()) {
      const bool missing = result.error.find("status 127") != std::string::npos;
      Complain(missing ? result.error + "; install cyclonedds-tools"
                       : fmt::format("{} natively: {}", result.error, result.output));
      return std::nullopt;
    }
  }
  return Outcome{results[pair.second_tells ? 1 : 0].output, 0,
                 results[0].cpu_seconds + results[1].cpu_seconds};
}

// Two programs on one computer, as natively: JSON is YAML, too.
std::string ScenarioFor(const Pair& pair, Carrier carrier) {
  const auto client = [carrier](const Command& command) {
    return nlohmann::json{{"command", command},
                          {"dds", carrier == Carrier::kSockets ? "sockets" : "endpoints"}};
  };
  const nlohmann::json robot{
      {"cpu", {{"cores", 2}}},
      {"clients", {{"first", client(pair.first)}, {"second", client(pair.second)}}}};
  return nlohmann::json{{"duration", "1h"}, {"robots", {{"pc", robot}}}}.dump();
}

std::optional<Outcome> RunUnderTcs(const Pair& pair, Carrier carrier) {
  const auto run = TcsimRun::Of("dds", ScenarioFor(pair, carrier));
  if (!run) return std::nullopt;
  for (const auto& [name, client] : run->summary().at("clients").items()) {
    if (client.at("wait_status") != 0) {
      Complain(fmt::format("{} ended with status {} (of waitpid) under tcs: {}", name,
                           client.at("wait_status").get<int>(),
                           run->OutputOf(name == "pc/first" ? "pc-first" : "pc-second")));
      return std::nullopt;
    }
  }
  return Outcome{run->OutputOf(pair.second_tells ? "pc-second" : "pc-first"),
                 run->summary().at("real_ns").get<double>() / 1e9, run->cpu_seconds()};
}

std::optional<DdsperfNumbers> RunOnce(const DdsperfCase& what, Carrier carrier, bool gently) {
  const Pair pair = CommandsFor(what, gently);
  const auto outcome = carrier == Carrier::kNative ? RunNatively(pair) : RunUnderTcs(pair, carrier);
  if (!outcome) return std::nullopt;
  std::optional<Told> told = Parse(outcome->said, what.exchange);
  if (!told) {
    Complain(fmt::format("no measurement in what ddsperf said: '{}'", outcome->said));
    return std::nullopt;
  }
  DdsperfNumbers& numbers = told->numbers;
  numbers.cpu_seconds = outcome->cpu_seconds / told->count * kCosted;
  if (carrier != Carrier::kNative) {
    numbers.real_seconds = outcome->real_seconds / told->count * kCosted;
  } else if (what.exchange == Exchange::kThroughput) {
    numbers.real_seconds = kCosted / numbers.samples_per_second;
  } else {
    numbers.real_seconds = kCosted * 2 * numbers.mean_us / 1e6;
  }
  return numbers;
}

}  // namespace

void PrepareForDdsperf() {
  setenv("CYCLONEDDS_URI", kLoopbackOnly, 1);
  if (!WhyNoOwnNetwork().empty()) return;
  if (const std::string error = EnterOwnNetwork(); !error.empty()) {
    Complain("cannot have a network of its own: " + error);
  }
}

std::optional<DdsperfNumbers> RunDdsperf(const DdsperfCase& what, Carrier carrier, bool gently) {
  // On a busy host the first second may not do, and a match that ddsperf is told of before it knows
  // the participant it misses: either ends it with an error.
  return Attempt([&] { return RunOnce(what, carrier, gently); });
}

}  // namespace tcs::bench
