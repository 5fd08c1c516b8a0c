// What the shim keeps of the environment, and how it passes it on: a program that runs its children
// with an environment of its own making still runs them in virtual time, and with the libraries
// that it preloads for them (stdbuf does).
#pragma once

#include <cstddef>

namespace tcs::preload {

// Copies tcs's part of LD_PRELOAD, TCS_SOCKET and TCS_ALIASES out of `envp`. Called once, before
// the program runs.
void RememberEnvironment(char** envp);
bool EnvironmentRemembered();

// The lines of TCS_ALIASES (shm/attach_protocol.h); empty where there are none.
const char* AliasLines();

// The coordinator's socket (shm/attach_protocol.h), or null where there is none.
const char* SocketName();

// An environment for exec: `envp` itself if it carries the shim's variables, else a copy with them,
// in `storage`: what LD_PRELOAD has there is kept, and the shim comes behind it. Async-signal-safe.
// Entries beyond kMaxEntries are dropped, and libraries that do not fit.
struct EnvironmentCopy {
  static constexpr std::size_t kMaxEntries = 2048;
  char* entries[kMaxEntries + 4];
  char preload[4096];
};
char* const* WithShim(char* const* envp, EnvironmentCopy& storage);

}  // namespace tcs::preload
