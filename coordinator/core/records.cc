// What a run writes about itself while it goes (docs/RESULTS.md): the schedule trace, when clients
// were activated, and who had the processor when.
#include <filesystem>
#include <system_error>

#include "coordinator/core/engine.h"

namespace tcs {

std::string Engine::OpenRecords() {
  const std::string& directory = options_.output_directory;
  if (directory.empty()) return {};
  // It says that a run has ended, and that of an earlier one would say it of this one.
  std::error_code ignored;
  for (const char* file : {"/summary.json", "/unfinished.json"}) {
    std::filesystem::remove(directory + file, ignored);
  }
  std::string error = schedule_.Open(directory, !IsFixed());
  if (error.empty()) error = world_.OpenCsv(directory + "/bodies.csv");
  if (error.empty()) {
    error = activations_.Open(directory + "/activations.csv", options_.counts_work);
  }
  return error;
}

std::string Engine::CloseRecords() {
  const std::string errors[] = {schedule_.Close(), activations_.Close(), world_.CloseCsv(),
                                CloseDds()};
  for (const std::string& error : errors) {
    if (!error.empty()) return error;
  }
  return {};
}

// So that what is left of a run that is killed ends shortly before.
void Engine::FlushRecords() {
  schedule_.Flush();
  activations_.Flush();
  world_.FlushCsv();
}

}  // namespace tcs
