#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/tools.h"
#include "coordinator/errors/visible.h"
#include "coordinator/fit/fit_table.h"
#include "coordinator/fit/fragment.h"
#include "coordinator/fit/measured_run.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/report/live_page.h"
#include "coordinator/report/live_run.h"
#include "coordinator/report/page.h"
#include "coordinator/report/read_results.h"
#include "coordinator/report/write.h"
#include "coordinator/scenario/load.h"
#include "tests/unit/fuzz/fuzz.h"
#include "tests/unit/fuzz/mutate.h"

namespace tcs::fuzz {

namespace {

namespace fs = std::filesystem;

using Files = std::map<std::string, std::string>;

constexpr char kSummary[] = R"({
  "scenario": "chase", "seed": 1, "set": [], "accounting": "measured", "sync": "consistent",
  "engine": "simbody", "interrupted": false, "duration_ns": 2000000000, "virtual_ns": 2000000000,
  "real_ns": 4000000000, "drift_ns": 1000000, "drift_bound_ns": 1000000, "staleness_ns": 0,
  "lateness_ns": 3000, "clients_ns": 3000000000, "dynamics_ns": 800000000,
  "coordinating_ns": 100000000, "overhead_percent": 2.5, "dispatches": 7, "samples": 9,
  "commands": 3, "warnings": ["a warning"], "robots": {"r": {"cores": 1, "speed": 1.0}},
  "clients": {
    "r/planner": {"robot": "r", "class": "best-effort", "priority": 1, "charged_ns": 1000000000,
      "host_cpu_ns": 1, "stolen_ns": 5, "activations": 2, "overruns": 0, "ended_at_ns": -1,
      "wait_status": 0, "calls": 70, "allocations": 400000},
    "r/controller": {"robot": "r", "class": "periodic", "priority": 9, "charged_ns": 20000000,
      "host_cpu_ns": 1, "stolen_ns": 5, "activations": 20, "overruns": 1, "ended_at_ns": -1,
      "wait_status": 0, "calls": 300, "allocations": 0}}
})";

constexpr char kScene[] = R"({
  "version": 1, "gravity_mps2": [0.0, 0.0, -9.81], "region_m": 10.0,
  "bodies": [{"name": "a", "mass_kg": 1.0, "inertia_kgm2": [0.1, 0.1, 0.1]}],
  "fixtures": [], "models": [], "sensors": [], "meshes": []
})";

constexpr char kTopics[] = R"({
  "version": 1,
  "topics": [{
    "topic": "/odom", "type": "nav_msgs/msg/Odometry", "domain": 0, "samples": 31, "bytes": 22444,
    "first_ns": 0, "last_ns": 300000000, "rate_hz": 99.9, "drops": 0,
    "endpoints": [{
      "kind": "writer", "process": "tcsim", "robot": "", "count": 1,
      "qos": {"reliability": "reliable", "history": "keep_last", "depth": 10,
              "durability": "volatile", "liveliness": "automatic"}}]}]
})";

std::string Bodies() {
  std::string text = "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps\n";
  for (int i = 0; i < 50; ++i) {
    const std::string time = std::to_string(i * 0.01);
    text += time + ",a,0,0,0,0,0,0,1,0\n" + time + ",b,0," + std::to_string(9.0 - i) +
            ",0,0,0,0,1,0\n" + time + ",c,1,0,0,0,0,0,1,0\n";
  }
  return text;
}

