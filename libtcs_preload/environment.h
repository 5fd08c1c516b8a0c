// The parts of the environment that the shim keeps and passes on: a program that runs its children
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

// An environment for exec: `envp` itself if it carries the shim's variables, else a copy with them:
// the libraries that LD_PRELOAD names there are kept, and the shim comes behind them. Where there
// is no memory for a copy the environment is `envp`, too. Valid while this object lives.
// Async-signal-safe, and sparing of stack: some programs execute others on 4 KiB.
//
// A child that shares its parent's memory and executes a program leaves its copy there.
class EnvironmentWithShim {
 public:
  explicit EnvironmentWithShim(char* const* envp);
  ~EnvironmentWithShim();
  EnvironmentWithShim(const EnvironmentWithShim&) = delete;
  EnvironmentWithShim& operator=(const EnvironmentWithShim&) = delete;
  char* const* get() const { return entries_; }

 private:
  char* const* entries_;
  void* mapped_ = nullptr;
  std::size_t mapped_size_ = 0;
};

}  // namespace tcs::preload
