// The kinds of time that do not mix, beside the world's (VirtualTime) and the host's (HostTime) of
// virtual_time.h, and how one is made of another. Only the functions here do that by themselves;
// else ProgramClock does (coordinator/tasks/program_clock.h), which knows by what a program's clock
// is ahead, and MeteredThread (coordinator/host/meter.h), which knows how fast a thread's computer
// is.
//
// All functions are constexpr, allocate nothing and are async-signal-safe.
#pragma once

#include <cstdint>

#include "shm/virtual_time.h"

namespace tcs {

// The time that one program's clock shows, from the run's start: its robot's time, but under --sync
// callback ahead of it. Virtual durations pass on that clock.
struct ProgramTimeTag;
using ProgramTime = Instant<ProgramTimeTag>;

// The numbers that shared memory, system calls and files have: only the reader knows whose time
// they are.
constexpr VirtualTime RobotTime(std::int64_t ns) { return VirtualTime::FromNanoseconds(ns); }
constexpr ProgramTime OwnTime(std::int64_t ns) { return ProgramTime::FromNanoseconds(ns); }
constexpr VirtualDuration VirtualNs(std::int64_t ns) { return VirtualDuration::Nanoseconds(ns); }
constexpr HostDuration HostNs(std::int64_t ns) { return HostDuration::Nanoseconds(ns); }

constexpr ProgramTime operator+(ProgramTime own, VirtualDuration passed) {
  return own + ProgramTime::DurationType::Nanoseconds(passed.ns());
}
constexpr ProgramTime operator-(ProgramTime own, VirtualDuration passed) {
  return own - ProgramTime::DurationType::Nanoseconds(passed.ns());
}
constexpr VirtualDuration PassedBetween(ProgramTime from, ProgramTime to) {
  return VirtualNs((to - from).ns());
}

// The time that a program's clock shows when its robot's clock shows `robot`, and the other way
// round; `lead`: how far the program's clock is ahead. Never stays Never.
constexpr ProgramTime OwnTimeOf(VirtualTime robot, VirtualDuration lead) {
  return OwnTime((robot + lead).ns());
}
constexpr VirtualTime RobotTimeOf(ProgramTime own, VirtualDuration lead) {
  return RobotTime((own - lead).ns());
}

// A sum; it is Never where it is past the end of all time.
constexpr VirtualTime AtMostNever(VirtualTime from, VirtualDuration passes) {
  std::int64_t sum = 0;
  const bool is_past = __builtin_add_overflow(from.ns(), passes.ns(), &sum);
  return from.IsNever() || is_past ? VirtualTime::Never() : RobotTime(sum);
}

template <class Tag>
constexpr Duration<Tag> operator*(std::int64_t k, Duration<Tag> duration) {
  return duration * k;
}
template <class Tag>
constexpr Duration<Tag> operator/(Duration<Tag> duration, std::int64_t k) {
  return Duration<Tag>::Nanoseconds(duration.ns() / k);
}

}  // namespace tcs