Files RunFiles(const std::string& folder) {
  std::string activations =
      "client,thread,cause,release_ns,start_ns,end_ns,charged_ns,calls,allocations\n";
  std::string dispatches = "row,virtual_start_ns,virtual_end_ns,real_start_ns,real_end_ns\n";
  std::string responses =
      "client,thread,cause,release_ns,start_ns,end_ns,deadline_ns,queued_ns,away_ns,wakeup_ns,"
      "executed_ns,cores_ns,locks_ns,room_ns,rest_ns,whose\n";
  for (int i = 0; i < 40; ++i) {
    const std::string start = std::to_string(i * 1'000'000),
                      end = std::to_string(i * 1'000'000 + 9);
    activations += "r/planner,0,input," + start + "," + start + "," + end + ",400000,7,900\n" +
                   "r/controller,0,time," + start + "," + end + "," + end + ",1000,15,0\n" +
                   "r/planner,3,thread," + start + "," + start + "," + end + ",9,1,0\n";
    responses += "r/controller,0,time," + start + "," + start + "," + end +
                 ",10000000,4,0,0,1000,5,0,0,0,core:r/planner=5\n";
    dispatches += "r/planner #3," + start + "," + end + "," + start + "," + end + "\ndynamics," +
                  start + "," + end + "," + start + "," + end + "\n";
  }
  return {{folder + "/summary.json", kSummary},
          {folder + "/bodies.csv", Bodies()},
          {folder + "/activations.csv", activations},
          {folder + "/dispatches.csv", dispatches},
          {folder + "/responses.csv", responses},
          {folder + "/scene.json", kScene},
          {folder + "/topics.json", kTopics},
          {folder + "/trace.json", "{\"traceEvents\":[]}"},
          {folder + "/tcsim.log", "tcsim: warning: so what\ntcsim: it \x1b[31mwent wrong\n"}};
}

// Of three kinds: one run, one that was cut off, and trials.
Files SoundFolder(std::size_t kind) {
  if (kind < 2) {
    Files files = RunFiles("run");
    if (kind == 1) {
      files["run/unfinished.json"] = files["run/summary.json"];
      files.erase("run/summary.json");
    }
    return files;
  }
  Files files = RunFiles("run/2ms/seed-0001");
  files.merge(RunFiles("run/2ms/seed-0002"));
  files.merge(RunFiles("run/4ms/seed-0001"));
  files["run/trials.json"] =
      R"({"name": "tcs", "first_seed": 1, "trials": 2,
          "vary": {"key": "drift", "values": ["2ms", "4ms"]}})";
  return files;
}

