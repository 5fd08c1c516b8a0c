// tcsim: the command line.
#include <sys/prctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/basics/version.h"
#include "coordinator/cli/check_command.h"
#include "coordinator/cli/examples_text.h"
#include "coordinator/cli/exec_command.h"
#include "coordinator/cli/manual/help_text.h"
#include "coordinator/cli/new_command.h"
#include "coordinator/cli/preload_library.h"
#include "coordinator/cli/print.h"
#include "coordinator/cli/run_command.h"
#include "coordinator/cli/stop_at.h"
#include "coordinator/cli/tools.h"
#include "coordinator/cli/trials_options.h"
#include "coordinator/cli/user_preload.h"
#include "coordinator/cli/view_command.h"
#include "coordinator/errors/nearest.h"
#include "coordinator/os/files.h"
#include "coordinator/os/guardian.h"
#include "coordinator/view/launch.h"
#include "simbody_bridge/library/physics_library.h"

namespace {

// The sentence about a mistyped word in "tcsim COMMAND --option"; empty where the mistake is
// another one. CLI11 would only say that a command is required, or that something was not expected.
std::string WhatWasMistyped(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  std::vector<std::string> commands;
  const CLI::App* used = nullptr;
  for (const CLI::App* sub : app.get_subcommands(nullptr)) {
    if (!sub->get_group().empty()) commands.push_back(sub->get_name());
    if (sub->get_name() == argv[1]) used = sub;
  }
  if (used == nullptr) {
    return fmt::format("there is no command '{}'; {}", argv[1],
                       tcs::Suggest(argv[1], commands, "commands"));
  }
  for (int i = 2; i < argc && std::strcmp(argv[i], "--") != 0; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    if (word.rfind("--", 0) != 0 || used->get_option_no_throw(word) != nullptr) continue;
    std::vector<std::string> options;
    for (const CLI::Option* option : used->get_options()) {
      if (!option->get_lnames().empty() && !option->get_group().empty()) {
        options.push_back("--" + option->get_lnames().front());
      }
    }
    return fmt::format("{} has no option {}; {}", used->get_name(), word,
                       tcs::Suggest(word, options, "options"));
  }
  return {};
}

// Joins an option with the word after it, if it has one: "--record mcap" becomes "--record=mcap".
// CLI11 would take whatever comes after the option, the scenario, too.
std::vector<std::string> WithRecordJoined(int argc, char** argv) {
  std::vector<std::string> words;
  bool is_ours = true;  // words after "--" are a program's
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    is_ours = is_ours && word != "--";
    const bool is_format = is_ours && (word == "mcap" || word == "sqlite3");
    if (is_format && !words.empty() && words.back() == "--record") {
      words.back() += "=" + std::string(word);
    } else {
      words.emplace_back(word);
    }
  }
  return words;
}

// An error about something that is asked for and cannot be: a whole sentence.
class PlainError final : public CLI::ParseError {
 public:
  explicit PlainError(const std::string& sentence)
      : ParseError("PlainError", sentence, tcs::kCannotRun) {}
};

// CLI11's own sentences, with our status: nothing was run.
int Parse(CLI::App& app, int argc, char** argv) {
  try {
    std::vector<std::string> words = WithRecordJoined(argc, argv);
    std::ranges::reverse(words);  // CLI11 wants the last word first
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    if (dynamic_cast<const PlainError*>(&error) != nullptr) return tcs::Fail(error.what());
    const std::string mistyped = WhatWasMistyped(app, argc, argv);
    const auto used = app.get_subcommands();
    const std::string help =
        used.empty() ? "tcsim --help" : "tcsim " + used[0]->get_name() + " --help";
    tcs::Fail(!mistyped.empty()
                  ? mistyped
                  : std::string(error.what()) + "; `" + help + "` shows what there is");
    return tcs::kCannotRun;
  }
  return -1;
}

}  // namespace

