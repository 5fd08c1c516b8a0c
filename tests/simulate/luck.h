// Numbers that a seed decides: the same ones on each machine, in each build.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tcs::simulate {

class Luck {
 public:
  explicit Luck(std::uint64_t seed) : state_(seed) {}
  // A sequence of its own, for the part of that number.
  Luck Part(std::uint64_t number) const { return Luck(Mixed(state_ ^ Mixed(number))); }

  std::uint64_t Next() { return Mixed(state_ += kStep); }
  // Both ends included.
  std::int64_t Between(std::int64_t least, std::int64_t most) {
    const auto span = static_cast<std::uint64_t>(most - least) + 1;
    return least + static_cast<std::int64_t>(Next() % span);
  }
  // Small ones as often as large ones.
  std::int64_t Long(std::int64_t least, std::int64_t most) {
    const double share = static_cast<double>(Next() >> 11) * 0x1p-53;
    const double span = std::log(static_cast<double>(most) / static_cast<double>(least));
    return static_cast<std::int64_t>(static_cast<double>(least) * std::exp(share * span));
  }
  // One of a container's, which has some.
  template <class Container>
  auto& OneOf(Container& all) {
    return all[static_cast<std::size_t>(Between(0, static_cast<std::int64_t>(all.size()) - 1))];
  }
  // Once in so many times.
  bool OnceIn(std::uint64_t times) { return Next() % times == 0; }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;

  // Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators (2014): SplitMix64.
  static std::uint64_t Mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace tcs::simulate
