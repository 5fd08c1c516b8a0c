// Runs trials on this machine, several at once.
#pragma once

#include "coordinator/trials/launcher.h"

namespace tcs {

// How the runs share the machine.
struct LocalOptions {
  int at_once = 1;
  bool whole_cores = false;  // see os/cpu_places.h
  bool own_networks = false;
  bool waits_for_cpu = true;  // see os/cpu_claim.h
};

class LocalLauncher final : public Launcher {
 public:
  explicit LocalLauncher(const LocalOptions& options) : options_(options) {}
  LauncherReport Run(const TrialsWork& work, const LauncherEvents& events) override;

 private:
  const LocalOptions options_;
};

}  // namespace tcs
