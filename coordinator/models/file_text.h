// The whole text of a file that a user named, which may be anything.
#pragma once

#include <cstddef>
#include <string>

namespace tcs {

// Throws ModelMistake, "PATH: …", for a file that cannot be read, is no ordinary file (a pipe
// would be waited for, a device has no end) or is longer than `most_bytes`. `what` says in a
// sentence what it should be: "a URDF file".
std::string TextOf(const std::string& path, std::size_t most_bytes, const char* what);

// The same checks, without reading the file.
void CheckFile(const std::string& path, std::size_t most_bytes, const char* what);

}  // namespace tcs
