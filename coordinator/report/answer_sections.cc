#include "coordinator/report/answer_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "coordinator/report/expected_words.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// How many clients have a deadline, how many have none, and how many activations were judged.
struct Judged {
  std::int64_t clients = 0, without = 0, judged = 0;
};

Judged JudgedIn(const Run& run) {
  Judged judged;
  for (const auto& [name, client] : run.clients) {
    if (!client.deadline.has_value()) {
      ++judged.without;
      continue;
    }
    ++judged.clients;
    judged.judged += client.deadline->judged;
  }
  for (const Chain& chain : run.chains) {
    if (chain.deadline_ns == 0) continue;
    ++judged.clients;
    judged.judged += chain.age.count;
  }
  return judged;
}

// The sentence for a run in which nothing was worth one.
std::string AllClear(const Run& run) {
  if (!run.has_answers) {
    return "There is none: the run was made by an earlier version of tcs. Make it again to see "
           "deadlines, response times and ages.";
  }
  const Judged judged = JudgedIn(run);
  if (judged.clients == 0) {
    return "No client has a deadline, so none could be missed. A client gets one by “deadline:” in "
           "the scenario, a periodic one also by the timer or the sensor that it follows.";
  }
  if (judged.judged == 0) return "No activation came to its end that has a deadline.";
  return fmt::format(
      "{} met.{}",
      judged.judged == 1 ? std::string("The only deadline was")
                         : fmt::format("All {} deadlines were", Grouped(judged.judged)),
      judged.without > 0
          ? fmt::format(" {} no deadline.", judged.without == 1
                                                ? std::string("One client has")
                                                : fmt::format("{} clients have", judged.without))
          : "");
}

std::string SentencesOf(const Run& run) {
  if (run.verdict.empty()) {
    return fmt::format("<p class=\"clear\">{}</p>\n", Escaped(AllClear(run)));
  }
  std::string items;
  for (const std::string& sentence : run.verdict)
    items += fmt::format("<li>{}.</li>\n", Escaped(sentence));
  return fmt::format("<ol class=\"verdict{}\">\n{}</ol>\n", run.is_whole ? "" : " is-broken",
                     items);
}

std::string ExpectationsOf(const System& system) {
  const std::string sentence = ExpectedSentence(system);
  if (sentence.empty()) return {};
  std::string items;
  for (const std::string& one : NotAsExpected(system))
    items += fmt::format("<li>{}</li>\n", Escaped(one));
  if (!items.empty()) items = "<ul class=\"unexpected\">\n" + items + "</ul>\n";
  return fmt::format("<p class=\"expected\">{}{}</p>\n{}", Escaped(sentence),
                     items.empty() ? "" : " Not as expected:", items);
}

// Says of how many runs there is something to say.
std::string OverRuns(const System& system) {
  const auto worth =
      std::ranges::count_if(system.runs, [](const Run& run) { return !run.verdict.empty(); });
  return fmt::format("{} of {} have findings; those of the first:", worth,
                     Count(static_cast<std::int64_t>(system.runs.size()), "trial"));
}

std::string Milliseconds(std::int64_t ns) { return Seconds(static_cast<double>(ns) * 1e-9); }

// The figures of all runs together: sums, and the worst.
struct InAll {
  std::int64_t deadline_ns = 0, judged = 0, missed = 0, count = 0;
  std::int64_t p99_ns = 0, max_ns = 0, age_count = 0, age_p99_ns = 0, age_max_ns = 0;
  std::string period_of;
};

void AddTimes(const Quantiles& times, const Quantiles& age, InAll* all) {
  all->count += times.count;
  all->p99_ns = std::max(all->p99_ns, times.p99_ns);
  all->max_ns = std::max(all->max_ns, times.max_ns);
  all->age_count += age.count;
  all->age_p99_ns = std::max(all->age_p99_ns, age.p99_ns);
  all->age_max_ns = std::max(all->age_max_ns, age.max_ns);
}

std::string MissedText(const InAll& all) {
  if (all.deadline_ns == 0) return "–";
  if (all.judged == 0) return "0 of 0";
  return fmt::format("{} of {} ({})", Grouped(all.missed), Grouped(all.judged),
                     Percent(static_cast<double>(all.missed) / static_cast<double>(all.judged)));
}

std::string DeadlineText(const InAll& all) {
  if (all.deadline_ns == 0) return "none";
  return Milliseconds(all.deadline_ns) +
         (all.period_of.empty() ? "" : ", the period of " + all.period_of);
}

std::vector<std::string> WithSystem(const Results& results, const std::string& name,
                                    const System& system) {
  if (results.systems.size() > 1) return {name, system.name};
  return {name};
}

std::vector<Column> FirstColumns(const Results& results, const char* what) {
  if (results.systems.size() > 1) return {{what, false}, {"system", false}};
  return {{what, false}};
}