std::vector<std::string> ResultTokens() {
  return {",",
          "\n",
          "\"",
          "{",
          "}",
          "[",
          "]",
          ":",
          "null",
          "true",
          "-1",
          "0",
          "1e308",
          "-1e308",
          "nan",
          "inf",
          "1e-320",
          "\xff",
          "\x1b[2J",
          "\r\n",
          "9223372036854775807",
          "-9223372036854775808",
          "99999999999999999999",
          "1.5",
          "\"\"",
          "r/planner",
          "dynamics",
          "</script>",
          "<b>",
          "&",
          "seed-",
          "../",
          "\\u0000",
          "{}",
          "[]",
          std::string(1, '\0'),
          std::string(5'000, '9'),
          std::string(3'000, '['),
          std::string(10'000, 'x')};
}

// What is in a file's place where something went wrong that is no text.
void PutOther(Mutator* mutator, const fs::path& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
  switch (mutator->Below(5)) {
    case 0:
      break;  // nothing
    case 1:
      fs::create_directory(path, ignored);
      break;
    case 2:
      mkfifo(path.c_str(), 0600);
      break;
    case 3:
      fs::create_symlink(path, path, ignored);  // a loop
      break;
    case 4:
      fs::create_symlink("/dev/zero", path, ignored);
      break;
  }
}

std::string Report(const std::string& folder, const std::string& page_path, bool* refused) {
  const auto read = report::ReadResults({folder}, {});
  if (const auto* error = std::get_if<LoadError>(&read)) {
    *refused = true;
    if (error->message.find(folder) != std::string::npos) return {};
    return "a refusal does not name the folder: " + Visible(error->message);
  }
  const report::Page page = report::MakePage(std::get<report::Results>(read), {"", {1.0, 5.0}});
  std::vector<std::string> written;
  const std::string error = report::WritePage(page, page_path, report::FigureFiles::kSvg, &written);
  return error.empty() ? "" : "the page was not written: " + error;
}

// What `tcsim fit` makes of it, a scenario can be given.
std::string Fit(const std::string& folder, const std::string& costs_path) {
  const auto read = fit::ReadMeasuredRun(folder);
  if (const auto* error = std::get_if<LoadError>(&read)) {
    if (error->message.find(folder) != std::string::npos) return {};
    return "a refusal of fit does not name the folder: " + Visible(error->message);
  }
  const auto& run = std::get<fit::MeasuredRun>(read);
  const auto fits = fit::FitAll(run);
  if (fit::FitTable(run, fits).empty()) return "the table of fit is empty";
  static_cast<void>(fit::FitWarnings(run, fits));
  std::ofstream(costs_path) << fit::FragmentOf(run, fits);
  const auto loaded = LoadOverlay(costs_path);
  const auto* error = std::get_if<LoadError>(&loaded);
  return error == nullptr ? "" : "what fit writes cannot be read: " + Visible(error->message);
}

// Does the command, which says what it has to say to nobody. What is wrong with its exit status.
std::string Do(const ToolArguments& command, bool* refused) {
  const UniqueFd nowhere(open("/dev/null", O_WRONLY | O_CLOEXEC));
  dup2(nowhere.get(), STDOUT_FILENO);
  dup2(nowhere.get(), STDERR_FILENO);
  const int status = DoWithTools(command, nullptr);
  *refused = status == kCannotRun;
  return status >= kSucceeded && status <= kExpectationFailed
             ? ""
             : fmt::format("command {} ends with {}", command.index(), status);
}

// A page that is looked at while a run writes the folder.
std::string Watch(const std::string& folder) {
  report::LiveRun run(folder);
  for (int look = 0; look < 3; ++look) run.Look();
  const std::string page = report::LivePage({.title = folder}, run.NewsSince({}));
  return page.empty() ? "the live page is empty" : "";
}

// The other commands that look at a folder.
std::vector<ToolArguments> CommandsOn(const fs::path& folder, const fs::path& sound) {
  return {CompareArguments{.before = sound, .after = folder},
          CompareArguments{.before = folder, .after = sound, .as_json = true},
          ExplainArguments{.folder = folder, .client = {}, .at = {}},
          SnapshotArguments{.from = folder, .out = {}},
          SnapshotArguments{.from = folder.string() + "@0.2s", .out = {}},
          TopicsArguments{.folder = folder, .with_qos = true},
          TraceArguments{.folder = folder, .out = folder.string() + "-trace.json.gz"}};
}

void Write(const Files& files, const fs::path& root) {
  for (const auto& [name, text] : files) {
    fs::create_directories((root / name).parent_path());
    std::ofstream(root / name, std::ios::binary) << text;
  }
}

}  // namespace

Tally FuzzResults(int count, std::uint64_t seed) {
  std::string made = fs::temp_directory_path() / "tcs_fuzz.XXXXXX";
  const fs::path root = mkdtemp(made.data());
  Write(RunFiles("sound"), root);
  Tally tally;
  for (int number = 0; number < count; ++number) {
    Mutator mutator(seed * 1'000'003 + static_cast<std::uint64_t>(number), ResultTokens());
    Files files = SoundFolder(mutator.Below(3));
    std::vector<std::string> texts;
    for (const auto& [name, text] : files) texts.push_back(text);
    std::string damaged;
    for (std::size_t i = 1 + mutator.Below(3); i > 0; --i) {
      const auto file = std::next(files.begin(), static_cast<int>(mutator.Below(files.size())));
      file->second = mutator.Damage(file->second, texts);
      damaged += "== " + file->first + "\n" + file->second;
    }
    Write(files, root);
    if (mutator.OneIn(6)) {
      const auto file = std::next(files.begin(), static_cast<int>(mutator.Below(files.size())));
      PutOther(&mutator, root / file->first);
      damaged += "== " + file->first + " is something else";
    }
    const auto wrong = tally.Count(
        [&](bool* refused) { return Report(root / "run", root / "page.html", refused); });
    if (wrong.has_value()) SayWrong("results", number, *wrong, damaged);
    const auto unfit = tally.Count([&](bool*) { return Fit(root / "run", root / "costs.yaml"); });
    if (unfit.has_value()) SayWrong("results", number, *unfit, damaged);
    const auto unseen = tally.Count([&](bool*) { return Watch(root / "run"); });
    if (unseen.has_value()) SayWrong("results", number, *unseen, damaged);
    for (const ToolArguments& command : CommandsOn(root / "run", root / "sound")) {
      const auto failed = tally.Count([&](bool* refused) { return Do(command, refused); });
      if (failed.has_value()) SayWrong("results", number, *failed, damaged);
    }
    fs::remove_all(root / "run");
  }
  fs::remove_all(root);
  return tally;
}

}  // namespace tcs::fuzz
