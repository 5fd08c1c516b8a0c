#include "coordinator/explain/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "coordinator/text/spoken.h"

namespace tcs::explain {

namespace {

enum class Kind { kQueued, kAway, kWakeup, kCore, kLock, kRoom, kExecuted, kRest };

struct Cause {
  Kind kind = Kind::kRest;
  std::int64_t ns = 0;
  std::string who{};  // with its rank
};

std::string_view RankOf(const std::string& other, const std::string& client,
                        const std::map<std::string, Client>& clients) {
  const auto a = clients.find(other), b = clients.find(client);
  if (other == client || a == clients.end() || b == clients.end()) return "";
  if (!a->second.priority || !b->second.priority) return "";
  if (a->second.priority == b->second.priority) return ", of the same priority,";
  return a->second.priority > b->second.priority ? ", of higher priority," : ", of lower priority,";
}

std::vector<Cause> CausesOf(const Activation& activation,
                            const std::map<std::string, Client>& clients) {
  const auto name = [&](const std::string& client) {
    if (client == activation.client) return std::string("another thread of its own");
    return client.empty() ? "somebody unknown"
                          : client + std::string(RankOf(client, activation.client, clients));
  };
  std::vector<Cause> causes = {{Kind::kQueued, activation.queued_ns},
                               {Kind::kAway, activation.away_ns},
                               {Kind::kWakeup, activation.wakeup_ns}};
  for (const Share& share : activation.cores)
    causes.push_back({Kind::kCore, share.ns, name(share.client)});
  for (const Share& share : activation.locks)
    causes.push_back({Kind::kLock, share.ns, name(share.client)});
  causes.insert(causes.end(), {{Kind::kRoom, activation.room_ns},
                               {Kind::kExecuted, activation.executed_ns},
                               {Kind::kRest, activation.rest_ns}});
  std::erase_if(causes, [](const Cause& cause) { return cause.ns == 0; });
  return causes;
}

std::string PartText(const Cause& cause) {
  switch (cause.kind) {
    case Kind::kQueued:
      return "in the queue: its thread was still at what had come earlier";
    case Kind::kAway:
      return "not looked at: its thread slept, or waited for something else";
    case Kind::kWakeup:
      return "waking its thread (cpu.wakeup)";
    case Kind::kCore:
      return cause.who + " had the core";
    case Kind::kLock:
      return "waiting for a lock that " + cause.who + " had";
    case Kind::kRoom:
      return "waiting until others had taken what it sent";
    case Kind::kExecuted:
      return "computing";
    case Kind::kRest:
      return "in none of these, such as changing from thread to thread";
  }
  return "";
}

std::string Because(const Cause& cause, const Activation& activation) {
  const std::string time = Spoken(cause.ns);
  switch (cause.kind) {
    case Kind::kQueued:
      return fmt::format(
          "for {} of it its thread was still at what had come earlier; itself it {}", time,
          activation.executed_ns > 0 ? "computes for " + Spoken(activation.executed_ns)
                                     : "has not begun");
    case Kind::kAway:
      return fmt::format("for {} of it its thread slept, or waited for something else", time);
    case Kind::kWakeup:
      return fmt::format("waking its thread took {} of it (cpu.wakeup)", time);
    case Kind::kCore:
      return fmt::format("{} had the core for {} of it", cause.who, time);
    case Kind::kLock:
      return fmt::format("it waited for a lock that {} had for {} of it", cause.who, time);
    case Kind::kRoom:
      return fmt::format("it waited for {} until others had taken what it sent", time);
    case Kind::kExecuted:
      return fmt::format("it computed for {} of it", time);
    case Kind::kRest:
      return fmt::format("{} of it are in nothing that is known", time);
  }
  return "";
}

}  // namespace

std::vector<Part> PartsOf(const Activation& activation,
                          const std::map<std::string, Client>& clients) {
  std::vector<Part> parts;
  for (const Cause& cause : CausesOf(activation, clients))
    parts.push_back({cause.ns, PartText(cause)});
  return parts;
}

std::string SentenceOn(const Activation& activation, const std::map<std::string, Client>& clients) {
  std::vector<Cause> causes = CausesOf(activation, clients);
  // The activation's own work alone would have been done in time.
  if (activation.LateNs() > 0 && activation.executed_ns <= activation.deadline_ns &&
      causes.size() > 1)
    std::erase_if(causes, [](const Cause& cause) { return cause.kind == Kind::kExecuted; });
  const auto most = std::ranges::max_element(causes, {}, &Cause::ns);
  const std::string why = most == causes.end() ? "" : ": " + Because(*most, activation);
  const std::string thread =
      activation.thread > 0 ? fmt::format(" #{}", activation.thread) : std::string();
  const std::string begin =
      fmt::format("at {:.3f} s {}{}", static_cast<double>(activation.release_ns) / 1e9,
                  activation.client, thread);
  if (activation.LateNs() > 0) {
    return fmt::format("{} answered {} late, after {}{}", begin, Spoken(activation.LateNs()),
                       Spoken(activation.TookNs()), why);
  }
  return fmt::format("{} took {}{}{}", begin, Spoken(activation.TookNs()),
                     activation.deadline_ns > 0
                         ? fmt::format(" of the {} that it had", Spoken(activation.deadline_ns))
                         : "",
                     why);
}

namespace {

std::string TextOf(const Hop& hop) {
  if (hop.of == "sensor") return "on the way from " + hop.name + ", its latency included";
  if (hop.of == "waiting") return "waiting until " + hop.name + " took it";
  if (hop.of == "program") return "in " + hop.name + ", until it first sent something then";
  if (hop.of == "held") return hop.name + " knew of nothing newer, and sent something again";
  if (hop.of == "way") return "on the way from " + hop.name + " to the next program";
  return "until " + hop.name + " acted, for its latency";
}

}  // namespace

std::vector<Part> PartsOf(const ChainCase& one) {
  std::vector<Part> parts;
  for (const Hop& hop : one.hops) {
    if (hop.ns != 0) parts.push_back({hop.ns, TextOf(hop)});
  }
  return parts;
}

std::string SentenceOn(const std::string& name, const Chain& chain, const ChainCase& one) {
  const std::vector<Part> parts = PartsOf(one);
  const auto most = std::ranges::max_element(parts, {}, &Part::ns);
  return fmt::format(
      "{}: what acted at {:.3f} s knew of a sample that was {} old{}{}", name,
      static_cast<double>(one.acts_ns) / 1e9, Spoken(one.acts_ns - one.sampled_ns),
      chain.deadline_ns > 0 ? fmt::format(", where {} are allowed", Spoken(chain.deadline_ns)) : "",
      most == parts.end() ? "" : fmt::format("; {} of that {}", Spoken(most->ns), most->what));
}

const Activation* QueuedBehind(const Told& told, const Activation& activation) {
  if (2 * activation.queued_ns <= activation.TookNs()) return nullptr;
  const Activation* behind = &activation;
  for (const Activation* one = behind; one-- != told.activations.data();) {
    if (one->client != behind->client || one->thread != behind->thread) continue;
    if (one->end_ns < behind->release_ns) break;
    behind = one;
    if (behind->queued_ns == 0) break;
  }
  return behind == &activation ? nullptr : behind;
}

namespace {

// For each activation the first one of the queue that it was in; itself, if it was in none.
std::map<const Activation*, const Activation*> FirstsOfQueues(const Told& told) {
  std::map<std::pair<std::string_view, std::int64_t>, const Activation*> before;
  std::map<const Activation*, const Activation*> firsts;
  for (const Activation& one : told.activations) {
    const Activation*& last = before[{one.client, one.thread}];
    const bool is_queued = one.queued_ns > 0 && last != nullptr && last->end_ns >= one.release_ns;
    firsts[&one] = is_queued ? firsts[last] : &one;
    last = &one;
  }
  return firsts;
}

// An activation that waited behind another one that is named tells nothing new, and comes last.
void PutOneOfEachQueueFirst(const Told& told, std::vector<const Activation*>* chosen) {
  auto firsts = FirstsOfQueues(told);
  std::set<const Activation*> named;
  std::ranges::stable_partition(
      *chosen, [&](const Activation* one) { return named.insert(firsts[one]).second; });
}

}  // namespace

std::vector<const Activation*> Choose(const Told& told, const Choice& choice) {
  std::vector<const Activation*> chosen;
  for (const Activation& activation : told.activations) {
    if (!choice.client.empty() && activation.client != choice.client) continue;
    if (choice.at_ns.has_value() &&
        (*choice.at_ns < activation.release_ns || *choice.at_ns > activation.end_ns)) {
      continue;
    }
    chosen.push_back(&activation);
  }
  if (choice.at_ns.has_value()) {
    std::ranges::stable_sort(chosen, {}, &Activation::release_ns);
  } else {
    std::ranges::stable_sort(chosen, std::greater<>{}, [](const Activation* one) {
      return std::pair(std::max<std::int64_t>(0, one->LateNs()), one->TookNs());
    });
    PutOneOfEachQueueFirst(told, &chosen);
  }
  if (chosen.size() > choice.most) chosen.resize(choice.most);
  return chosen;
}

}  // namespace tcs::explain