int main(int argc, char** argv) {
  tcs::SetPhysicsLibrary(tcs::PhysicsLibrary());
  CLI::App app{"run robot programs in a simulation in which computing takes time", "tcsim"};
  app.formatter(tcs::HelpFormatter());  // before the commands, which inherit it
  app.require_subcommand(1);
  app.set_help_flag("-h,--help", "print this help, and exit");
  app.set_version_flag("--version", std::string("tcsim ") + tcs::kVersion,
                       "print the version, and exit");
  tcs::RunOptions options;
  options.user_preload = tcs::TakeUserPreload(argv);

  tcs::RunArguments arguments;
  std::uint64_t seed = 0;
  CLI::App* run = app.add_subcommand("run", "run a scenario");
  run->add_option("scenario", arguments.scenario, "FILE: the YAML file (docs/SCENARIO.md)")
      ->capture_default_str();
  run->add_option("--duration", arguments.duration,
                  "TIME: how much virtual time the run lasts, such as 20s");
  run->add_option(
      "--stop-at", arguments.stop_at,
      "TIME: stop at this virtual time, such as 12.5s, and write the world as it is then into "
      "snapshot.yaml, a piece of a scenario for --overlay");
  run->add_option_function<std::string>(
         "--from", [](const std::string& from) { throw PlainError(tcs::NoWayBack(from)); },
         "DIR@TIME: refused, because programs cannot go on from the middle of a run; says what is "
         "possible instead")
      ->expected(1);
  run->add_option("--drift", arguments.drift,
                  "TIME: how far progress may drift apart, such as 1ms");
  run->add_option("--patience", arguments.patience,
                  "TIME: how long, of real time, a program may compute while its clock stands: "
                  "without a call under --accounting fixed (default: 5s), on an ideal robot, or "
                  "under --sync callback (default: 10s)");
  CLI::Option* seeded =
      run->add_option("--seed", seed, "the seed, which replaces ${seed} in the scenario");
  run->add_option("--overlay", arguments.overlays,
                  "FILE: a piece of a scenario whose values replace the scenario's, such as what "
                  "`tcsim fit` writes; repeatable")
      ->allow_extra_args(false);
  run->add_option(
         "--set", arguments.set,
         "KEY=VALUE: another value for a key of the scenario, such as dynamics.engine=ode; "
         "repeatable")
      ->allow_extra_args(false);
  run->add_option("--out", arguments.out, "FOLDER: where logs, body states, trace and summary go")
      ->capture_default_str();
  run->add_flag("--check", arguments.check,
                "only load the scenario, and report whether it is correct");
  run->add_flag("--strict", arguments.strict,
                "each warning is an error, of the scenario (exit status 2) and of the run (3)");
  run->add_option("--junit", arguments.junit,
                  "FILE: write what the scenario expects, and whether it came to that, as JUnit "
                  "XML");
  std::string record;
  run->add_flag("--record{sqlite3}", record,
                "also write all messages and where bodies are into the folder, as the rosbag2 bag "
                "`bag`; --record mcap: as an MCAP file, which Foxglove, Lichtblick and PlotJuggler "
                "open, too")
      ->check(CLI::IsMember({"sqlite3", "mcap"}));
  bool for_fit = false;
  run->add_flag("--for-fit", for_fit,
                "also count each client's calls and allocations, which `tcsim fit` needs");
  std::string view;
  run->add_flag(
         "--view", view,
         "show the run while it goes, in a browser at the address that is printed; --view=PORT or "
         "--view=ADDRESS:PORT chooses the address (default: a free port, for this machine only)")
      ->type_name("[=WHERE]");
  run->add_option("--pace", arguments.pace,
                  "the pace of virtual time, as a multiple of the wall clock; 1 for people and "
                  "devices beside the run (default: as fast as possible)")
      ->check(CLI::Range(1e-3, 1e3));
  run->add_flag("--pause", arguments.pauses,
                "with --view: paused at the start, until the page lets the run go on");
  run->add_option("--gdb", arguments.debugged,
                  "ROBOT/CLIENT: open that client in gdb, before it begins; virtual time stands "
                  "still while gdb has stopped it");
  run->add_option("--progress-fd", arguments.progress_fd)->group("");  // not for people
  std::string sync = "consistent";
  run->add_option("--sync", sync,
                  "consistent: world and programs advance together (default); callback: the world "
                  "stands still while programs compute, as in today's simulators")
      ->check(CLI::IsMember({"consistent", "callback"}));

  tcs::TrialsArguments trials_arguments;
  const CLI::App* trials = tcs::AddTrials(&app, &trials_arguments);

  tcs::NewArguments new_arguments;
  const CLI::App* make_new = tcs::AddNew(&app, &new_arguments);
  tcs::CheckArguments check_arguments;
  const CLI::App* check = tcs::AddCheck(&app, &check_arguments);
  tcs::GenerateArguments generate_arguments{&app, {}};
  CLI::App* generate = app.add_subcommand("generate")->group("");  // for the build
  generate->add_option("folder", generate_arguments.folder)->required();
  tcs::SlurmJobArguments slurm_arguments;
  CLI::App* slurm_job = app.add_subcommand("slurm-job")->group("");  // for trials on a cluster
  slurm_job->add_option("folder", slurm_arguments.folder)->required();

  double speed = 1.0;
  int cores = 1;
  std::vector<std::string> command;
  CLI::App* exec = app.add_subcommand("exec", "run any program in virtual time, without dynamics");
  exec->add_option("--speed", speed, "the speed of the program's processor, relative to the host's")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  exec->add_option("--cores", cores, "how many processors the program has")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  std::string wakeup;
  exec->add_option("--wakeup", wakeup,
                   "TIME: how long waking a thread takes that has waited, or MEDIAN,P99, such as "
                   "20us,80us (default: 0)");
  std::string costs;
  exec->add_option("--costs", costs,
                   "FILE: what a computer takes for DDS samples beyond what the program computes "
                   "for them, or none (default: what tcs has measured)");
  bool patch_vdso = true;
  exec->add_flag("--patch-vdso,!--no-patch-vdso", patch_vdso,
                 "leave the vDSO as it is: programs that read the kernel's clocks past the C "
                 "library's symbols, and the C library's own reads, see the host's time");
  std::string cycle_counter = "virtual";
  exec->add_option(
          "--rdtsc", cycle_counter,
          "what the program reads of the processor's cycle counter; virtual: in step with the "
          "virtual time (default); host: the host's")
      ->check(CLI::IsMember({"virtual", "host"}));
  std::string uptime;
  exec->add_option("--uptime", uptime,
                   "TIME: CLOCK_MONOTONIC when the program starts (default: 1000s)");
  std::string date;
  exec->add_option("--date", date,
                   "DATE: CLOCK_REALTIME when the program starts, such as 2005-03-18, at 0:00 UTC "
                   "(default: now; under --accounting fixed 2024-01-01)");
  std::string call_cost;
  exec->add_option("--call-cost", call_cost,
                   "TIME: the cost of one call under --accounting fixed (default: 1us)");
  std::string allocation_cost;
  exec->add_option("--allocation-cost", allocation_cost,
                   "TIME: the cost of one memory allocation under --accounting fixed; 0 for none "
                   "(default: 250ns, and 2us where a thread makes thousands without waiting)");
  std::string patience;
  exec->add_option("--patience", patience,
                   "TIME: how long, of real time, a thread may compute without a call under "
                   "--accounting fixed before that costs it time (default: 5s)");
  std::string dds = "endpoints";
  exec->add_option(
          "--dds", dds,
          "how programs that use Cyclone DDS reach each other; endpoints: in shared memory "
          "(default); sockets: by their own protocol")
      ->check(CLI::IsMember({"endpoints", "sockets"}));
  std::vector<std::string> outside;
  exec->add_option("--outside", outside,
                   "NAME: a file (a FIFO, a terminal, a device) or a socket (its path, @NAME, or "
                   "ADDRESS:PORT) by which what is outside of the run answers in real time; "
                   "repeatable. Devices, and peers outside to which the program has sent "
                   "something, need no name")
      ->expected(1)
      ->type_size(1);
  std::string outside_takes;
  exec->add_option("--outside-takes", outside_takes,
                   "TIME: how long each answer from outside takes under --accounting fixed "
                   "(default: 5ms)");
  exec->add_option("command", command, "the program and its arguments, after --")->required();
  exec->positionals_at_end();

  tcs::ReportArguments report_arguments;
  CLI::App* report =
      app.add_subcommand("report", "make one HTML page of the results of runs and trials");
  report
      ->add_option("folders", report_arguments.folders,
                   "FOLDER: what `tcsim run` or `tcsim trials` wrote")
      ->required();
  report->add_option("--out", report_arguments.out, "FILE: the page")->capture_default_str();
  report
      ->add_option("--figures", report_arguments.figures,
                   "svg or png: also write each figure as a file next to the page")
      ->check(CLI::IsMember({"svg", "png"}));
  report->add_option("--bodies", report_arguments.bodies,
                     "A,B: the two bodies whose distance is shown (default: the first two)");
  report
      ->add_option("--mark", report_arguments.marks,
                   "METRES: a distance that figures mark and tables count below; repeatable")
      ->expected(1)
      ->take_all()
      ->check(CLI::NonNegativeNumber);
  report
      ->add_option("--measure", report_arguments.measures,
                   "NAME: a figure of trials with varied values, such as controller.misses or "
                   "controller.response_p99, shown against a varied key; repeatable (default: "
                   "missed deadlines)")
      ->allow_extra_args(false);
  report->add_option("--against", report_arguments.against,
                     "KEY: the varied key of these figures, such as cpu.speed (default: the "
                     "processor's speed, or the key with the most values)");
  report->add_option("--title", report_arguments.title,
                     "TITLE: the title of the page (default: the scenario's name)");

  std::string viewed, view_where;
  CLI::App* show =
      app.add_subcommand("view", "show a result folder in a browser, also while the run goes on");
  show->add_option("folder", viewed, "FOLDER: what `tcsim run` writes, or wrote")->required();
  show->add_option(
      "--at", view_where,
      "WHERE: PORT or ADDRESS:PORT to listen at (default: a free port, for this machine only)");

  tcs::TopicsArguments topics_arguments;
  CLI::App* topics = app.add_subcommand(
      "topics",
      "list the DDS topics of a run: types, rates, both ends, and readers that no writer suits");
  topics->add_option("folder", topics_arguments.folder, "FOLDER: what run wrote")->required();
  topics->add_flag("--qos", topics_arguments.with_qos,
                   "also list the quality of service of each endpoint");

  tcs::TraceArguments trace_arguments;
  CLI::App* trace = app.add_subcommand("trace", "make one trace of a run for ui.perfetto.dev");
  trace->add_option("folder", trace_arguments.folder, "FOLDER: what run wrote")->required();
  trace->add_option("--out", trace_arguments.out,
                    "FILE: the trace to write (default: trace.json.gz in the folder)");

  tcs::SnapshotArguments snapshot_arguments;
  CLI::App* snapshot = app.add_subcommand(
      "snapshot", "write the world of a run at one moment as a piece of a scenario");
  snapshot
      ->add_option("from", snapshot_arguments.from,
                   "FOLDER[@TIME]: what `tcsim run` wrote, and the moment (default: the end)")
      ->required();
  snapshot->add_option(
      "--out", snapshot_arguments.out,
      "FILE: where to write it, for `tcsim run --overlay` (default: the terminal)");

  tcs::ExplainArguments explain_arguments;
  const CLI::App* explain = tcs::AddExplain(&app, &explain_arguments);

  tcs::FitArguments fit_arguments;
  CLI::App* fit = app.add_subcommand(
      "fit", "find the set costs with which --accounting fixed charges what a run has measured");
  fit->add_option("folder", fit_arguments.folder, "FOLDER: what `tcsim run --for-fit` wrote")
      ->required();
  fit->add_option(
      "--out", fit_arguments.out,
      "FILE: where to write the costs, for `tcsim run --overlay` (default: the terminal)");

  tcs::DumpArguments dump_arguments;
  const CLI::App* dump = tcs::AddDump(&app, &dump_arguments);

  tcs::CompareArguments compare_arguments;
  const CLI::App* compare = tcs::AddCompare(&app, &compare_arguments);

  tcs::DoctorArguments doctor_arguments;
  CLI::App* doctor = app.add_subcommand(
      "doctor", "check what this machine allows, and say how to mend what it does not");
  doctor->add_flag("--json", doctor_arguments.as_json, "for programs");
  doctor->add_flag("--calibrate", doctor_arguments.calibrates,
                   "measure for two seconds how long this machine takes to wake a thread, as "
                   "cpu.wakeup has it");

  std::string accounting = "measured";
  bool no_wait = false;
  std::string host_cpus = "auto";
  for (CLI::App* sub : {run, exec}) {
    sub->add_option("--host-cpus", host_cpus,
                    "at most so many processors of the host, or auto for all that no other run "
                    "has: on further ones programs compute ahead, and islands of the physics are "
                    "integrated (default: auto)")
        ->check(CLI::IsMember({"auto"}) | CLI::Range(1, 1024));
    sub->add_flag("--no-wait", no_wait,
                  "if other runs have all processors, fail at once and name those runs");
    sub->add_option("--accounting", accounting,
                    "measured: computing takes the processor time that it takes (default); fixed: "
                    "each call has a set cost, and two runs are identical")
        ->check(CLI::IsMember({"measured", "fixed"}));
  }
  tcs::AddExamples(&app);
  if (const int status = Parse(app, argc, argv); status >= 0) return status;
  if (make_new->parsed()) return tcs::FlushStdout(tcs::NewCommand(new_arguments));
  if (check->parsed()) return tcs::FlushStdout(tcs::CheckCommand(check_arguments));
  if (show->parsed()) return tcs::ViewCommand(viewed, view_where);
  if (generate->parsed()) return tcs::DoWithTools(generate_arguments, argv);
  if (dump->parsed()) return tcs::DoWithTools(dump_arguments, argv);
  if (compare->parsed()) return tcs::DoWithTools(compare_arguments, argv);
  if (doctor->parsed()) return tcs::DoWithTools(doctor_arguments, argv);
  if (explain->parsed()) return tcs::DoWithTools(explain_arguments, argv);
  if (report->parsed()) return tcs::DoWithTools(report_arguments, argv);
  if (topics->parsed()) return tcs::DoWithTools(topics_arguments, argv);
  if (trace->parsed()) return tcs::DoWithTools(trace_arguments, argv);
  if (snapshot->parsed()) return tcs::DoWithTools(snapshot_arguments, argv);
  if (fit->parsed()) return tcs::DoWithTools(fit_arguments, argv);

  if (accounting == "fixed") options.accounting = tcs::shm::Accounting::kFixed;
  if (sync == "callback") options.sync = tcs::shm::Sync::kCallback;
  options.preload_library = tcs::PreloadLibrary();
  options.allocation_library = tcs::AllocationLibrary();
  if (getenv("TCS_SOCKET") != nullptr) {
    return tcs::Fail(
        "this tcsim was started inside a run of another tcsim; start it outside of that run");
  }
  for (const std::string& library :
       {options.preload_library, options.allocation_library, tcs::DdsLibrary()}) {
    if (access(library.c_str(), R_OK) != 0) {
      return tcs::Fail("the shim (libtcs_preload.so) is missing: " + library + "; build it again");
    }
  }
  if (!record.empty()) {
    options.record = record == "mcap" ? tcs::RecordingKind::kMcap : tcs::RecordingKind::kSqlite3;
  }
  options.host_cpus = host_cpus == "auto" ? 0 : std::stoi(host_cpus);
  options.counts_work = for_fit;
  options.waits_for_cpu = !no_wait;
  if (seeded->count() > 0) arguments.seed = seed;
  if (arguments.pauses && view.empty()) {
    return tcs::Fail("--pause needs --view, whose page lets the run go on: give both");
  }
  // The server starts before anything else of the run: it is no part of the run.
  std::unique_ptr<tcs::ViewLink> link;
  if (run->parsed() && !view.empty() && !arguments.check) {
    tcs::ViewRequest request{.server = tcs::ViewServer(),
                             .folder = tcs::AbsolutePathOf(arguments.out)};
    const std::string error = tcs::TakeViewAddress(view == "true" ? "" : view, &request);
    if (!error.empty()) return tcs::Fail("--view: " + error);
    auto started = tcs::StartView(request);
    if (const auto* why = std::get_if<std::string>(&started)) return tcs::Fail(*why);
    link = std::move(std::get<std::unique_ptr<tcs::ViewLink>>(started));
    options.view = link.get();
  }
  // A trial's run was started as /proc/self/exe, and would be called "exe".
  if (arguments.progress_fd >= 0) prctl(PR_SET_NAME, "tcsim");
  if (trials->parsed()) return tcs::DoWithTools(trials_arguments, argv);
  if (slurm_job->parsed()) return tcs::DoWithTools(slurm_arguments, argv);
  if (!arguments.debugged.empty()) {
    return tcs::RunWithGdb([&](const tcs::GdbSession& gdb) {
      return tcs::RunGuarded(
          [&] { return tcs::FlushStdout(tcs::RunCommand(arguments, options, gdb)); });
    });
  }
  return tcs::RunGuarded([&] {
    return exec->parsed() ? tcs::ExecCommand({command, speed, cores, wakeup, costs, patch_vdso,
                                              cycle_counter == "host" ? tcs::CycleCounter::kHost
                                                                      : tcs::CycleCounter::kVirtual,
                                              call_cost, allocation_cost,
                                              dds == "sockets" ? tcs::DdsTransport::kSockets
                                                               : tcs::DdsTransport::kEndpoints,
                                              uptime, date, outside, outside_takes, patience},
                                             options)
                          : tcs::FlushStdout(tcs::RunCommand(arguments, options));
  });
}