bool HasSeveralRuns(const Results& results) {
  return std::ranges::any_of(results.systems,
                             [](const System& system) { return system.runs.size() > 1; });
}

std::string CaptionOf(const Results& results, const std::string& what) {
  return what + (HasSeveralRuns(results)
                     ? " Over all trials: sums of misses, and of the times the greatest."
                     : "");
}

}  // namespace

std::string VerdictHtml(const Results& results) {
  std::string html;
  for (const System& system : results.systems) {
    if (system.runs.empty()) continue;
    std::string head;
    if (results.systems.size() > 1) head = Quoted(system.name);
    if (system.runs.size() > 1) head += (head.empty() ? "" : ": ") + OverRuns(system);
    if (!head.empty()) html += fmt::format("<p class=\"of-system\">{}</p>\n", Escaped(head));
    html += SentencesOf(system.runs.front()) + ExpectationsOf(system);
  }
  return html;
}

std::optional<Section> InTimeSection(const Results& results) {
  std::vector<Column> columns = FirstColumns(results, "client");
  columns.insert(columns.end(), {{"missed"},
                                 {"deadline", false},
                                 {"response, 99 %"},
                                 {"longest"},
                                 {"data age, 99 %"},
                                 {"oldest"}});
  Table table(
      CaptionOf(results,
                "In virtual time. A response is from when its cause was there to the end of "
                "the work; the age is that of the sample that a command was made of, or "
                "else of what the client read."),
      columns);
  std::map<std::pair<std::string, std::size_t>, InAll> clients;
  for (std::size_t i = 0; i < results.systems.size(); ++i) {
    for (const Run& run : results.systems[i].runs) {
      if (!run.has_answers) continue;
      for (const auto& [name, client] : run.clients) {
        InAll& all = clients[{name, i}];
        AddTimes(client.response, client.data_age, &all);
        if (!client.deadline.has_value()) continue;
        all.deadline_ns = client.deadline->deadline_ns;
        all.period_of = client.deadline->period_of;
        all.judged += client.deadline->judged;
        all.missed += client.deadline->missed;
      }
    }
  }
  if (clients.empty()) return {};
  std::int64_t late = 0, judged = 0;
  for (const auto& [key, all] : clients) {
    std::vector<std::string> cells = WithSystem(results, key.first, results.systems[key.second]);
    const auto time = [](std::int64_t count, std::int64_t ns) {
      return count > 0 ? Milliseconds(ns) : "–";
    };
    cells.insert(cells.end(), {MissedText(all), DeadlineText(all), time(all.count, all.p99_ns),
                               time(all.count, all.max_ns), time(all.age_count, all.age_p99_ns),
                               time(all.age_count, all.age_max_ns)});
    table.Row(std::move(cells));
    late += all.missed;
    judged += all.judged;
  }
  return Section{
      "Who was in time",
      judged == 0 ? "No activation had a deadline."
                  : fmt::format("{} of {} deadlines {} missed.", late == 0 ? "None" : Grouped(late),
                                Grouped(judged), late > 1 ? "were" : "was"),
      table.Html(), table.Text()};
}

std::optional<Section> ChainsSection(const Results& results) {
  std::vector<Column> columns = FirstColumns(results, "chain");
  columns.insert(columns.end(), {{"missed"}, {"deadline", false}, {"age, 99 %"}, {"oldest"}});
  Table table(CaptionOf(results,
                        "From a sensor's sample, over all programs between, to what acted on it: "
                        "how old the sample was then."),
              columns);
  std::map<std::pair<std::string, std::size_t>, InAll> chains;
  std::pair<std::int64_t, std::string> oldest{-1, ""};
  for (std::size_t i = 0; i < results.systems.size(); ++i) {
    for (const Run& run : results.systems[i].runs) {
      for (const Chain& chain : run.chains) {
        InAll& all = chains[{chain.name, i}];
        AddTimes({}, chain.age, &all);
        all.deadline_ns = chain.deadline_ns;
        all.judged += chain.age.count;
        all.missed += chain.missed;
        if (chain.age.count > 0) oldest = std::max(oldest, {chain.age.max_ns, chain.name});
      }
    }
  }
  if (chains.empty()) return {};
  for (const auto& [key, all] : chains) {
    std::vector<std::string> cells = WithSystem(results, key.first, results.systems[key.second]);
    const bool any = all.age_count > 0;
    cells.insert(cells.end(),
                 {MissedText(all), DeadlineText(all), any ? Milliseconds(all.age_p99_ns) : "–",
                  any ? Milliseconds(all.age_max_ns) : "–"});
    table.Row(std::move(cells));
  }
  return Section{"From sensors to actuators",
                 oldest.first < 0 ? "No command knew of any sample."
                                  : fmt::format("The oldest sample that anything acted on was {} "
                                                "old, by {}.",
                                                Milliseconds(oldest.first), oldest.second),
                 table.Html(), table.Text()};
}

}  // namespace tcs::report
