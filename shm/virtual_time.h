// Strong types for time. Everything in tcs that is not a shared layout speaks of time in these.
//
// Units: int64 nanoseconds. A VirtualTime counts from the run's start; a HostTime is a reading of
// the host's CLOCK_MONOTONIC. All functions are constexpr, allocate nothing and are
// async-signal-safe.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

namespace tcs {

template <class Tag>
class Duration {
 public:
  constexpr Duration() = default;
  static constexpr Duration Nanoseconds(std::int64_t ns) { return Duration(ns); }
  static constexpr Duration Microseconds(std::int64_t us) { return Duration(us * 1'000); }
  static constexpr Duration Milliseconds(std::int64_t ms) { return Duration(ms * 1'000'000); }
  static constexpr Duration Seconds(std::int64_t s) { return Duration(s * 1'000'000'000); }

  constexpr std::int64_t ns() const { return ns_; }
  constexpr double seconds() const { return static_cast<double>(ns_) * 1e-9; }

  constexpr auto operator<=>(const Duration&) const = default;
  constexpr Duration operator-() const { return Duration(-ns_); }
  constexpr Duration operator+(Duration d) const { return Duration(ns_ + d.ns_); }
  constexpr Duration operator-(Duration d) const { return Duration(ns_ - d.ns_); }
  constexpr Duration operator*(std::int64_t k) const { return Duration(ns_ * k); }
  constexpr Duration& operator+=(Duration d) { return *this = *this + d; }
  constexpr Duration& operator-=(Duration d) { return *this = *this - d; }

 private:
  explicit constexpr Duration(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

template <class Tag>
class Instant {
 public:
  using DurationType = Duration<Tag>;

  constexpr Instant() = default;
  static constexpr Instant FromNanoseconds(std::int64_t ns) { return Instant(ns); }
  // Later than every instant of a run: "no such event". Adding to it keeps it Never.
  static constexpr Instant Never() { return Instant(std::numeric_limits<std::int64_t>::max()); }

  constexpr std::int64_t ns() const { return ns_; }
  constexpr double seconds() const { return static_cast<double>(ns_) * 1e-9; }
  constexpr bool IsNever() const { return *this == Never(); }

  constexpr auto operator<=>(const Instant&) const = default;
  constexpr Instant operator+(DurationType d) const {
    return IsNever() ? *this : Instant(ns_ + d.ns());
  }
  constexpr Instant operator-(DurationType d) const {
    return IsNever() ? *this : Instant(ns_ - d.ns());
  }
  constexpr DurationType operator-(Instant t) const {
    return DurationType::Nanoseconds(ns_ - t.ns_);
  }
  constexpr Instant& operator+=(DurationType d) { return *this = *this + d; }

 private:
  explicit constexpr Instant(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

struct VirtualTimeTag;
struct HostTimeTag;
using VirtualTime = Instant<VirtualTimeTag>;
using VirtualDuration = Duration<VirtualTimeTag>;
using HostTime = Instant<HostTimeTag>;
using HostDuration = Duration<HostTimeTag>;

}  // namespace tcs
