// Another process on the rover's computer: it eats PERCENT of the processor's time and does nothing
// with it.
//
//   eater PERCENT
#include <cstdlib>

#include "examples/common/ticks.h"

int main(int argc, char** argv) {
  const double percent = argc > 1 ? std::atof(argv[1]) : 50;
  constexpr double kHz = 10;
  for (examples::Ticks ticks(kHz);; ticks.WaitForNext()) {
    const double until_s = examples::Seconds() + percent / 100 / kHz;
    while (percent > 0 && examples::Seconds() < until_s) {
    }
  }
}
