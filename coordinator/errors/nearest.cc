#include "coordinator/errors/nearest.h"

#include <algorithm>

namespace tcs {
namespace {

char Fold(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  return c == '-' || c == ' ' ? '_' : c;
}

// Insertions, deletions, replacements and swaps of neighbours that make one text the other.
std::size_t Distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = Fold(a[i - 1]) == Fold(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && Fold(a[i - 1]) == Fold(b[j - 2]) && Fold(a[i - 2]) == Fold(b[j - 1])) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::string> Nearest(std::string_view written,
                                   const std::vector<std::string>& known) {
  std::optional<std::string> nearest;
  std::size_t least = 0;
  if (written.size() > 64) return nearest;
  for (const std::string& candidate : known) {
    const std::size_t distance = Distance(written, candidate);
    const std::size_t longer = std::max(written.size(), candidate.size());
    if (distance > std::max<std::size_t>(1, longer / 3) || distance >= longer) continue;
    if (!nearest || distance < least) {
      nearest = candidate;
      least = distance;
    }
  }
  return nearest;
}

std::string Suggest(std::string_view written, const std::vector<std::string>& known,
                    std::string_view kind) {
  if (const auto nearest = Nearest(written, known)) return "did you mean '" + *nearest + "'?";
  std::string list = "the " + std::string(kind) + " here are ";
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (i > 0) list += i + 1 == known.size() ? " and " : ", ";
    list += known[i];
  }
  return list;
}

}  // namespace tcs
