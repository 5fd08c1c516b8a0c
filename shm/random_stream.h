// Random numbers of what the run makes up (sensors' errors, lost datagrams, wake-ups): any seed,
// purpose and number give a stream of their own.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tcs {

// The streams of two purposes know nothing of each other.
enum class RandomPurpose : std::uint64_t { kFate = 1, kNoise, kBias, kWakeup };

// Steele, Lea and Flood's SplitMix64.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t number) : state_(seed) {
    state_ = Next() ^ static_cast<std::uint64_t>(purpose);
    state_ = Next() ^ number;
    state_ = Next();
  }

  // From 0 to below 1.
  double Uniform() { return static_cast<double>(Next() >> 11) * 0x1p-53; }
  // Box and Muller's.
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
    return radius * std::cos(2 * std::numbers::pi * Uniform());
  }

 private:
  std::uint64_t Next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  }

  std::uint64_t state_;
};

}  // namespace tcs
