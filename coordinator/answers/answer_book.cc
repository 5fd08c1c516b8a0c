#include "coordinator/answers/answer_book.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "coordinator/answers/by_number.h"

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

constexpr std::size_t kMostPeriods = 256, kMostUncounted = 512;
// A timer's period is the shortest one that occurs often enough: this many times its count reaches
// the count of all.
constexpr std::int64_t kOftenEnough = 4;

}  // namespace

void AnswerBook::Open(std::vector<Client> clients, std::vector<std::string> sensors) {
  for (Client& client : clients) clients_.push_back({.client = std::move(client)});
  sensors_ = std::move(sensors);
}

void AnswerBook::Tell(std::function<void(const Response&)> on_response) {
  on_response_ = std::move(on_response);
}

// The client's work before its first sample, or command, was its start.
void AnswerBook::HasBegun(int client) {
  Kept& kept = KeptOf(client);
  if (std::exchange(kept.has_begun, true)) return;
  kept.judged = kept.others = {};
  kept.new_judged.clear();
  kept.new_others.clear();
  kept.in_a_row = 0;
  kept.sources.clear();
  kept.figures.deadline = {};
  kept.figures.late = {};
  for (const auto& thread : threads_) {
    if (thread == nullptr || thread->client != client) continue;
    kept.figures.after_ns = std::max(kept.figures.after_ns, thread->ended_ns);
    thread->timed.reset();
  }
}

const AnswerBook::Thread* AnswerBook::Find(int thread) const {
  const auto number = static_cast<std::size_t>(thread);
  return number < threads_.size() ? threads_[number].get() : nullptr;
}

AnswerBook::Thread* AnswerBook::Find(int thread) {
  return const_cast<Thread*>(std::as_const(*this).Find(thread));
}

AnswerBook::Thread& AnswerBook::ThreadOf(const Who& who) {
  std::unique_ptr<Thread>& place = PlaceOf(threads_, who.thread);
  if (place == nullptr) place = std::make_unique<Thread>();
  Thread& thread = *place;
  thread.client = who.client;
  thread.is_first = who.is_first;
  return thread;
}

CoreWaits::Of AnswerBook::OnCores(const Who& who) const {
  const Client& client = KeptOf(who.client).client;
  return {who.thread, who.client, client.robot};
}

void AnswerBook::Took(const Who& who, const Taken& taken) {
  Thread& thread = ThreadOf(who);
  thread.last_sampled_ns = std::max(thread.last_sampled_ns, taken.sampled_ns);
  if (taken.period_ns > 0) {
    thread.takes_samples = true;
    HasBegun(who.client);
  }
  if (taken.activation >= Releases::kMost) return;
  Release& release = thread.releases.At(taken.activation);
  if (taken.arrived_ns >= release.at_ns) return;
  release = {taken.arrived_ns, taken.period_ns, taken.sensor};
}

void AnswerBook::Commanded(const Who& who, std::int64_t at_ns) {
  HasBegun(who.client);
  Kept& kept = KeptOf(who.client);
  kept.figures.commands = true;
  if (who.thread < 0) return;
  Thread& thread = ThreadOf(who);
  thread.commands = true;
  if (thread.last_sampled_ns >= 0) kept.figures.command_age.Add(at_ns - thread.last_sampled_ns);
}

std::int64_t AnswerBook::LastSampledOf(int thread) const {
  const Thread* found = Find(thread);
  return found == nullptr ? -1 : found->last_sampled_ns;
}

std::int64_t AnswerBook::ReleaseOf(int thread, unsigned receipt, std::int64_t at_ns) const {
  const Thread* found = Find(thread);
  if (found == nullptr || receipt >= Releases::kMost) return at_ns;
  if (receipt == 0 && !found->is_by_receipt) return at_ns;
  return std::min(at_ns, found->releases[receipt].at_ns);
}

void AnswerBook::ForgetReceipts(int thread, unsigned receipts) {
  Thread* found = Find(thread);
  if (found == nullptr || receipts == 0) return;
  const Release goes_on = found->releases[receipts];
  found->releases.Clear();
  found->releases.At(0) = goes_on;
  found->is_by_receipt = true;
}

void AnswerBook::Dies(int thread) {
  cores_.Stop(thread);
  Thread* found = Find(thread);
  if (found == nullptr) return;
  JudgeLast(*found);
  threads_[static_cast<std::size_t>(thread)].reset();
}

void AnswerBook::Idles(int thread) {
  Thread* found = Find(thread);
  if (found == nullptr) return;
  found->releases.Clear();
  found->is_by_receipt = false;
}

void AnswerBook::NeverCameTo(const Who& who, const Taken& waiting, std::int64_t end_ns) {
  Thread& thread = ThreadOf(who);
  EndPaused(thread, end_ns);
  thread.releases.At(0) = {waiting.arrived_ns, waiting.period_ns, waiting.sensor};
  Activation activation{
      .cause = ReleaseCause::kInput, .release_ns = waiting.arrived_ns, .start_ns = end_ns};
  Ended(who, activation, 0, end_ns, 0);
}

