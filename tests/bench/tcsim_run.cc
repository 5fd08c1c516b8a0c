#include "tests/bench/tcsim_run.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <utility>

#include "tests/bench/child.h"

namespace tcs::bench {

namespace {

namespace fs = std::filesystem;

// Other runs of tcsim may have the processors, and are waited for.
constexpr std::chrono::seconds kLongestRun{300};

std::string ReadAll(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::nullopt_t Complain(const std::string& name, const std::string& error) {
  fmt::print(stderr, "tcs_bench: {}: {}\n", name, error);
  return std::nullopt;
}

}  // namespace

std::optional<TcsimRun> TcsimRun::Of(const std::string& name, const std::string& scenario,
                                     const std::vector<std::string>& options) {
  std::string folder = fs::temp_directory_path() / "tcs_bench.XXXXXX";
  if (mkdtemp(folder.data()) == nullptr) return Complain(name, "cannot make " + folder);
  TcsimRun run(folder);
  const fs::path file = run.folder_ / "scenario.yaml", out = run.folder_ / "out";
  if (!(std::ofstream(file) << scenario).flush())
    return Complain(name, "cannot write to " + folder);
  const fs::path tcsim = fs::read_symlink("/proc/self/exe").replace_filename("tcsim");
  Command command{tcsim, "run", file, "--out", out};
  command.insert(command.end(), options.begin(), options.end());
  const ChildResult result = RunChild(command, kLongestRun);
  if (!result.error.empty()) return Complain(name, result.error);
  run.cpu_seconds_ = result.cpu_seconds;
  try {
    run.summary_ = nlohmann::json::parse(ReadAll(out / "summary.json"));
  } catch (const std::exception& error) {
    return Complain(name, fmt::format("no summary of the run: {}", error.what()));
  }
  return run;
}

TcsimRun::TcsimRun(TcsimRun&& other) noexcept
    : folder_(std::exchange(other.folder_, {})),
      summary_(std::move(other.summary_)),
      cpu_seconds_(other.cpu_seconds_) {}

TcsimRun::~TcsimRun() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string TcsimRun::OutputOf(const std::string& client) const {
  return ReadAll(folder_ / "out" / (client + ".out.log"));
}

}  // namespace tcs::bench
