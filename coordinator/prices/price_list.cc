#include "coordinator/prices/price_list.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tcs {

namespace {

constexpr VirtualDuration Us(double us) { return VirtualNs(static_cast<std::int64_t>(us * 1000)); }

}  // namespace

VirtualDuration PriceBySize::Of(std::size_t bytes) const {
  const double size = static_cast<double>(bytes);
  std::size_t next = 1;
  while (next + 1 < kSizes.size() && size > static_cast<double>(kSizes[next])) ++next;
  const double since = static_cast<double>(kSizes[next - 1]);
  const double part = (size - since) / (static_cast<double>(kSizes[next]) - since);
  const double from = static_cast<double>(times_[next - 1].ns());
  const double to = static_cast<double>(times_[next].ns());
  return VirtualNs(std::max<std::int64_t>(0, std::llround(from + part * (to - from))));
}

PriceBySize PriceBySize::On(double speed) const {
  Times times = times_;
  for (VirtualDuration& time : times) {
    time = VirtualNs(std::llround(static_cast<double>(time.ns()) / speed));
  }
  return PriceBySize(times);
}

DdsPrices DdsPrices::On(double speed) const {
  return {send.On(speed), send_further.On(speed), receive.On(speed)};
}

PriceList PriceList::On(double speed) const {
  return {name, dds_reliable.On(speed), dds_best_effort.On(speed), dds_computed.On(speed)};
}

// FNV-1a.
std::uint64_t PriceList::Hash() const {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const DdsPrices* prices : {&dds_reliable, &dds_best_effort, &dds_computed}) {
    for (const PriceBySize* price : {&prices->send, &prices->send_further, &prices->receive}) {
      for (const VirtualDuration time : price->times()) {
        for (int shift = 0; shift < 64; shift += 8) {
          hash = (hash ^ (static_cast<std::uint64_t>(time.ns()) >> shift & 0xff)) * 0x100000001b3u;
        }
      }
    }
  }
  return hash;
}

PriceList NoPrices() {
  PriceList list;
  list.name = "none";
  return list;
}

// Of a virtual machine with two processors of an AMD EPYC, Linux 6.18, Debian 12 with Cyclone DDS
// 0.10.2: what a process that writes at 100 to 1000 Hz, and one that waits in a wait set and takes,
// use by their CPU clocks for each sample over the loopback interface, without multicast; less what
// they use under tcs, which is what they compute. Medians of three rounds. Further processes: from
// one to four and eight.
PriceList ShippedPrices() {
  const auto of = [](double none, double kilobyte, double large, double megabyte) {
    return PriceBySize({Us(none), Us(kilobyte), Us(large), Us(megabyte)});
  };
  return {.name = "shipped with tcs",
          .dds_reliable = {.send = of(26, 27, 78, 940),
                           .send_further = of(6, 7, 43, 620),
                           .receive = of(19, 19.5, 65, 955)},
          .dds_best_effort = {.send = of(31, 31, 76, 810),
                              .send_further = of(8, 8.5, 42, 520),
                              .receive = of(15, 15, 49, 825)},
          .dds_computed = {.send = of(2.5, 3, 9, 120),
                           .send_further = of(0, 0, 0.5, 110),
                           .receive = of(10, 10.5, 20, 110)}};
}

}  // namespace tcs
