// Commands that lag, in closed form: from the command on, the command acts and, fading by e^(-t /
// lag), the difference to what acted before it. So the sum is exact wherever the steps are, and a
// function of the commands alone.
#pragma once

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/load.h"

namespace tcs {

// The load that acted on a body when its command took effect, and that fades if the command lags.
struct Remainder {
  VirtualTime since = VirtualTime::Never();  // of the command; never: there is nothing left
  Load in_world, in_body;                    // the axes along which it acts
};

// Whether by `t` no more of the remainder is left than doubles tell apart. A command that does not
// lag never has a remainder.
bool HasSettled(const Wrench& command, const Remainder& remainder, VirtualTime t);

// How much of the remainder still acts at `t`: 1 when the command takes effect, 0 when it has
// settled.
double ShareLeft(const Wrench& command, const Remainder& remainder, VirtualTime t);
// The mean of the share over the time from `t` to `seconds` later.
double MeanShareLeft(const Wrench& command, const Remainder& remainder, VirtualTime t,
                     double seconds);
// The share left `after_s` later than a time at which `share` was left.
double ShareLeftAfter(const Wrench& command, double share, double after_s);

// The load that acts of the command and the remainder, as the remainder of a command that takes
// effect at `t`.
Remainder RemainderAt(const Wrench& command, const Remainder& remainder, VirtualTime t);

}  // namespace tcs
