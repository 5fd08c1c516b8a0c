// Simbody's headers as C++20: include this instead of <simbody/Simbody.h>.
//
// Comparisons: Simbody 3.7 compares its index types by converting one side to int. C++20 also tries
// the sides the other way round and then cannot decide, so those headers do not compile. An exact
// match settles it; being a template, it gives way to an operator that a later Simbody may bring.
//
// NDEBUG: the macro changes the layout of classes that inline functions share with the library
// (CacheEntryInfo in StateImpl.h), and Debian builds the library without it. A library built with
// it would need the opposite here.
#pragma once

#include <concepts>

#ifdef NDEBUG
#error "Simbody's headers need NDEBUG as the library was built: undefined"
#endif

namespace SimTK {

template <class Index>
requires requires(const Index& index) {
  { index.isValidExtended() } -> std::same_as<bool>;
  { index.operator int() } -> std::same_as<int>;
}
inline bool operator==(const Index& a, const Index& b) {
  return static_cast<int>(a) == static_cast<int>(b);
}

}  // namespace SimTK

#include <simbody/Simbody.h>  // IWYU pragma: export
