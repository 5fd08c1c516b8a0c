// What cycle_counter.cc finds in the library that it loads.
#pragma once

#include <cstdint>

using ReadWhenLoaded = std::uint64_t();
