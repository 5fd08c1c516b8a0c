// Lists by number, where numbers are few and begin at 0: the list grows to have a place for each.
#pragma once

#include <cstddef>
#include <vector>

namespace tcs {

template <class T>
T& PlaceOf(std::vector<T>& all, int number) {
  const auto place = static_cast<std::size_t>(number);
  if (place >= all.size()) all.resize(place + 1);
  return all[place];
}

}  // namespace tcs
