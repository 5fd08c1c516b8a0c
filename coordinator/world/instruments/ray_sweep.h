// A scanner's way: columns of rays one after the other, each at its own instant.
#pragma once

#include <functional>

#include "coordinator/world/instruments/instrument.h"
#include "coordinator/world/instruments/seen.h"

namespace tcs {

class RaySweep {
 public:
  // `columns` columns at even intervals in the time `sweep`.
  RaySweep(const Mount& mount, std::size_t columns, VirtualDuration sweep, const WorldSpec& world);

  Instrument::Looks looks() const { return looks_; }
  std::span<const int> links() const { return seen_.links(); }
  double column_s() const { return column_s_; }  // between two columns

  // A look of the instrument's: calls `cast` for each column that has its turn by then, with the
  // world as it is at the column's instant.
  using Cast = std::function<void(std::size_t column, const Seen& seen)>;
  void Look(int number, const Eyes& eyes, const Cast& cast);

 private:
  Instrument::Looks looks_;
  std::size_t columns_;
  double column_s_;
  Seen seen_;
  std::size_t next_ = 0;
};

}  // namespace tcs
