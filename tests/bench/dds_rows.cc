#include "tests/bench/dds_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "tests/bench/ddsperf.h"
#include "tests/bench/host.h"

namespace tcs::bench {

namespace {

constexpr std::array kCarriers{Carrier::kNative, Carrier::kSockets, Carrier::kEndpoints};
constexpr std::array kSizes{std::pair{"64", "64 B"}, std::pair{"16k", "16 KB"}};
constexpr std::array kExchanges{std::pair{Exchange::kListener, "listener"},
                                std::pair{Exchange::kWaitset, "waitset"},
                                std::pair{Exchange::kThroughput, "throughput"}};

// One round's numbers, in the order of the carriers.
using Round = std::array<DdsperfNumbers, kCarriers.size()>;

DdsRow RowOf(const std::vector<Round>& rounds, double DdsperfNumbers::*number) {
  DdsRow row;
  for (std::size_t carrier = 0; carrier < kCarriers.size(); ++carrier) {
    std::vector<double> values;
    for (const Round& round : rounds) values.push_back(round[carrier].*number);
    row.value[carrier] = SpreadOf(values).median;
  }
  std::vector<double> ratios;
  for (const Round& round : rounds) ratios.push_back(round.back().*number / round.front().*number);
  row.ratio = SpreadOf(ratios);
  return row;
}

void AddRows(const std::string& size, Exchange exchange, const std::string& name,
             const std::vector<Round>& rounds, DdsRows* rows) {
  const auto add = [&](std::vector<DdsRow>* to, double DdsperfNumbers::*number, std::string what,
                       std::string unit) {
    DdsRow& row = to->emplace_back(RowOf(rounds, number));
    row.size = size;
    row.what = std::move(what);
    row.unit = std::move(unit);
    row.more_is_better = number == &DdsperfNumbers::samples_per_second;
  };
  if (exchange == Exchange::kThroughput) {
    add(&rows->own_clocks, &DdsperfNumbers::samples_per_second, name, "/s");
  } else {
    add(&rows->own_clocks, &DdsperfNumbers::mean_us, name + ", mean", "us");
    add(&rows->own_clocks, &DdsperfNumbers::median_us, name + ", median", "us");
  }
  add(&rows->real_s, &DdsperfNumbers::real_seconds, name, "s");
  add(&rows->cpu_s, &DdsperfNumbers::cpu_seconds, name, "s");
}

}  // namespace

std::optional<DdsRows> MeasureDds(int rounds, bool gently) {
  PrepareForDdsperf();
  DdsRows rows;
  rows.rounds = rounds;
  rows.processors = AllowedCpus();
  std::array<std::vector<Round>, kSizes.size() * kExchanges.size()> all;
  for (int round = 0; round < rounds; ++round) {
    // It takes minutes.
    if (!gently) fmt::print(stderr, "tcs_bench: dds: round {} of {}\n", round + 1, rounds);
    auto numbers = all.begin();
    for (const auto& size : kSizes) {
      for (const auto& exchange : kExchanges) {
        Round& now = (numbers++)->emplace_back();
        for (std::size_t carrier = 0; carrier < kCarriers.size(); ++carrier) {
          const auto got = RunDdsperf({size.first, exchange.first}, kCarriers[carrier], gently);
          if (!got) return std::nullopt;
          now[carrier] = *got;
        }
      }
    }
  }
  auto numbers = all.begin();
  for (const auto& size : kSizes) {
    for (const auto& exchange : kExchanges) {
      AddRows(size.second, exchange.first, exchange.second, *numbers++, &rows);
    }
  }
  return rows;
}

}  // namespace tcs::bench
