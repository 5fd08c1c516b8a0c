#include "tests/unit/fuzz/mutate.h"

#include <algorithm>
#include <utility>

namespace tcs::fuzz {

namespace {

constexpr std::size_t kMostSteps = 8, kLongestPiece = 200, kLargestText = 1 << 20;

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size() - 1) + 1;
    lines.push_back(text.substr(from, end - from));
    from = end;
  }
  return lines;
}

}  // namespace

Mutator::Mutator(std::uint64_t seed, std::vector<std::string> tokens)
    : random_(seed), tokens_(std::move(tokens)) {}

std::size_t Mutator::Below(std::size_t most) { return random_() % most; }

std::string Mutator::Piece(const std::string& text) {
  if (text.empty()) return {};
  return text.substr(Below(text.size()), 1 + Below(kLongestPiece));
}

void Mutator::DamageBytes(std::string* text) {
  const std::size_t at = Below(text->size() + 1);
  const auto byte = static_cast<char>(Below(256));
  switch (Below(6)) {
    case 0:
      if (at < text->size()) (*text)[at] = byte;
      break;
    case 1:
      if (at < text->size()) (*text)[at] = static_cast<char>((*text)[at] ^ (1 << Below(8)));
      break;
    case 2:
      text->insert(at, 1 + Below(4), byte);
      break;
    case 3:
      text->erase(at, 1 + Below(OneIn(4) ? 400 : 4));
      break;
    case 4:
      text->insert(at, Piece(*text));
      break;
    case 5:
      if (OneIn(4)) text->resize(at);
      break;
  }
}

void Mutator::DamageLines(std::string* text) {
  std::vector<std::string> lines = LinesOf(*text);
  if (lines.empty()) return;
  const std::size_t one = Below(lines.size()), other = Below(lines.size());
  const auto at = lines.begin() + static_cast<std::ptrdiff_t>(one);
  const std::string line = lines[one];
  switch (Below(6)) {
    case 0:
      lines.erase(at);
      break;
    case 1:
      lines.insert(at, OneIn(10) ? 5'000 : 1 + Below(3), line);
      break;
    case 2:
      std::swap(lines[one], lines[other]);
      break;
    case 3:
      lines[one] = std::string(Below(6), ' ') + line;
      break;
    case 4:
      lines[one].erase(0, std::min(line.size(), 1 + Below(3)));
      break;
    case 5:
      lines[one].resize(line.size() - 1);  // joined with the next one
      break;
  }
  text->clear();
  for (const std::string& each : lines) *text += each;
}

// What follows a separator, up to the next one, becomes another thing.
void Mutator::DamageValue(std::string* text) {
  constexpr std::string_view kSeparators = ":,[{= \n";
  const std::size_t begin = text->find_first_of(kSeparators, Below(text->size() + 1));
  if (begin == std::string::npos) return;
  const std::size_t end = std::min(text->find_first_of(",]}\n", begin + 1), text->size());
  const std::string token = tokens_[Below(tokens_.size())];
  const std::string old = text->substr(begin + 1, end - begin - 1);
  text->replace(begin + 1, old.size(), OneIn(3) ? old + token : OneIn(3) ? token + old : token);
}

std::string Mutator::Damage(std::string text, const std::vector<std::string>& others) {
  for (std::size_t step = 1 + Below(kMostSteps); step > 0; --step) {
    switch (Below(8)) {
      case 0:
      case 1:
        DamageBytes(&text);
        break;
      case 2:
      case 3:
        DamageLines(&text);
        break;
      case 4:
        text.insert(Below(text.size() + 1), tokens_[Below(tokens_.size())]);
        break;
      case 5:
        if (!others.empty()) {
          text.insert(Below(text.size() + 1), Piece(others[Below(others.size())]));
        }
        break;
      default:
        DamageValue(&text);
    }
    if (text.size() > kLargestText) text.resize(kLargestText);
  }
  return text;
}

}  // namespace tcs::fuzz
