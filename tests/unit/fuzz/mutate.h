// Texts with damage in them. The same seed makes the same damage.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace tcs::fuzz {

class Mutator {
 public:
  // `tokens`: what means something in this kind of text, and is put where it does not belong.
  Mutator(std::uint64_t seed, std::vector<std::string> tokens);

  // With one to eight things done to it; pieces of `others` may get into it.
  std::string Damage(std::string text, const std::vector<std::string>& others);

  // From 0 to `most` - 1, which must not be 0.
  std::size_t Below(std::size_t most);
  bool OneIn(std::size_t number) { return Below(number) == 0; }

 private:
  void DamageBytes(std::string* text);
  void DamageLines(std::string* text);
  void DamageValue(std::string* text);
  std::string Piece(const std::string& text);

  std::mt19937_64 random_;
  const std::vector<std::string> tokens_;
};

}  // namespace tcs::fuzz