void AnswerBook::Ready(const Who& who, std::int64_t at_ns) { cores_.Ready(OnCores(who), at_ns); }

void AnswerBook::Ran(const Who& who, int core, std::int64_t start_ns, std::int64_t end_ns) {
  KeptOf(who.client).figures.core_ns[core] += end_ns - start_ns;
  cores_.Ran(OnCores(who), start_ns, end_ns);
}

void AnswerBook::AddPause(const Pause& pause, std::int64_t ns, TimeParts& parts) {
  std::int64_t& part =
      pause.what == Pause::For::kLock ? parts.locks_ns[pause.client] : parts.room_ns;
  part += std::max<std::int64_t>(0, ns);
}

// A thread that is charged less than it has run, as it was charged too much before, has computed
// all the same.
void AnswerBook::AddCores(const CoreWaits::Times& times, std::int64_t charged_ns,
                          Response& response) {
  response.charged_ns += charged_ns;
  TimeParts& parts = response.parts;
  parts.executed_ns += charged_ns;
  for (const auto& [client, ns] : CoreWaits::Shares(times.others_ns, response.RestNs()))
    parts.cores_ns[client] += ns;
  parts.executed_ns += std::clamp<std::int64_t>(times.own_ns - charged_ns,
                                                std::min<std::int64_t>(0, response.RestNs()),
                                                std::max<std::int64_t>(0, response.RestNs()));
}

// The activation until now, including the part before a pause.
Response AnswerBook::UntilNow(Thread& thread, const Who& who, const Activation& activation,
                              std::int64_t end_ns, std::int64_t executed_ns) {
  const std::int64_t ready_ns = cores_.ReadySince(who.thread);
  const CoreWaits::Times on_cores = cores_.Stop(who.thread);
  const std::int64_t start_ns = std::max(activation.start_ns, activation.release_ns);
  if (thread.begun.has_value()) {
    Response response = std::move(thread.begun->response);
    const std::int64_t on_ns = ready_ns < 0 ? start_ns : std::min(ready_ns, end_ns);
    AddPause(thread.begun->pause, on_ns - response.end_ns, response.parts);
    response.end_ns = std::max(response.end_ns, end_ns);
    AddCores(on_cores, executed_ns, response);
    return response;
  }
  // Input that was there while the thread was still at something earlier has waited for that.
  const std::int64_t free_ns =
      std::clamp(thread.ended_ns, activation.release_ns, std::max(activation.release_ns, start_ns));
  Response response{.client = who.client,
                    .thread = who.is_first ? 0 : who.thread,
                    .cause = activation.cause,
                    .release_ns = activation.release_ns,
                    .start_ns = start_ns,
                    .end_ns = std::max(end_ns, start_ns)};
  const std::int64_t before_ns =
      (ready_ns < 0 ? start_ns : std::clamp(ready_ns, free_ns, start_ns)) - free_ns;
  const std::int64_t wakeup_ns = std::min(before_ns, activation.wakeup_ns);
  response.parts = {.queued_ns = free_ns - activation.release_ns,
                    .away_ns = before_ns - wakeup_ns,
                    .wakeup_ns = wakeup_ns};
  AddCores(on_cores, executed_ns, response);
  return response;
}

void AnswerBook::Pauses(const Who& who, const Activation& activation, unsigned receipt,
                        std::int64_t at_ns, std::int64_t executed_ns, const Pause& pause) {
  Thread& thread = ThreadOf(who);
  const Release release =
      thread.begun.has_value() ? thread.begun->release : thread.releases[receipt];
  thread.begun = {UntilNow(thread, who, activation, at_ns, executed_ns), release, pause};
}

void AnswerBook::Ended(const Who& who, const Activation& activation, unsigned receipt,
                       std::int64_t end_ns, std::int64_t executed_ns) {
  Thread& thread = ThreadOf(who);
  const Release release =
      thread.begun.has_value() ? thread.begun->release : thread.releases[receipt];
  Response response = UntilNow(thread, who, activation, end_ns, executed_ns);
  thread.begun.reset();
  EndOf(thread, std::move(response), release);
}

void AnswerBook::EndOf(Thread& thread, Response response, const Release& release) {
  Kept& kept = KeptOf(thread.client);
  thread.ended_ns = response.end_ns;
  NoteWait(kept, response);
  if (!IsJudged(response.cause)) return;
  if (!thread.is_first && !thread.takes_samples && !thread.commands) return;
  if (response.cause == ReleaseCause::kInput) {
    Judge(kept, std::move(response), release.period_ns, release.sensor);
    return;
  }
  const std::int64_t release_ns = response.release_ns;
  std::optional<Response> before = std::exchange(thread.timed, std::move(response));
  if (!before.has_value()) return;
  thread.timer_period_ns = release_ns - before->release_ns;
  Judge(kept, std::move(*before), thread.timer_period_ns, kTimer);
}

void AnswerBook::NoteWait(Kept& kept, const Response& response) const {
  const ByClient& cores_ns = response.parts.cores_ns;
  const std::int64_t waited_ns = cores_ns.TotalNs();
  LongestWait& longest = kept.figures.longest_wait;
  if (waited_ns <= longest.waited_ns) return;
  const auto most = std::ranges::max_element(cores_ns, {}, &ByClient::Entry::second);
  longest = {waited_ns, response.release_ns, response.TookNs(), KeptOf(most->first).client.name};
}

