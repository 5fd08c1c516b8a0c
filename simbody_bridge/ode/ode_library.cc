#include "simbody_bridge/ode/ode_library.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <string>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/one_line.h"

namespace tcs {
namespace {

std::string TextOf(const char* format, va_list arguments) {
  std::array<char, 512> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  return OnOneLine(text.data());
}

// ODE calls these for errors and failed assertions, and would end the process if they returned. An
// exception may pass through ODE: the library is C++, built with unwind tables, and holds no locks.
[[noreturn]] void ThrowError(int number, const char* format, va_list arguments) {
  throw DynamicsError(fmt::format("ODE, error {}: {}", number, TextOf(format, arguments)));
}

void SayMessage(int /*number*/, const char* format, va_list arguments) {
  std::fprintf(stderr, "tcs: ODE: %s\n", TextOf(format, arguments).c_str());
}

}  // namespace

void OpenOde() {
  [[maybe_unused]] static const bool opened = [] {
    // The headers fix the type of every number; a library built otherwise would read them as noise.
    if (dCheckConfiguration("ODE_double_precision") == 0) {
      throw DynamicsError(
          "libode computes in single precision, but tcs was built for double precision; install "
          "Debian's libode-dev and build tcs again");
    }
    if (dInitODE2(0) == 0 || dAllocateODEDataForThread(dAllocateFlagBasicData) == 0) {
      throw DynamicsError("libode cannot be initialised; check whether memory is left");
    }
    dSetErrorHandler(&ThrowError);
    dSetDebugHandler(&ThrowError);
    dSetMessageHandler(&SayMessage);
    return true;
  }();
}

}  // namespace tcs
