#include "simbody_bridge/lag.h"

#include <cmath>

namespace tcs {
namespace {

constexpr double kSettledAfter = 40;  // time constants: e^-40 is 4e-18

}  // namespace

bool HasSettled(const Wrench& command, const Remainder& remainder, VirtualTime t) {
  return remainder.since.IsNever() ||
         (t - remainder.since).seconds() >= kSettledAfter * command.lag.seconds();
}

double ShareLeft(const Wrench& command, const Remainder& remainder, VirtualTime t) {
  if (HasSettled(command, remainder, t)) return 0;
  return std::exp(-(t - remainder.since).seconds() / command.lag.seconds());
}

double ShareLeftAfter(const Wrench& command, double share, double after_s) {
  return share > 0 ? share * std::exp(-after_s / command.lag.seconds()) : 0;
}

double MeanShareLeft(const Wrench& command, const Remainder& remainder, VirtualTime t,
                     double seconds) {
  const double share = ShareLeft(command, remainder, t);
  const double lag_s = command.lag.seconds();
  return share > 0 ? share * -std::expm1(-seconds / lag_s) * lag_s / seconds : 0;
}

Remainder RemainderAt(const Wrench& command, const Remainder& remainder, VirtualTime t) {
  const double left = ShareLeft(command, remainder, t);
  Remainder both{.since = t, .in_world = {}, .in_body = {}};
  AddTo(&both.in_world, remainder.in_world, left);
  AddTo(&both.in_body, remainder.in_body, left);
  AddTo(command.in_body_frame ? &both.in_body : &both.in_world, LoadOf(command), 1 - left);
  return both;
}

}  // namespace tcs
