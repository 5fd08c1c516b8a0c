#include "coordinator/computer/computer_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <utility>

namespace tcs {

namespace {

std::vector<std::string_view> SplitAt(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(at), text.size());
    parts.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

// "core id		: 1" with another value, if it is a line of that name.
std::string Line(std::string_view line, std::size_t core, std::size_t cores) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return std::string(line);
  std::string_view name = line.substr(0, colon);
  while (!name.empty() && (name.back() == '\t' || name.back() == ' ')) name.remove_suffix(1);
  const auto with = [&](std::size_t value) {
    return fmt::format("{} {}", line.substr(0, colon + 1), value);
  };
  for (const std::string_view own : {"processor", "core id", "apicid", "initial apicid"}) {
    if (name == own) return with(core);
  }
  if (name == "siblings" || name == "cpu cores") return with(cores);
  if (name == "physical id") return with(0);
  return std::string(line);
}

// The numbers of /proc/PID/stat as the manual counts them, from 1 on. The name, which may hold
// anything, ends with the last parenthesis; the state follows.
class Fields {
 public:
  static constexpr std::size_t kState = 3, kUser = 14, kSystem = 15, kChildrenUser = 16,
                               kChildrenSystem = 17, kPriority = 18, kNice = 19, kStart = 22,
                               kCore = 39, kRealTimePriority = 40, kPolicy = 41;

  explicit Fields(std::string_view text) {
    const std::size_t end = text.rfind(')');
    if (end == std::string_view::npos) return;
    head_ = text.substr(0, end + 1);
    text.remove_prefix(std::min(end + 2, text.size()));
    while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
    for (const std::string_view field : SplitAt(text, ' ')) fields_.emplace_back(field);
  }

  std::int64_t Number(std::size_t field) const {
    std::int64_t value = 0;
    if (const std::string* text = At(field)) {
      std::from_chars(text->data(), text->data() + text->size(), value);
    }
    return value;
  }
  char State() const {
    const std::string* text = At(kState);
    return text == nullptr || text->empty() ? '?' : text->front();
  }
  void Set(std::size_t field, std::int64_t value) { Set(field, std::to_string(value)); }
  void Set(std::size_t field, std::string value) {
    if (field - kState < fields_.size()) fields_[field - kState] = std::move(value);
  }
  std::string Text() const {
    std::string text = head_;
    for (const std::string& field : fields_) text.append(" ").append(field);
    return text + "\n";
  }

 private:
  const std::string* At(std::size_t field) const {
    return field - kState < fields_.size() ? &fields_[field - kState] : nullptr;
  }

  std::string head_;
  std::vector<std::string> fields_;
};

bool IsRunnableOrAsleep(char state) { return state == 'R' || state == 'S' || state == 'D'; }

}  // namespace

std::string CoreList(std::uint64_t cores) {
  std::string list;
  for (int core = 0; core < 64; ++core) {
    if ((cores >> core & 1) == 0) continue;
    const int first = core;
    while (core < 63 && (cores >> (core + 1) & 1) != 0) ++core;
    if (!list.empty()) list += ',';
    list += first == core ? std::to_string(first) : fmt::format("{}-{}", first, core);
  }
  return list;
}

std::string CoreMask(std::uint64_t cores, std::size_t of) {
  if (of <= 32) return fmt::format("{:0{}x}", cores, (std::max<std::size_t>(of, 1) + 3) / 4);
  return fmt::format("{:0{}x},{:08x}", cores >> 32, (of - 32 + 3) / 4, cores & 0xffffffff);
}

std::string ProcessorTable(std::string_view of_host, std::size_t cores) {
  std::vector<std::string_view> processors;
  while (!of_host.empty()) {
    const std::size_t end = std::min(of_host.find("\n\n"), of_host.size());
    if (of_host.substr(0, end).find("processor") != std::string_view::npos) {
      processors.push_back(of_host.substr(0, end));
    }
    of_host.remove_prefix(std::min(end + 2, of_host.size()));
  }
  if (processors.empty()) return {};
  std::string table;
  for (std::size_t core = 0; core < cores; ++core) {
    for (const std::string_view line : SplitAt(processors[core % processors.size()], '\n')) {
      table += Line(line, core, cores) + "\n";
    }
    table += "\n";
  }
  return table;
}

