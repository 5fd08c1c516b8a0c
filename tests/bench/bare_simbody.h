// The reference of the physics' rows: Simbody without tcs.
#pragma once

namespace tcs::bench {

// Seconds of processor time that a system of so many free bodies takes for `samples` stops at 100
// Hz, with other forces after each.
double BareSimbodySeconds(int bodies, int samples);

}  // namespace tcs::bench
