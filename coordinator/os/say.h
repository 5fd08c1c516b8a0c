// The sentences of tcsim on its stderr.
#pragma once

#include <cstdio>
#include <string>

#include "coordinator/errors/visible.h"

namespace tcs {

// One line, "tcsim: SENTENCE", whatever the sentence quotes. A stderr that cannot be written, on a
// full disk for one, ends nobody's run.
inline void Say(const std::string& sentence) {
  const std::string line = "tcsim: " + Visible(sentence) + "\n";
  const std::size_t written = std::fwrite(line.data(), 1, line.size(), stderr);
  static_cast<void>(written);
}

}  // namespace tcs