std::string UptimeText(std::int64_t uptime_ns, const std::vector<std::int64_t>& busy_ns) {
  std::int64_t idle_ns = 0;
  for (const std::int64_t busy : busy_ns) idle_ns += std::max<std::int64_t>(0, uptime_ns - busy);
  const std::int64_t up = uptime_ns / kNsPerTick, idle = idle_ns / kNsPerTick;
  return fmt::format("{}.{:02} {}.{:02}\n", up / 100, up % 100, idle / 100, idle % 100);
}

std::string CountersText(const Counters& counters) {
  std::string cores;
  std::int64_t busy_sum = 0, idle_sum = 0;
  const std::int64_t up = counters.uptime_ns / kNsPerTick;
  for (std::size_t core = 0; core < counters.busy_ns.size(); ++core) {
    const std::int64_t busy = counters.busy_ns[core] / kNsPerTick;
    const std::int64_t idle = std::max<std::int64_t>(0, up - busy);
    busy_sum += busy;
    idle_sum += idle;
    cores += fmt::format("cpu{} {} 0 0 {} 0 0 0 0 0 0\n", core, busy, idle);
  }
  return fmt::format(
      "cpu  {} 0 0 {} 0 0 0 0 0 0\n{}intr 0\nctxt {}\nbtime {}\nprocesses {}\nprocs_running {}\n"
      "procs_blocked 0\nsoftirq 0 0 0 0 0 0 0 0 0 0 0\n",
      busy_sum, idle_sum, cores, counters.switches, counters.boot_date_ns / 1'000'000'000,
      counters.processes, counters.running);
}

std::string ProcessCounters(std::string_view of_host, const ProcessFacts& facts) {
  Fields fields(of_host);
  if (IsRunnableOrAsleep(fields.State())) fields.Set(Fields::kState, std::string(1, facts.state));
  fields.Set(Fields::kUser, facts.user_ns / kNsPerTick);
  fields.Set(Fields::kSystem, facts.system_ns / kNsPerTick);
  fields.Set(Fields::kChildrenUser, facts.children_ns / kNsPerTick);
  fields.Set(Fields::kChildrenSystem, 0);
  const int priority = facts.real_time_priority;
  fields.Set(Fields::kPriority, priority > 0 ? -1 - priority : 20 + fields.Number(Fields::kNice));
  fields.Set(Fields::kStart, facts.started_ns / kNsPerTick);
  fields.Set(Fields::kCore, facts.core);
  fields.Set(Fields::kRealTimePriority, priority);
  fields.Set(Fields::kPolicy, facts.policy);
  return fields.Text();
}

std::string OutsideProcessCounters(std::string_view of_host, std::int64_t later_ticks) {
  Fields fields(of_host);
  const std::int64_t start = fields.Number(Fields::kStart) + later_ticks;
  fields.Set(Fields::kStart, std::max<std::int64_t>(0, start));
  return fields.Text();
}

ProcessTicks TicksIn(std::string_view process_counters) {
  const Fields fields(process_counters);
  return {fields.Number(Fields::kUser), fields.Number(Fields::kSystem)};
}

std::string ProcessStatus(std::string_view of_host, char state, std::uint64_t cores,
                          std::size_t of) {
  std::string status;
  for (const std::string_view line : SplitAt(of_host, '\n')) {
    const std::string_view name = line.substr(0, line.find(':'));
    if (name == "State" && line.size() > 7 && IsRunnableOrAsleep(line[7])) {
      status += state == 'R' ? "State:\tR (running)" : "State:\tS (sleeping)";
    } else if (name == "Cpus_allowed") {
      status += "Cpus_allowed:\t" + CoreMask(cores, of);
    } else if (name == "Cpus_allowed_list") {
      status += "Cpus_allowed_list:\t" + CoreList(cores);
    } else {
      status += line;
    }
    status += "\n";
  }
  return status;
}

}  // namespace tcs
