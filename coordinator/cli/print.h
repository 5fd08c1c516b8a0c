// tcsim's output on stdout: results. Sentences about failures go to stderr (say.h).
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace tcs {

// Unlike fmt::print, Print throws nothing: FlushStdout finds out that a disk is full.
template <typename... Arguments>
void Print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  const std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
  const std::size_t written = std::fwrite(text.data(), 1, text.size(), stdout);
  static_cast<void>(written);
}

// Called at the end of a command: all output has been printed, or the command has failed with a
// sentence. A stdout that was closed from the beginning is no failure.
int FlushStdout(int status);

}  // namespace tcs
