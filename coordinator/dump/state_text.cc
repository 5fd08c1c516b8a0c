#include "coordinator/dump/state_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string_view>
#include <utility>

#include "coordinator/errors/visible.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

// Lines that are continued under their own text.
class Lines {
 public:
  explicit Lines(std::size_t columns) : columns_(std::max<std::size_t>(columns, 40)) {}

  void Add(std::size_t indent, const std::string& text) {
    std::string line(indent, ' ');
    std::istringstream words(text);
    bool is_empty = true;
    for (std::string word; words >> word;) {
      if (!is_empty && line.size() + 1 + word.size() > columns_) {
        text_ += line + "\n";
        line = std::string(indent + 4, ' ');
        is_empty = true;
      }
      line += (is_empty ? "" : " ") + word;
      is_empty = false;
    }
    text_ += line + "\n";
  }
  void Gap() { text_ += "\n"; }
  std::string Take() { return std::move(text_); }

 private:
  std::size_t columns_;
  std::string text_;
};

std::string Seconds(std::int64_t ns) {
  return fmt::format("{:.6f} s", static_cast<double>(ns) * 1e-9);
}

// A span of the host's time, for which somebody has waited.
std::string Span(std::int64_t ns) {
  if (ns < 10'000) return fmt::format("{} ns", ns);
  if (ns < 10'000'000) return fmt::format("{:.0f} us", static_cast<double>(ns) * 1e-3);
  if (ns < 10'000'000'000) return fmt::format("{:.0f} ms", static_cast<double>(ns) * 1e-6);
  return fmt::format("{:.0f} s", static_cast<double>(ns) * 1e-9);
}

std::int64_t Ns(const Json& of, const char* key) { return of.at(key).get<std::int64_t>(); }
bool Is(const Json& of, const char* key) { return of.value(key, false); }
std::string Text(const Json& of, const char* key) { return Visible(of.value(key, std::string())); }
// A time that may be never: null.
std::string When(const Json& of, const char* key, const char* never) {
  return of.at(key).is_null() ? never : Seconds(Ns(of, key));
}

void AddList(std::string* text, const std::string& more) {
  *text += (text->empty() ? "" : ", ") + more;
}

std::string ListOf(const Json& numbers) {
  std::string text;
  for (const Json& number : numbers) AddList(&text, number.dump());
  return text;
}

std::string StateOfKernel(const std::string& letter) {
  if (letter == "R") return "running or ready";
  if (letter == "S") return "sleeping";
  if (letter == "D") return "in an uninterruptible wait";
  if (letter == "T") return "stopped by a signal";
  if (letter == "t") return "stopped by its tracer";
  if (letter == "Z" || letter == "X") return "dead";
  return letter;
}

std::string KernelText(const Json& kernel) {
  if (kernel.is_null()) return "gone from the kernel";
  std::string text = "the kernel has it " + StateOfKernel(Text(kernel, "state"));
  if (kernel.contains("in")) text += " in " + Text(kernel, "in");
  if (kernel.contains("call")) text += fmt::format(", system call {}", kernel["call"].dump());
  return text + fmt::format(", on processor {}", kernel.at("cpu").dump());
}

const char* WordsFor(const std::string& doing) {
  if (doing == "prepares") return "it prepares the run, or waits for a processor";
  if (doing == "schedules") return "it schedules, or answers a call";
  if (doing == "integrates") return "it integrates the dynamics";
  if (doing == "awaits thread") return "it sleeps until the dispatched thread stops";
  if (doing == "awaits events")
    return "it sleeps until something comes from outside, or for a while";
  if (doing == "writes") return "it writes tables";
  return "it ends the run";
}

class Page {
 public:
  Page(const Json& state, std::size_t columns) : state_(state), lines_(columns) {}

  std::string Text() {
    Coordinator();
    if (!Is(state_, "answered")) {
      Outside();
      return lines_.Take();
    }
    Time();
    World();
    HostCpus();
    for (const Json& robot : state_.at("robots")) Robot(robot);
    Queues();
    return lines_.Take();
  }

 private:
  void Coordinator() {
    const Json& run = state_.at("run");
    const std::string folder = tcs::Text(run, "folder");
    lines_.Add(0, fmt::format("run of process {}{}", run.at("coordinator").dump(),
                              folder.empty() ? "" : ", which writes to " + folder));
    const Json& coordinator = state_.at("coordinator");
    const std::int64_t waited_ns = Ns(coordinator, "waited_ns");
    const std::string doing = tcs::Text(coordinator, "doing");
    std::string did =
        fmt::format("{}, for {} by now", WordsFor(doing), Span(Ns(coordinator, "since_host_ns")));
    if (Is(state_, "answered")) {
      lines_.Add(
          0, fmt::format("the coordinator answered in {}; just before: {}", Span(waited_ns), did));
      return;
    }
    const Json& kernel = coordinator.at("kernel");
    const std::string letter = kernel.is_null() ? "X" : tcs::Text(kernel, "state");
    std::string why = KernelText(kernel);
    if (letter == "t") why += fmt::format(" (process {})", coordinator.at("tracer").dump());
    lines_.Add(0,
               fmt::format("the coordinator does not answer: {} of waiting, in which it computed "
                           "for {}; {}",
                           Span(waited_ns), Span(Ns(coordinator, "computed_ns")), why));
    lines_.Add(0, "as it noted last: " + did);
    lines_.Add(
        0, fmt::format("its last dispatch, of {}: thread {}, {} ago, at {} of virtual time",
                       coordinator.at("dispatches").dump(), coordinator.at("dispatched_tid").dump(),
                       Span(Ns(coordinator, "dispatched_since_host_ns")),
                       Seconds(Ns(coordinator, "virtual_ns"))));
  }

  // The facts that are known without the coordinator.
  void Outside() {
    lines_.Gap();
    lines_.Add(0,
               "Seen from outside: what the kernel says, and what each thread last asked the "
               "coordinator for. Not what threads wait for on each other.");
    for (const Json& process : state_.at("outside").at("processes")) {
      lines_.Gap();
      lines_.Add(
          0, fmt::format("process {} {}{}", process.at("pid").dump(), tcs::Text(process, "name"),
                         Is(process, "registered") ? "" : " (not registered with tcs)"));
      for (const Json& thread : process.at("threads")) {
        std::string text = fmt::format("{} {}: ", thread.at("tid").dump(), NameOf(thread));
        if (const auto slot = thread.find("slot"); slot != thread.end()) {
          text +=
              fmt::format("asked {} at {}", tcs::Text(*slot, "asked"), Seconds(Ns(*slot, "at_ns")));
          if (!slot->at("until_ns").is_null()) text += ", until " + Seconds(Ns(*slot, "until_ns"));
          text += fmt::format("; its clock has shown {}, its gate is {}; ",
                              Seconds(Ns(*slot, "shown_ns")), tcs::Text(*slot, "gate"));
        }
        lines_.Add(2, text + KernelText(thread.at("kernel")));
      }
    }
  }

  void Time() {
    const Json& run = state_.at("run");
    const Json& time = state_.at("time");
    now_ns_ = Ns(time, "virtual_ns");
    lines_.Add(0, fmt::format("{} accounting, {}, {}; {} of real time, {} dispatches",
                              tcs::Text(run, "accounting"), tcs::Text(run, "sync"),
                              Is(run, "levels") ? "real-time priorities" : "unprivileged",
                              Seconds(Ns(run, "real_ns")), time.at("dispatches").dump()));
    std::string text = "virtual time " + Seconds(now_ns_);
    if (!time.at("end_ns").is_null()) text += " of " + Seconds(Ns(time, "end_ns"));
    text += fmt::format("; the furthest part is at {}; the next one acts at {}",
                        Seconds(Ns(time, "furthest_ns")),
                        When(time, "next_ns",
                             "no time that is known: only something from outside, "
                             "or the world, goes on"));
    text += fmt::format("; drift {} of {}", Seconds(Ns(time, "drift_ns")),
                        Seconds(Ns(time, "drift_bound_ns")));
    if (Is(time, "ends")) text += "; the run is over, and its clients have their grace";
    lines_.Add(0, text);
    if (!time.contains("pace")) return;
    if (Is(time, "paused")) {
      lines_.Add(0, "the run stands: it was paused, and waits to be let go on");
    } else {
      lines_.Add(0, fmt::format("pace {} (0: as fast as it can), {} behind", time["pace"].dump(),
                                Span(Ns(time, "behind_pace_ns"))));
    }
  }

  void World() {
    const Json& world = state_.at("world");
    if (world.is_null()) return;
    std::string text = "the world is at " + Seconds(Ns(world, "progress_ns"));
    if (!world.at("lead_ns").is_null()) {
      const std::int64_t lead_ns = Ns(world, "lead_ns");
      text += fmt::format(", {} {} whoever acts next", Seconds(std::abs(lead_ns)),
                          lead_ns < 0 ? "behind" : "ahead of");
    }
    text += fmt::format("; it stops next at {}, and sends at {}; {} samples, {} commands",
                        When(world, "next_stop_ns", "no time"),
                        When(world, "next_output_ns", "no time"), world.at("samples").dump(),
                        world.at("commands").dump());
    if (Ns(world, "commands_kept") > 0) {
      text += fmt::format(", {} commands that do not act yet", world.at("commands_kept").dump());
    }
    for (const Json& one : world.at("readings_on_the_way")) {
      text += fmt::format("; {} readings of {} are on their way", one.at("readings").dump(),
                          tcs::Text(one, "sensor"));
    }
    lines_.Add(0, text);
  }

  void HostCpus() {
    for (const Json& cpu : state_.at("host_cpus")) {
      const std::string number = cpu.at("cpu").dump();
      if (cpu.at("thread").is_null()) {
        lines_.Add(0, fmt::format("processor {} of the host: no thread is dispatched", number));
      } else if (Is(cpu, "ahead")) {
        lines_.Add(0, fmt::format("processor {} of the host: thread {} computes ahead", number,
                                  cpu.at("thread").dump()));
      } else {
        lines_.Add(0, fmt::format("processor {} of the host: thread {} for {}, up to {}", number,
                                  cpu.at("thread").dump(), Span(Ns(cpu, "since_host_ns")),
                                  When(cpu, "horizon_ns", "no end")));
      }
    }
  }

  void Robot(const Json& robot) {
    lines_.Gap();
    lines_.Add(0,
               fmt::format("robot {}{}", tcs::Text(robot, "name"),
                           Is(robot, "ideal") ? ", ideal" : ", speed " + robot.at("speed").dump()));
    for (const Json& core : robot.at("cores")) {
      std::string text =
          fmt::format("core {} at {}", core.at("core").dump(), Seconds(Ns(core, "progress_ns")));
      text += core.at("next_thread").is_null()
                  ? ", idle"
                  : fmt::format(", next: thread {}", core.at("next_thread").dump());
      text += ", acts at " + When(core, "next_ns", "no time that is known");
      if (Is(core, "first")) text += ", the first of all";
      lines_.Add(2, text);
    }
    for (const Json& one : robot.at("to_start")) {
      const std::string after = tcs::Text(one, "after");
      lines_.Add(2, fmt::format("{} is to start {}", tcs::Text(one, "client"),
                                one.at("at_ns").is_null() ? "once " + after + " has ended"
                                                          : "at " + Seconds(Ns(one, "at_ns"))));
    }
    for (const Json& process : robot.at("processes")) Process(process);
  }

  void Process(const Json& process) {
    const bool is_client = Is(process, "is_client");
    std::string text =
        fmt::format("{}{} (process {}, {})", is_client ? "" : "of ", tcs::Text(process, "client"),
                    process.at("pid").dump(), tcs::Text(process, "name"));
    if (Is(process, "stopped")) text += ", stopped by a signal";
    if (Is(process, "unregistered_threads")) text += ", with threads that tcs does not manage";
    if (Ns(process, "clock_lead_ns") != 0) {
      text += ", its clock is ahead by " + Seconds(Ns(process, "clock_lead_ns"));
    }
    lines_.Add(2, text);
    for (const Json& thread : process.at("threads")) Thread(thread);
    for (const Json& timer : process.at("timers")) {
      std::string line = fmt::format(
          "timer {}: at {} of its {}", timer.at("id").dump(), Seconds(Ns(timer, "next_ns")),
          tcs::Text(timer, "clock") == "time" ? "clock" : "processor time");
      if (Ns(timer, "interval_ns") > 0) line += ", every " + Seconds(Ns(timer, "interval_ns"));
      if (Ns(timer, "signal") > 0) line += ", signal " + timer.at("signal").dump();
      lines_.Add(4, line);
    }
  }

  void Thread(const Json& thread) {
    const Json& kernel = thread.at("kernel");
    std::string text =
        fmt::format("{} {} {}", thread.at("tid").dump(), NameOf(thread), tcs::Text(thread, "text"));
    const auto futex = thread.find("futex");
    if (futex != thread.end() && tcs::Text(thread, "text").find(" thread ") == std::string::npos &&
        futex->contains("owner")) {
      text += fmt::format(" that thread {} has", futex->at("owner").dump());
    }
    const std::string state = tcs::Text(thread, "state");
    text += (state == "running" ? ", from " : ", since ") + Seconds(Ns(thread, "since_ns"));
    if (state == "running" && thread.contains("clock_ns")) {
      text += ", its clock is at " + Seconds(Ns(thread, "clock_ns"));
    }
    if (!thread.at("until_ns").is_null()) {
      const std::int64_t until_ns = Ns(thread, "until_ns");
      text += fmt::format(", until {}", Seconds(until_ns));
      if (until_ns > now_ns_) text += fmt::format(" (in {})", Seconds(until_ns - now_ns_));
    }
    lines_.Add(4, text);
    std::string more = tcs::Text(thread, "policy");
    if (Ns(thread, "priority") > 0) more += " " + thread.at("priority").dump();
    if (!thread.at("core").is_null()) AddList(&more, "core " + thread.at("core").dump());
    AddList(&more, "charged " + Seconds(Ns(thread, "charged_ns")));
    if (Ns(thread, "debt_ns") > 0) AddList(&more, "owes " + Seconds(Ns(thread, "debt_ns")));
    if (Is(thread, "computes_ahead")) AddList(&more, "computes ahead");
    if (Is(thread, "trapped_call")) {
      AddList(&more, "in a trapped call");
    } else if (thread.contains("gate")) {
      AddList(&more, "gate " + tcs::Text(thread, "gate"));
    }
    if (futex != thread.end()) {
      AddList(&more, fmt::format("futex {:#x}", futex->at("address").get<std::uint64_t>()));
    }
    lines_.Add(8, more + "; " + KernelText(kernel));
  }

  void Queues() {
    const Json& queues = state_.at("queues");
    lines_.Gap();
    for (const Json& word : queues.at("futexes")) {
      lines_.Add(0, fmt::format("at futex {:#x} of {}: {}", word.at("address").get<std::uint64_t>(),
                                Ns(word, "process") == 0 ? "shared memory"
                                                         : "process " + word.at("process").dump(),
                                ListOf(word.at("waiters"))));
    }
    for (const Json& object : queues.at("kernel_objects")) {
      lines_.Add(0, fmt::format("at kernel object {} (kind {}): {}", object.at("id").dump(),
                                object.at("kind").dump(), ListOf(object.at("waiters"))));
    }
    for (const Json& one : queues.at("dds")) {
      std::string text =
          fmt::format("DDS messages for process {}: {}, {} bytes", one.at("process").dump(),
                      one.at("messages").dump(), one.at("bytes").dump());
      if (!one.at("due_ns").is_null()) text += ", the first due at " + Seconds(Ns(one, "due_ns"));
      if (Is(one, "full")) text += ", no room for more";
      if (Is(one, "delivering")) text += ", being delivered";
      lines_.Add(0, text);
    }
    if (!queues.at("network_next_ns").is_null()) {
      lines_.Add(0,
                 "the network's next packet arrives at " + Seconds(Ns(queues, "network_next_ns")));
    }
    if (!queues.at("unregistered_children").empty()) {
      lines_.Add(0,
                 "processes that never registered: " + ListOf(queues.at("unregistered_children")));
    }
  }

  static std::string NameOf(const Json& thread) {
    const Json& kernel = thread.at("kernel");
    return kernel.is_null() ? "?" : tcs::Text(kernel, "name");
  }

  const Json& state_;
  Lines lines_;
  std::int64_t now_ns_ = 0;
};

}  // namespace

std::string StateText(const Json& state, std::size_t columns) {
  return Page(state, columns).Text();
}

}  // namespace tcs
