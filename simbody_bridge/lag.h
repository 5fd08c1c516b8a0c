// Commands that lag, in closed form: from the command on, what acts is the command and, fading by
// e^(-t / lag), the difference to what acted before it. So it is exact wherever the steps are, and
// a function of the commands alone.
#pragma once

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/load.h"

namespace tcs {

// What acted on a body when its command took effect, and fades if that lags.
struct Remainder {
  VirtualTime since = VirtualTime::Never();  // of the command; never: there is nothing left
  Load in_world, in_body;                    // along whose axes it acts
};

// Whether by `t` there is no more left of it than doubles tell apart. Of a command that does not
// lag there never is.
bool HasSettled(const Wrench& command, const Remainder& remainder, VirtualTime t);

// How much of the remainder still acts at `t`: 1 when the command takes effect, 0 when it has
// settled.
double ShareLeft(const Wrench& command, const Remainder& remainder, VirtualTime t);
// The mean over the time from `t` to `seconds` later.
double MeanShareLeft(const Wrench& command, const Remainder& remainder, VirtualTime t,
                     double seconds);
// `after_s` later than a time at which `share` was left.
double ShareLeftAfter(const Wrench& command, double share, double after_s);

// What acts of both, as the remainder of a command that takes effect at `t`.
Remainder RemainderAt(const Wrench& command, const Remainder& remainder, VirtualTime t);

}  // namespace tcs
