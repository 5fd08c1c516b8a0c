// Internal to the loading of models: what is wrong with a file is thrown, and caught where it was
// asked for.
#pragma once

#include <string>

namespace tcs {

struct ModelMistake {
  std::string message;  // "FILE:LINE: …" or, of a file as a whole, "FILE: …"
};

}  // namespace tcs
