// Not the rover's: those who cross its way, to and fro, each at a pace of its own that the seed
// says.
//
//   crowd SEED [NAME]     NAME: what its socket's name begins with, else "crowd"
//   out  NAME/walk  {"walker1": {"position": m, "velocity": m/s}, ...}
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"

namespace {

constexpr int kWalkers = 7;
constexpr double kFarM = 2.4;  // they go so far to either side

struct Walker {
  std::string name;
  double rate_radps, phase_rad;
};

}  // namespace

int main(int argc, char** argv) {
  std::mt19937 random(argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 1);
  std::uniform_real_distribution<double> rate_radps(0.3, 0.6), phase_rad(0, 2 * M_PI);
  std::vector<Walker> walkers;
  for (int i = 1; i <= kWalkers; ++i) {
    walkers.push_back({"walker" + std::to_string(i), rate_radps(random), phase_rad(random)});
  }
  const std::string name = argc > 2 ? argv[2] : "crowd";
  examples::Socket socket;
  const double start_s = examples::Seconds();
  for (examples::Ticks ticks(50);; ticks.WaitForNext()) {
    const double t = examples::Seconds() - start_s;
    const double begin = 1 - std::exp(-t);  // from the middle of the way, slowly at first
    examples::Json steps;
    for (const Walker& walker : walkers) {
      const double angle = walker.rate_radps * t + walker.phase_rad;
      steps[walker.name] = {{"position", begin * kFarM * std::sin(angle)},
                            {"velocity", kFarM * (begin * walker.rate_radps * std::cos(angle) +
                                                  std::exp(-t) * std::sin(angle))}};
    }
    socket.Send(name + "/walk", steps);
  }
}
