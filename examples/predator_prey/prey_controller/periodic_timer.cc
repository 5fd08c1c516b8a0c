#include "examples/predator_prey/prey_controller/periodic_timer.h"

#include <sys/timerfd.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <system_error>

namespace predator_prey {
namespace {

int OpenTimer(double period_s) {
  const int fd = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  const auto period_ns = std::llround(period_s * 1e9);
  itimerspec spec{};
  spec.it_interval.tv_sec = period_ns / 1'000'000'000;
  spec.it_interval.tv_nsec = period_ns % 1'000'000'000;
  spec.it_value = spec.it_interval;
  if (fd < 0 || ::timerfd_settime(fd, 0, &spec, nullptr) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot start a timer");
  }
  return fd;
}

}  // namespace

PeriodicTimer::PeriodicTimer(double period_s) : fd_(OpenTimer(period_s)) {}

std::uint64_t PeriodicTimer::TakeTicks() {
  std::uint64_t ticks = 0;
  return ::read(fd(), &ticks, sizeof(ticks)) == sizeof(ticks) ? ticks : 0;
}

}  // namespace predator_prey
