#include "coordinator/answers/unheard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace tcs {

namespace {

constexpr std::size_t kMostNamed = 4;

std::string Elsewhere(const std::vector<Heard>& heard) {
  if (heard.empty()) return "no client received any anywhere";
  std::vector<std::string> places;
  for (std::size_t i = 0; i < std::min(heard.size(), kMostNamed); ++i)
    places.push_back(fmt::format("{} at {}", heard[i].receiver, heard[i].where));
  const std::size_t more = heard.size() - places.size();
  return fmt::format("received was by {}{}", fmt::join(places, ", "),
                     more > 0 ? fmt::format(", and at {} others", more) : "");
}

}  // namespace

std::vector<std::string> SentencesOn(const std::vector<Unheard>& unheard,
                                     const std::vector<Heard>& heard) {
  std::vector<std::string> sentences;
  for (const Unheard& one : unheard) {
    sentences.push_back(
        fmt::format("{} sent {} to {}, where nobody received any; {}", one.sender,
                    one.sent == 1 ? "a datagram" : fmt::format("{} datagrams", one.sent), one.where,
                    Elsewhere(heard)));
  }
  return sentences;
}

}  // namespace tcs
