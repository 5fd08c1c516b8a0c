// What tcsim prints on its stdout: results. Sentences about failures go to stderr (say.h).
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace tcs {

// Unlike fmt::print it throws nothing: that a disk is full is found by FlushStdout.
template <typename... Arguments>
void Print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  const std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
  const std::size_t written = std::fwrite(text.data(), 1, text.size(), stdout);
  static_cast<void>(written);
}

// At the end of a command: all has been printed, or it has failed with a sentence. A stdout that
// was closed from the beginning is no failure.
int FlushStdout(int status);

}  // namespace tcs
