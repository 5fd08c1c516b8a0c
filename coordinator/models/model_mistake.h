// Internal to the loading of models: a mistake in a file is thrown, and caught where the file was
// asked for.
#pragma once

#include <string>

namespace tcs {

struct ModelMistake {
  std::string message;  // "FILE:LINE: …" or, of a file as a whole, "FILE: …"
};

}  // namespace tcs
