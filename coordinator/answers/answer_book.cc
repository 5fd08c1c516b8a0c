#include "coordinator/answers/answer_book.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace tcs {

namespace {

bool IsJudged(ReleaseCause cause) {
  return cause == ReleaseCause::kTime || cause == ReleaseCause::kInput;
}

std::int64_t ToThreeDigits(std::int64_t ns) {
  std::int64_t unit = 1;
  while (ns / unit >= 1000) unit *= 10;
  return (ns + unit / 2) / unit * unit;
}

constexpr std::size_t kMostPeriods = 256;
constexpr const char* kTimer = "its timer";

}  // namespace

void AnswerBook::Open(std::vector<Client> clients) {
  for (Client& client : clients) clients_.push_back({.client = std::move(client)});
}

// What it did before its first sample, or command, was its start.
void AnswerBook::HasBegun(Kept& kept) {
  if (std::exchange(kept.has_begun, true)) return;
  kept.judged = kept.all = {};
  kept.in_a_row = 0;
  kept.sources.clear();
  kept.figures.deadline = {};
  kept.figures.late = {};
}

AnswerBook::Thread& AnswerBook::ThreadOf(const Who& who) {
  Thread& thread = threads_[who.thread];
  thread.client = who.client;
  return thread;
}

void AnswerBook::Took(const Who& who, const Taken& taken) {
  Thread& thread = ThreadOf(who);
  thread.last_sampled_ns = std::max(thread.last_sampled_ns, taken.sampled_ns);
  if (taken.period_ns > 0) {
    thread.takes_samples = true;
    HasBegun(KeptOf(who.client));
  }
  if (taken.activation >= thread.releases.size()) return;
  Release& release = thread.releases[taken.activation];
  if (taken.arrived_ns >= release.at_ns) return;
  release = {taken.arrived_ns, taken.period_ns, std::string(taken.from)};
}

void AnswerBook::Commanded(const Who& who, std::int64_t at_ns) {
  Thread& thread = ThreadOf(who);
  thread.commands = true;
  Kept& kept = KeptOf(who.client);
  HasBegun(kept);
  kept.figures.commands = true;
  if (thread.last_sampled_ns >= 0) kept.figures.command_age.Add(at_ns - thread.last_sampled_ns);
}

std::int64_t AnswerBook::LastSampledOf(int thread) const {
  const auto found = threads_.find(thread);
  return found == threads_.end() ? -1 : found->second.last_sampled_ns;
}

std::int64_t AnswerBook::ReleaseOf(int thread, unsigned receipt, std::int64_t at_ns) const {
  const auto found = threads_.find(thread);
  if (found == threads_.end() || receipt >= found->second.releases.size()) return at_ns;
  if (receipt == 0 && !found->second.is_by_receipt) return at_ns;
  return std::min(at_ns, found->second.releases[receipt].at_ns);
}

void AnswerBook::ForgetReceipts(int thread, unsigned receipts) {
  const auto found = threads_.find(thread);
  if (found == threads_.end() || receipts == 0) return;
  auto& releases = found->second.releases;
  Release goes_on = releases[std::min<std::size_t>(receipts, releases.size() - 1)];
  releases.fill({});
  releases.front() = std::move(goes_on);
  found->second.is_by_receipt = true;
}

void AnswerBook::Dies(int thread) {
  for (auto& [robot, ready] : ready_) ready.erase(thread);
  const auto found = threads_.find(thread);
  if (found == threads_.end()) return;
  JudgeLast(found->second);
  threads_.erase(found);
}

void AnswerBook::Idles(int thread) {
  const auto found = threads_.find(thread);
  if (found == threads_.end()) return;
  found->second.releases.fill({});
  found->second.is_by_receipt = false;
}

void AnswerBook::NeverCameTo(const Who& who, const Taken& waiting, std::int64_t end_ns) {
  Thread& thread = ThreadOf(who);
  thread.releases.front() = {waiting.arrived_ns, waiting.period_ns, std::string(waiting.from)};
  Activation activation{
      .cause = ReleaseCause::kInput, .release_ns = waiting.arrived_ns, .start_ns = end_ns};
  Ended(who, activation, 0, end_ns, 0);
}

void AnswerBook::Ready(const Who& who, std::int64_t at_ns) {
  Thread& thread = ThreadOf(who);
  thread.ready_ns = at_ns;
  thread.others_ns.clear();
  ready_[KeptOf(who.client).client.robot].insert(who.thread);
}

void AnswerBook::Ran(const Who& who, std::int64_t start_ns, std::int64_t end_ns) {
  const Client& runs = KeptOf(who.client).client;
  std::set<int>& ready = ready_[runs.robot];
  for (const int number : ready) {
    if (number == who.thread) continue;
    Thread& waits = threads_[number];
    const std::int64_t overlap_ns = end_ns - std::max(start_ns, waits.ready_ns);
    if (overlap_ns > 0) waits.others_ns[who.client] += overlap_ns / runs.cores;
  }
  // With more cores than one, others that run beside it keep it from nothing.
  if (runs.cores > 1) ready.erase(who.thread);
}

