// What a computer takes for work of which tcs spares the programs on it: the programs are charged
// that all the same, as a computer would be busy with it natively.
//
// Pure. The times of a list are those of the computer that it was measured on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "shm/time_kinds.h"

namespace tcs {

// What something takes by its size in bytes: a line through the sizes at which it was measured,
// which goes on behind the last of them.
class PriceBySize {
 public:
  static constexpr std::array<std::int64_t, 4> kSizes = {0, 1 << 10, 64 << 10, 1 << 20};
  using Times = std::array<VirtualDuration, kSizes.size()>;

  constexpr PriceBySize() = default;
  // None is negative.
  constexpr explicit PriceBySize(const Times& times) : times_(times) {}

  VirtualDuration Of(std::size_t bytes) const;
  PriceBySize On(double speed) const;
  const Times& times() const { return times_; }

 private:
  Times times_{};
};

// What Cyclone DDS and the kernel take for a sample from one process to another, beyond what
// libtcs_dds.so takes for it: the protocol, the datagrams, acknowledgements, the copies.
struct DdsPrices {
  PriceBySize send;          // in the thread that writes,
  PriceBySize send_further;  // the same sample, for each further process that has a reader
  PriceBySize receive;       // in the thread that receives, for each process

  DdsPrices On(double speed) const;
};

struct PriceList {
  std::string name;  // for people: where it is from
  DdsPrices dds_reliable, dds_best_effort;
  // What libtcs_dds.so and Cyclone compute for a sample in the program. Programs are charged that
  // as they compute it. Under set costs, which count nothing but calls, this is beside the calls.
  DdsPrices dds_computed;

  const DdsPrices& Dds(bool is_reliable) const {
    return is_reliable ? dds_reliable : dds_best_effort;
  }
  // The same work on a computer that is so many times as fast.
  PriceList On(double speed) const;
  // The same for lists with the same times.
  std::uint64_t Hash() const;
};

// Nothing costs anything.
PriceList NoPrices();
// What was measured on the machine that price_list.cc names.
PriceList ShippedPrices();

}  // namespace tcs
