#include "coordinator/answers/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "coordinator/text/spoken.h"

namespace tcs {

namespace {

constexpr std::size_t kMostSentences = 5;
// From that share of the late time on computing is named.
constexpr double kNamed = 0.3;
// A client is starved that waits for that share of the run, and for that share of the time for
// which it was ready.
constexpr double kStarvedRun = 0.25, kStarvedTime = 0.9;
// The share of a client's datagrams that may be unread when the run ends.
constexpr double kUnread = 0.05;
// How many periods old data may be before it is worth a sentence.
constexpr std::int64_t kOldPeriods = 2;

struct Finding {
  double weight = 0;  // the worst first
  std::string sentence;
};

double Share(std::int64_t part, std::int64_t whole) {
  return whole <= 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::string Percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

std::string Of(std::int64_t part, std::int64_t whole) {
  return part == whole ? fmt::format("all {}", whole) : fmt::format("{} of {}", part, whole);
}

std::string DeadlineText(const DeadlineFigures& deadline) {
  const std::string time = Spoken(deadline.deadline_ns);
  return deadline.source.empty() ? time
                                 : fmt::format("{}, the period of {}", time, deadline.source);
}

// Relative to another client, as the robot's scheduler sees them.
std::string_view RankOf(const ClientOutcome& other, const ClientOutcome& client) {
  if (other.name == client.name || !other.priority || !client.priority) return "";
  if (other.priority == client.priority) return ", of the same priority,";
  return other.priority > client.priority ? ", of higher priority," : ", of lower priority,";
}

// The client with the most of a time, and how much; no client and 0 if there is none.
std::pair<std::string, std::int64_t> MostOf(const std::map<std::string, std::int64_t>& times_ns) {
  const auto most =
      std::ranges::max_element(times_ns, {}, [](const auto& one) { return one.second; });
  if (most == times_ns.end()) return {};
  return {most->first, most->second};
}

std::string CauseOf(const ClientOutcome& client, const std::vector<ClientOutcome>& all) {
  const ClientFigures& figures = client.figures;
  const LateTime& late = figures.late;
  const double load =
      figures.times.execution.Mean() / static_cast<double>(figures.deadline.deadline_ns);
  if (figures.deadline.judged > 0 && load > 1) {
    const std::string each = Spoken(std::llround(figures.times.execution.Mean()));
    return figures.deadline.source.empty()
               ? fmt::format("it computes {} each time, longer than its deadline", each)
               : fmt::format("it computes {} each time, {} of a core", each, Percent(load));
  }
  // Input that waited behind earlier work waited for the cause of that.
  const std::int64_t rest = late.total_ns - late.queued_ns;
  const std::int64_t too_much =
      late.total_ns - figures.deadline.missed * figures.deadline.deadline_ns;
  std::int64_t others_ns = 0;
  for (const auto& [name, ns] : late.others_ns) others_ns += ns;
  if (others_ns > 0 && 2 * others_ns >= std::min(too_much, rest)) {
    const auto [name, most_ns] = MostOf(late.others_ns);
    const auto who = std::ranges::find(all, name, &ClientOutcome::name);
    return fmt::format("{}{} had the core for {} of that time",
                       name == client.name ? "another thread of its own" : name,
                       who == all.end() ? "" : RankOf(*who, client),
                       Percent(std::min(1.0, Share(most_ns, rest))));
  }
  if (const auto lock = MostOf(late.locks_ns);
      lock.second > 0 && 2 * lock.second >= std::min(too_much, rest)) {
    const std::string whose = lock.first == client.name ? "another thread of its own"
                              : lock.first.empty()      ? "somebody unknown"
                                                        : lock.first;
    return fmt::format("it waited for a lock that {} had for {} of that time", whose,
                       Percent(std::min(1.0, Share(lock.second, rest))));
  }
  if (late.wakeup_ns > 0 && 2 * late.wakeup_ns >= std::min(too_much, rest))
    return fmt::format("waking it took {} of that time (cpu.wakeup of its robot)",
                       Percent(std::min(1.0, Share(late.wakeup_ns, rest))));
  if (Share(late.executed_ns, rest) >= kNamed)
    return fmt::format("it computes up to {} at a time", Spoken(figures.times.execution.max()));
  return "it waited for something else in the midst of its work";
}

void AddMisses(const ClientOutcome& client, const std::vector<ClientOutcome>& all,
               std::vector<Finding>& findings) {
  const DeadlineFigures& deadline = client.figures.deadline;
  if (deadline.missed == 0) return;
  std::string text =
      fmt::format("{} missed {} of its deadlines ({}), {}the first at {:.3f} s: {}", client.name,
                  Of(deadline.missed, deadline.judged), DeadlineText(deadline),
                  deadline.most_in_a_row > 1 && deadline.most_in_a_row < deadline.missed
                      ? fmt::format("up to {} in a row, ", deadline.most_in_a_row)
                      : "",
                  static_cast<double>(deadline.first_missed_ns) / 1e9, CauseOf(client, all));
  findings.push_back({2 + Share(deadline.missed, deadline.judged), std::move(text)});
}

// Of a client that got next to nothing of its core for a great part of the run.
void AddStarvation(const ClientOutcome& client, const std::vector<ClientOutcome>& all,
                   std::int64_t end_ns, std::vector<Finding>& findings) {
  const LongestWait& wait = client.figures.longest_wait;
  const double of_run = Share(wait.waited_ns, end_ns);
  if (of_run < kStarvedRun || Share(wait.waited_ns, wait.response_ns) < kStarvedTime) return;
  const auto by = std::ranges::find(all, wait.by, &ClientOutcome::name);
  findings.push_back(
      {3 + of_run,
       fmt::format("{} was starved: for {} from {:.3f} s on it was ready, and {}{} had the core",
                   client.name, Spoken(wait.response_ns),
                   static_cast<double>(wait.release_ns) / 1e9, wait.by,
                   by == all.end() ? "" : RankOf(*by, client))});
}

void AddAges(const ClientOutcome& client, std::vector<Finding>& findings) {
  const ClientFigures& figures = client.figures;
  const std::int64_t oldest = figures.command_age.max();
  const std::int64_t period = figures.deadline.deadline_ns;
  if (period <= 0 || oldest <= kOldPeriods * period) return;
  findings.push_back(
      {1 + 1 - Share(period, oldest),
       fmt::format("{} sent commands made of samples up to {} old (half of them of more than {})",
                   client.name, Spoken(oldest), Spoken(figures.command_age.Quantile(0.5)))});
}

void AddLosses(const ClientOutcome& client, std::vector<Finding>& findings) {
  for (const InputFigures& input : client.figures.inputs) {
    const bool is_behind = input.unread > 1 && Share(input.unread, input.sent) > kUnread;
    if (input.lost == 0 && !is_behind) continue;
    std::vector<std::string> parts;
    if (input.lost > 0)
      parts.push_back(fmt::format("{} were lost because its socket was full", input.lost));
    if (input.unread > 0) {
      parts.push_back(fmt::format("{} still waited for it at the end, the oldest since {:.3f} s",
                                  input.unread, static_cast<double>(input.oldest_unread_ns) / 1e9));
    }
    findings.push_back({1 + Share(input.lost + input.unread, input.sent),
                        fmt::format("{} never read {} datagrams from {}: {}", client.name,
                                    Of(input.lost + input.unread, input.sent), input.from,
                                    fmt::join(parts, ", "))});
  }
}

void AddChain(const ChainFigures& chain, std::vector<Finding>& findings) {
  if (chain.deadline_ns == 0) return;
  if (chain.age.count() == 0) {
    findings.push_back({2.5, chain.name + ": no command knew of any of its samples"});
    return;
  }
  if (chain.missed == 0) return;
  const ChainCase& worst = chain.worst.front();
  const auto most = std::ranges::max_element(worst.hops, {}, &ChainHop::ns);
  findings.push_back(
      {2 + Share(chain.missed, chain.age.count()),
       fmt::format("{}: {} commands acted on samples older than {}, the first at {:.3f} s; the "
                   "oldest was {} old, {} of it {}",
                   chain.name, Of(chain.missed, chain.age.count()), Spoken(chain.deadline_ns),
                   static_cast<double>(chain.first_missed_ns) / 1e9, Spoken(worst.AgeNs()),
                   Spoken(most->ns), NameOf(*most))});
}

}  // namespace

std::vector<std::string> VerdictOn(const std::vector<ClientOutcome>& clients,
                                   const std::vector<ChainFigures>& chains, std::int64_t end_ns) {
  std::vector<Finding> findings;
  for (const ClientOutcome& client : clients) {
    AddStarvation(client, clients, end_ns, findings);
    AddMisses(client, clients, findings);
    AddAges(client, findings);
    AddLosses(client, findings);
  }
  for (const ChainFigures& chain : chains) AddChain(chain, findings);
  std::ranges::stable_sort(findings, std::greater<>(), &Finding::weight);
  std::vector<std::string> sentences;
  for (Finding& finding : findings) sentences.push_back(std::move(finding.sentence));
  return sentences;
}

std::vector<std::string> Shortened(std::vector<std::string> verdict) {
  if (verdict.size() <= kMostSentences) return verdict;
  const std::size_t more = verdict.size() - (kMostSentences - 1);
  verdict.resize(kMostSentences - 1);
  verdict.push_back(fmt::format("and {} findings more, in summary.json", more));
  return verdict;
}

}  // namespace tcs