void AnswerBook::Ended(const Who& who, const Activation& activation, unsigned receipt,
                       std::int64_t end_ns, std::int64_t executed_ns) {
  Thread& thread = ThreadOf(who);
  Kept& kept = KeptOf(who.client);
  const std::int64_t start_ns = std::max(activation.start_ns, activation.release_ns);
  Job job{.release_ns = activation.release_ns,
          .response_ns = std::max(end_ns, start_ns) - activation.release_ns,
          .delay_ns = start_ns - activation.release_ns,
          // What was there while the thread was still at something earlier has waited for that.
          .queued_ns = std::max<std::int64_t>(
              0, std::min(thread.ended_ns, start_ns) - activation.release_ns),
          .executed_ns = executed_ns,
          .others_ns = std::exchange(thread.others_ns, {})};
  thread.ready_ns = -1;
  ready_[kept.client.robot].erase(who.thread);
  thread.ended_ns = std::max(end_ns, start_ns);
  NoteWait(kept, job);
  if (!IsJudged(activation.cause)) return;
  if (!who.is_first && !thread.takes_samples && !thread.commands) return;
  if (activation.cause == ReleaseCause::kInput) {
    const Release& release = thread.releases[std::min<std::size_t>(receipt, shm::Receipts::kMost)];
    Judge(kept, job, release.period_ns, release.from);
    return;
  }
  const std::int64_t release_ns = job.release_ns;
  const std::optional<Job> before = std::exchange(thread.timed, std::move(job));
  if (!before.has_value()) return;
  thread.timer_period_ns = release_ns - before->release_ns;
  Judge(kept, *before, thread.timer_period_ns, kTimer);
}

void AnswerBook::NoteWait(Kept& kept, const Job& job) const {
  std::int64_t waited_ns = 0;
  for (const auto& [client, ns] : job.others_ns) waited_ns += ns;
  LongestWait& longest = kept.figures.longest_wait;
  if (waited_ns <= longest.waited_ns) return;
  const auto most =
      std::ranges::max_element(job.others_ns, {}, [](const auto& other) { return other.second; });
  longest = {waited_ns, job.release_ns, job.response_ns, KeptOf(most->first).client.name};
}

void AnswerBook::Count(const Job& job, ActivationTimes& times) {
  times.response.Add(job.response_ns);
  times.start_delay.Add(job.delay_ns);
  times.execution.Add(job.executed_ns);
}

void AnswerBook::Judge(Kept& kept, const Job& job, std::int64_t period_ns,
                       const std::string& source) {
  const bool has_own = kept.client.deadline_ns > 0;
  const std::int64_t deadline_ns = has_own ? kept.client.deadline_ns : period_ns;
  Count(job, kept.all);
  if (deadline_ns <= 0) return;
  Count(job, kept.judged);
  DeadlineFigures& figures = kept.figures.deadline;
  ++figures.judged;
  if (!has_own) {
    Source& of = kept.sources[source];
    ++of.judged;
    const std::int64_t period = ToThreeDigits(deadline_ns);
    if (of.periods_ns.size() < kMostPeriods || of.periods_ns.contains(period))
      ++of.periods_ns[period];
  }
  if (job.response_ns <= deadline_ns) {
    kept.in_a_row = 0;
    return;
  }
  ++figures.missed;
  figures.most_in_a_row = std::max(figures.most_in_a_row, ++kept.in_a_row);
  if (figures.first_missed_ns < 0) figures.first_missed_ns = job.release_ns;
  LateTime& late = kept.figures.late;
  late.total_ns += job.response_ns;
  late.queued_ns += job.queued_ns;
  late.executed_ns += job.executed_ns;
  for (const auto& [client, ns] : job.others_ns) late.others_ns[KeptOf(client).client.name] += ns;
}

// No expiry follows: it has the time that it had before.
void AnswerBook::JudgeLast(Thread& thread) {
  const std::optional<Job> last = std::exchange(thread.timed, std::nullopt);
  if (last.has_value()) Judge(KeptOf(thread.client), *last, thread.timer_period_ns, kTimer);
}

std::vector<ClientFigures> AnswerBook::Conclude() {
  for (auto& [number, thread] : threads_) JudgeLast(thread);
  std::vector<ClientFigures> all;
  for (const Kept& kept : clients_) {
    ClientFigures& figures = all.emplace_back(kept.figures);
    if (kept.client.deadline_ns > 0) {
      figures.deadline.deadline_ns = kept.client.deadline_ns;
    } else if (!kept.client.is_periodic && !figures.commands) {
      figures.deadline = {};  // nobody expects it to keep a period
      figures.late = {};
    } else if (!kept.sources.empty()) {
      const auto most = std::ranges::max_element(
          kept.sources, {}, [](const auto& source) { return source.second.judged; });
      figures.deadline.source = most->first;
      figures.deadline.deadline_ns =
          std::ranges::max_element(most->second.periods_ns, {}, [](const auto& period) {
            return period.second;
          })->first;
    }
    figures.times = figures.deadline.judged > 0 ? kept.judged : kept.all;
  }
  return all;
}

}  // namespace tcs