void AnswerBook::Note(const Response& response, std::vector<Times>& news, ActivationTimes& times) {
  news.push_back({response.TookNs(), response.start_ns - response.release_ns, response.charged_ns});
  if (news.size() == kMostUncounted) Count(news, times);
}

void AnswerBook::Count(std::vector<Times>& news, ActivationTimes& times) {
  for (const Times& took : news) {
    times.response.Add(took.response_ns);
    times.start_delay.Add(took.start_delay_ns);
    times.execution.Add(took.execution_ns);
  }
  news.clear();
}

void AnswerBook::Add(const ByClient& part, std::map<std::string, std::int64_t>& to) const {
  for (const auto& [client, ns] : part) to[client < 0 ? "" : KeptOf(client).client.name] += ns;
}

void AnswerBook::Judge(Kept& kept, Response response, std::int64_t period_ns, int source) {
  const bool has_own = kept.client.deadline_ns > 0;
  response.deadline_ns = has_own ? kept.client.deadline_ns : std::max<std::int64_t>(0, period_ns);
  if (on_response_) on_response_(response);
  if (response.deadline_ns == 0) return Note(response, kept.new_others, kept.others);
  Note(response, kept.new_judged, kept.judged);
  DeadlineFigures& figures = kept.figures.deadline;
  ++figures.judged;
  if (!has_own) {
    Source& of = kept.sources[source];
    ++of.judged;
    const std::int64_t period = ToThreeDigits(response.deadline_ns);
    if (of.periods_ns.size() < kMostPeriods || of.periods_ns.contains(period))
      ++of.periods_ns[period];
  }
  if (response.TookNs() <= response.deadline_ns) {
    kept.in_a_row = 0;
    return;
  }
  ++figures.missed;
  figures.most_in_a_row = std::max(figures.most_in_a_row, ++kept.in_a_row);
  if (figures.first_missed_ns < 0) figures.first_missed_ns = response.release_ns;
  LateTime& late = kept.figures.late;
  const TimeParts& parts = response.parts;
  late.total_ns += response.TookNs();
  late.queued_ns += parts.queued_ns;
  late.away_ns += parts.away_ns;
  late.wakeup_ns += parts.wakeup_ns;
  late.executed_ns += parts.executed_ns;
  late.room_ns += parts.room_ns;
  Add(parts.cores_ns, late.others_ns);
  Add(parts.locks_ns, late.locks_ns);
}

// No expiry follows the last activation: it has the period of the activation before.
void AnswerBook::JudgeLast(Thread& thread) {
  std::optional<Response> last = std::exchange(thread.timed, std::nullopt);
  if (last.has_value())
    Judge(KeptOf(thread.client), std::move(*last), thread.timer_period_ns, kTimer);
}

// The thread waits in the midst of its work when the run ends.
void AnswerBook::EndPaused(Thread& thread, std::int64_t end_ns) {
  std::optional<Begun> begun = std::exchange(thread.begun, std::nullopt);
  if (!begun.has_value()) return;
  AddPause(begun->pause, end_ns - begun->response.end_ns, begun->response.parts);
  begun->response.end_ns = std::max(end_ns, begun->response.end_ns);
  EndOf(thread, std::move(begun->response), begun->release);
}

// A client that is late leaves expiries out, and finds twice the period, or more, as often as the
// period.
std::int64_t AnswerBook::PeriodOf(const Source& source) {
  for (const auto& [period_ns, count] : source.periods_ns) {
    if (kOftenEnough * count >= source.judged) return period_ns;
  }
  return std::ranges::max_element(source.periods_ns, {},
                                  [](const auto& period) { return period.second; })
      ->first;
}

std::vector<ClientFigures> AnswerBook::Conclude(std::int64_t end_ns) {
  for (const auto& thread : threads_) {
    if (thread == nullptr) continue;
    EndPaused(*thread, end_ns);
    JudgeLast(*thread);
  }
  std::vector<ClientFigures> all;
  for (Kept& kept : clients_) {
    Count(kept.new_judged, kept.judged);
    Count(kept.new_others, kept.others);
    ClientFigures& figures = all.emplace_back(kept.figures);
    if (kept.client.deadline_ns > 0) {
      figures.deadline.deadline_ns = kept.client.deadline_ns;
    } else if (!kept.client.is_periodic && !figures.commands) {
      figures.deadline = {};  // nobody expects the client to keep a period
      figures.late = {};
    } else if (!kept.sources.empty()) {
      const auto most = std::ranges::max_element(
          kept.sources, {}, [](const auto& source) { return source.second.judged; });
      figures.deadline.source =
          most->first == kTimer ? "its timer" : sensors_[static_cast<std::size_t>(most->first)];
      figures.deadline.deadline_ns = PeriodOf(most->second);
    }
    figures.times = kept.judged;
    if (figures.deadline.judged == 0) figures.times.Add(kept.others);
  }
  return all;
}

}  // namespace tcs
