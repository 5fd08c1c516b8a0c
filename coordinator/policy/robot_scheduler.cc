#include "coordinator/policy/robot_scheduler.h"

#include <algorithm>

#include "shm/check.h"

namespace tcs {

namespace {

// Deadlines are before half of the time that there is.
constexpr RobotScheduler::Priority kDeadlineBand = INT64_MAX, kRealTimeBand = 1'000'000,
                                   kIdleBand = -1'000'000;
constexpr std::int64_t kLatestDeadlineNs = INT64_MAX / 2;
constexpr int kMostOwners = 64;  // in a chain of who is blocked on whom; a circle ends there
constexpr VirtualDuration kQuantum = VirtualDuration::Milliseconds(1),
                          kRoundRobinQuantum = VirtualDuration::Milliseconds(100);
// How far a core may run past input that others could send to a more urgent thread on it.
constexpr VirtualDuration kGrain = VirtualDuration::Microseconds(100);

// Of processor time, in millionths.
std::int64_t Bandwidth(const DeadlineParameters& parameters) {
  if (parameters.runtime_ns == 0) return 0;
  return parameters.runtime_ns * 1'000'000 / parameters.period_ns;  // of seconds at most
}
constexpr std::int64_t kMostBandwidth = 950'000;  // per core

RobotScheduler::Priority OfDeadline(std::int64_t deadline_ns) {
  return kDeadlineBand - std::min(deadline_ns, kLatestDeadlineNs);
}

bool Allows(std::uint64_t cores, std::size_t core) { return (cores >> (core & 63) & 1) != 0; }

}  // namespace

const RobotScheduler::Entity* RobotScheduler::Find(Thread thread) const {
  const auto number = static_cast<std::size_t>(thread);
  if (thread < 0 || number >= places_.size() || places_[number] < 0) return nullptr;
  return &entities_[static_cast<std::size_t>(places_[number])];
}

const RobotScheduler::Entity& RobotScheduler::At(Thread thread) const {
  const Entity* entity = Find(thread);
  TCS_CHECK(entity != nullptr);
  return *entity;
}

std::uint64_t RobotScheduler::EveryCore() const {
  return cores_.size() >= 64 ? kEveryCore : (std::uint64_t{1} << cores_.size()) - 1;
}

void RobotScheduler::Add(Thread thread, int client_priority) {
  TCS_CHECK(thread >= 0 && Find(thread) == nullptr);
  const auto number = static_cast<std::size_t>(thread);
  if (number >= places_.size()) places_.resize(number + 1, -1);
  places_[number] = static_cast<int>(entities_.size());
  Entity& entity = entities_.emplace_back();
  entity.thread = thread;
  entity.client_priority = client_priority;
  entity.allowed = EveryCore();
  BeginTurn(entity, {});
  glances_.emplace_back().priority = client_priority;
  stale_.push_back(thread);
}

void RobotScheduler::Remove(Thread thread) {
  queue_.Remove(thread);
  const std::size_t place = PlaceOf(At(thread));
  places_[static_cast<std::size_t>(thread)] = -1;
  if (place + 1 != entities_.size()) {
    entities_[place] = entities_.back();
    glances_[place] = glances_.back();
    places_[static_cast<std::size_t>(entities_[place].thread)] = static_cast<int>(place);
  }
  entities_.pop_back();
  glances_.pop_back();
  knows_first_due_ = false;
  for (Entity& entity : entities_) {
    if (entity.blocked_on == thread) entity.blocked_on = kNobody;
  }
}

bool RobotScheduler::HasDeadline(const Entity& entity) {
  return entity.parameters.policy == SCHED_DEADLINE ||
         (entity.parameters.policy == SCHED_OTHER && entity.client_deadline > VirtualDuration());
}

RobotScheduler::Priority RobotScheduler::OwnPriority(const Entity& entity) {
  const SchedulingParameters& parameters = entity.parameters;
  if (HasDeadline(entity)) return OfDeadline(entity.server.deadline_ns());
  if (IsRealTime(parameters.policy)) return kRealTimeBand + parameters.priority;
  return entity.client_priority + (parameters.policy == SCHED_IDLE ? kIdleBand : 0);
}

RobotScheduler::Priority RobotScheduler::PriorityIfWoken(const Entity& entity,
                                                         VirtualTime now) const {
  if (!HasDeadline(entity)) return PriorityAt(entity);
  return std::max(entity.inherited, OfDeadline(entity.server.DeadlineIfWoken(now.ns())));
}

// None: the thread's turn has no end.
std::optional<VirtualDuration> RobotScheduler::QuantumOf(const Entity& entity) {
  if (entity.parameters.policy == SCHED_FIFO || HasDeadline(entity)) return std::nullopt;
  return entity.parameters.policy == SCHED_RR ? kRoundRobinQuantum : kQuantum;
}

void RobotScheduler::BeginTurn(Entity& entity, VirtualTime now) {
  entity.turn = {};
  DrawTurnLength(entity, now);
}

void RobotScheduler::DrawTurnLength(Entity& entity, VirtualTime now) const {
  const auto quantum = QuantumOf(entity);
  if (quantum.has_value()) entity.turn_length = lengths_.OfTurn(entity.thread, now, *quantum);
}

bool RobotScheduler::HasUsedTurnUp(const Entity& entity) {
  return QuantumOf(entity).has_value() && entity.turn >= entity.turn_length;
}

void RobotScheduler::StartServer(Entity& entity, VirtualTime now) {
  if (!HasDeadline(entity)) return;
  const bool is_own = entity.parameters.policy == SCHED_DEADLINE;
  entity.server.Start(is_own ? entity.parameters.deadline
                             : DeadlineParameters{.deadline_ns = entity.client_deadline.ns()},
                      now.ns());
}

void RobotScheduler::SetParameters(Thread thread, const SchedulingParameters& parameters,
                                   VirtualTime now) {
  ChargeBudgetOf(thread);
  At(thread).parameters = parameters;
  DrawTurnLength(At(thread), now);
  StartServer(At(thread), now);
}

void RobotScheduler::SetClientDeadline(Thread thread, VirtualDuration deadline, VirtualTime now) {
  At(thread).client_deadline = deadline;
  StartServer(At(thread), now);
  FindEffectivePriority(thread);
}

bool RobotScheduler::Admits(Thread thread, const DeadlineParameters& parameters) const {
  std::int64_t promised = Bandwidth(parameters);
  for (const Entity& entity : entities_) {
    if (entity.thread == thread || entity.parameters.policy != SCHED_DEADLINE) continue;
    promised += Bandwidth(entity.parameters.deadline);
  }
  return promised <= kMostBandwidth * static_cast<std::int64_t>(cores_.size());
}

bool RobotScheduler::SetCores(Thread thread, std::uint64_t allowed) {
  if ((allowed & EveryCore()) == 0) return false;
  At(thread).allowed = allowed & EveryCore();
  queue_.SetAllowed(thread, allowed & EveryCore());
  return true;
}

void RobotScheduler::Inherit(Thread child, Thread creator) {
  const Entity& from = At(creator);
  const int policy = from.parameters.policy;
  const bool starts_anew =
      policy == SCHED_DEADLINE || (from.parameters.resets_on_fork && IsRealTime(policy));
  At(child).parameters = starts_anew ? SchedulingParameters{} : from.parameters;
  At(child).parameters.resets_on_fork = false;
  DrawTurnLength(At(child), {});
  SetCores(child, from.allowed);
}

void RobotScheduler::SetBlockedOn(Thread thread, Thread owner) { At(thread).blocked_on = owner; }

bool RobotScheduler::FindEffectivePriority(Thread thread) {
  bool changed = false;
  Entity* next = Find(thread);
  for (int i = 0; next != nullptr && i < kMostOwners; ++i) {
    next->inherited = kNoPriority;
    for (const Entity& waiter : entities_) {
      if (waiter.blocked_on != next->thread) continue;
      next->inherited = std::max(next->inherited, PriorityAt(waiter));
    }
    const Priority priority = std::max(OwnPriority(*next), next->inherited);
    if (std::exchange(GlanceAt(*next).priority, priority) != priority) {
      queue_.SetPriority(next->thread, priority);
      changed = true;
    }
    next = Find(next->blocked_on);
  }
  return changed;
}

void RobotScheduler::Enqueue(Thread thread, VirtualTime from, bool goes_first) {
  const Entity& entity = At(thread);
  if (HasDeadline(entity)) {
    from = std::max(from, RobotTime(entity.server.throttled_until_ns()));
  }
  queue_.Add({thread, PriorityAt(entity), from, entity.allowed, goes_first});
  MarkStale(PlaceOf(entity));
}

void RobotScheduler::Dequeue(Thread thread) {
  queue_.Remove(thread);
  if (const Entity* entity = Find(thread); entity != nullptr) MarkStale(PlaceOf(*entity));
}

void RobotScheduler::WaitChanged(Thread thread) { MarkStale(PlaceOf(At(thread))); }

void RobotScheduler::ExpiryChanged(std::uint32_t process) {
  for (std::size_t place = 0; place < glances_.size(); ++place) {
    if (glances_[place].process == process) MarkStale(place);
  }
}

void RobotScheduler::MarkStale(std::size_t place) {
  if (!std::exchange(glances_[place].is_stale, true)) stale_.push_back(entities_[place].thread);
}

void RobotScheduler::Ask(std::size_t place) {
  Entity& entity = entities_[place];
  Glance& glance = glances_[place];
  Wait& wait = entity.wait = wait_of_(entity.thread);
  // A wait for a time that has passed already ends as it begins, and not when another core gets
  // there.
  wait.until = std::max(wait.until, wait.from);
  const VirtualTime before = glance.due;
  glance.due = wait.waits ? std::min(wait.until, wait.next_expiry) : wait.next_expiry;
  if (wait.waits && wait.is_over) glance.due = RobotTime(INT64_MIN);
  glance.process = wait.process;
  glance.waits = wait.waits;
  glance.for_others = wait.for_input || wait.for_thread;
  glance.is_stale = false;
  if (before <= first_due_ && glance.due > before) knows_first_due_ = false;
  first_due_ = std::min(first_due_, glance.due);
}

void RobotScheduler::AskForStaleWaits() {
  if (!preempts_on_wakeup_) {
    for (std::size_t place = 0; place < entities_.size(); ++place) Ask(place);
  } else {
    for (const Thread thread : stale_) {
      const Entity* entity = Find(thread);
      if (entity != nullptr && GlanceAt(*entity).is_stale) Ask(PlaceOf(*entity));
    }
  }
  stale_.clear();
}

// A core without a turn, or before its turn begins, acts when somebody's wait ends by itself. One
// core is enough for that: the least advanced, so that no end of a wait comes into sight only once
// another core has a turn.
void RobotScheduler::Assign(VirtualTime own_due) {
  AskForStaleWaits();
  queue_.Assign(progress_);
  const auto rank = [this](std::size_t core) {
    return std::pair(progress_[core], Next(core).start != kNever);
  };
  std::size_t idle = cores_.size();
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    cores_[core].next_action = Next(core).start;
    if (Next(core).start <= progress_[core]) continue;
    if (idle == cores_.size() || rank(core) < rank(idle)) idle = core;
  }
  if (idle == cores_.size()) return;
  VirtualTime due = std::min(DueAt(progress_[idle]), own_due);
  if (due != kNever) due = std::max(due, progress_[idle]);
  cores_[idle].next_action = std::min(cores_[idle].next_action, due);
}

VirtualTime RobotScheduler::FirstDue() const {
  if (!std::exchange(knows_first_due_, true)) {
    first_due_ = kNever;
    for (const Glance& glance : glances_) first_due_ = std::min(first_due_, glance.due);
  }
  return first_due_;
}

bool RobotScheduler::IsAnythingDue(VirtualTime now) const {
  return !preempts_on_wakeup_ || !stale_.empty() || FirstDue() <= now;
}

// When the next wait ends by itself, or the next timer expires, for a core that has come so far.
VirtualTime RobotScheduler::DueAt(VirtualTime progress) const {
  VirtualTime due = FirstDue();
  if (due > progress) return due;
  due = kNever;
  for (std::size_t place = 0; place < entities_.size(); ++place) {
    if (glances_[place].due >= due) continue;
    const Wait& wait = entities_[place].wait;
    if (wait.waits) {
      const bool over = wait.is_over || wait.until <= progress;
      due = std::min(due, over ? std::max(progress, wait.from) : wait.until);
    }
    due = std::min(due, wait.next_expiry);
  }
  return due;
}

void RobotScheduler::Dispatch(std::size_t core, Thread thread) {
  const Entity& entity = At(thread);
  TCS_CHECK(Allows(entity.allowed, core));
  queue_.Ran(core, thread);
  cores_[core].running = thread;
  cores_[core].priority = PriorityAt(entity);
  cores_[core].sharing = queue_.CountOf(PriorityAt(entity));
  cores_[core].charged_to = progress_[core];
}

// Charges the time that the core's thread has run since it was charged last. Where that uses up the
// thread's budget, its next deadline is its next period's, and the thread runs no earlier.
void RobotScheduler::ChargeBudget(Core& core, VirtualTime now) {
  const VirtualDuration ran = now - std::exchange(core.charged_to, now);
  Entity* entity = Find(core.running);
  if (entity == nullptr || entity->parameters.policy != SCHED_DEADLINE) return;
  entity->server.Spend(ran.ns(), now.ns());
  FindEffectivePriority(entity->thread);
}

void RobotScheduler::ChargeBudgetOf(Thread thread) {
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    if (cores_[core].running == thread) ChargeBudget(cores_[core], progress_[core]);
  }
}

void RobotScheduler::WakeUp(Thread thread, VirtualTime now, bool is_release) {
  Entity& entity = At(thread);
  BeginTurn(entity, now);
  if (!HasDeadline(entity)) return;
  ChargeBudgetOf(thread);
  const bool has_budget = entity.parameters.policy == SCHED_DEADLINE;
  if (!has_budget && !is_release && now < RobotTime(entity.server.deadline_ns())) return;
  entity.server.WakeUp(now.ns());
  FindEffectivePriority(thread);
}

// Under SCHED_DEADLINE a thread that yields has done what it had to do in this period.
void RobotScheduler::Yield(Thread thread) {
  Entity* entity = Find(thread);
  if (entity == nullptr || entity->parameters.policy != SCHED_DEADLINE) {
    return queue_.Rotate(thread);
  }
  ChargeBudgetOf(thread);
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    if (cores_[core].running == thread) entity->server.GiveUp(progress_[core].ns());
  }
  FindEffectivePriority(thread);
}

void RobotScheduler::Stop(std::size_t core, VirtualDuration advanced, VirtualDuration used) {
  Core& its = cores_[core];
  TCS_CHECK(its.running != kNobody && advanced >= VirtualDuration());
  ShareOut(its, advanced);
  ChargeBudget(its, progress_[core]);
  Entity* ran = Find(std::exchange(its.running, kNobody));
  if (ran == nullptr) return;  // the thread has ended
  ran->turn += used;
  its.turn_over = HasUsedTurnUp(*ran) ? ran->thread : kNobody;
}

void RobotScheduler::SleptSince(Thread thread, VirtualDuration ran) {
  if (Entity* entity = Find(thread); entity != nullptr) entity->turn = -ran;
}

void RobotScheduler::EndTurn(std::size_t core) {
  Entity* over = Find(cores_[core].turn_over);
  if (over == nullptr || !HasUsedTurnUp(*over) || !queue_.IsReady(over->thread)) return;
  if (!queue_.IsWantedByEqual(core, over->thread)) return;
  queue_.Rotate(over->thread);
  BeginTurn(*over, progress_[core]);
}

void RobotScheduler::ShareOut(const Core& core, VirtualDuration ran) {
  for (Glance& glance : glances_) {
    if (glance.priority == core.priority) glance.share.Earn(ran.ns(), core.sharing);
  }
  if (const Entity* who = Find(core.running); who != nullptr) GlanceAt(*who).share.Spend(ran.ns());
}

bool RobotScheduler::CanPreemptOnWakeup(const Entity& entity) const {
  return preempts_on_wakeup_ && entity.parameters.policy == SCHED_OTHER && !HasDeadline(entity);
}

bool RobotScheduler::PreemptsOnWakeup(const Entity& entity, VirtualDuration after) const {
  return CanPreemptOnWakeup(entity) &&
         GlanceAt(entity).share.GoesFirst(after.ns(), queue_.CountOf(PriorityAt(entity)));
}

bool RobotScheduler::PreemptsOnWakeup(Thread thread, VirtualDuration after) const {
  return PreemptsOnWakeup(At(thread), after);
}

// Whether the core has to stop at `due` for a thread that goes first then: of the cores that could
// make room, only the core that comes to `due` last has to.
bool RobotScheduler::MakesRoom(std::size_t core, const Entity& woken, VirtualTime due) const {
  const auto may_take = [&](std::size_t which) {
    return Allows(woken.allowed, which) && queue_.YieldsTo(which, PriorityAt(woken));
  };
  if (!may_take(core)) return false;
  for (std::size_t other = 0; other < cores_.size(); ++other) {
    if (other != core && progress_[other] <= due && may_take(other)) return false;
  }
  return true;
}

VirtualDuration RobotScheduler::LatenessOf(Thread woken, VirtualTime sent, VirtualTime earliest,
                                           bool goes_first) const {
  const Entity& entity = At(woken);
  const Priority priority = PriorityIfWoken(entity, sent);
  std::size_t best = cores_.size();
  VirtualTime start = kNever;
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    if (!Allows(entity.allowed, core)) continue;
    if (!queue_.YieldsTo(core, priority, goes_first)) continue;
    const VirtualTime its = std::max({progress_[core], sent, earliest});
    if (its < start) best = core;
    start = std::min(start, its);
  }
  if (best == cores_.size()) return {};
  // A thread that goes first only since its equals have run on had its turn to wait for.
  const VirtualDuration late = start - sent;
  const bool counts = queue_.YieldsTo(best, priority, false) || PreemptsOnWakeup(entity, -late);
  return counts ? late : VirtualDuration();
}

VirtualTime RobotScheduler::TurnEnd(std::size_t core, const Entity& running) const {
  if (!QuantumOf(running).has_value()) return kNever;
  return progress_[core] + std::max(VirtualDuration(), running.turn_length - running.turn);
}

// How far a core may run if an act of another core at `input` could interrupt it. A program acts
// some time after it is woken, so the core goes on until then: each core would stop the other
// otherwise. With set costs the core does not go on, and at one and the same instant it gives way.
VirtualTime RobotScheduler::PastInput(std::size_t core, VirtualTime input,
                                      const Outlook& outlook) const {
  const VirtualTime now = progress_[core];
  if (input == kNever) return input;
  if (!outlook.acts_at_once) return std::max(input, now) + kGrain;
  if (input > now) return input;
  return outlook.has_given_way ? now + kGrain : now;
}

// The horizon that comes from input that may have `other` run instead at once: being more urgent,
// or as an equal that goes first. Acts of other robots' programs and of the world can be input; on
// a robot of several cores also acts on the other cores.
VirtualTime RobotScheduler::HorizonForInput(std::size_t core, const Entity& running,
                                            const Entity& other, const Wait& wait,
                                            const Outlook& outlook) const {
  if (!wait.for_input && !(wait.for_thread && cores_.size() > 1)) return kNever;
  const VirtualTime first = std::min(PastInput(core, outlook.input, outlook), outlook.output);
  const Priority priority = PriorityIfWoken(other, std::max(first, progress_[core]));
  const Priority own = PriorityAt(running);
  if (priority > own) return first;
  if (priority < own || !QuantumOf(running).has_value() || !wait.for_input ||
      !CanPreemptOnWakeup(other) || !queue_.YieldsTo(core, PriorityAt(other))) {
    return kNever;
  }
  const std::int64_t until_first_ns =
      GlanceAt(other).share.NsUntilFirst(queue_.CountOf(PriorityAt(other)));
  const VirtualTime from = progress_[core] + VirtualNs(until_first_ns);
  const VirtualTime sent = std::max(from, outlook.outside_input);
  const VirtualTime at = std::min(PastInput(core, sent, outlook), std::max(from, outlook.output));
  return MakesRoom(core, other, at) ? at : kNever;
}

RobotScheduler::Horizon RobotScheduler::HorizonOf(std::size_t core, Thread thread,
                                                  VirtualTime furthest,
                                                  const Outlook& outlook) const {
  const Entity* found = Find(thread);
  if (found == nullptr)
    return {.run = furthest, .idle = {}};  // the thread has ended since it was dispatched
  const Entity& running = *found;
  const Priority own = PriorityAt(running);
  const std::uint32_t process = running.wait.process;
  const VirtualTime now = progress_[core];
  const bool takes_turns = QuantumOf(running).has_value();
  const VirtualTime turn_end = TurnEnd(core, running);
  const bool yields = queue_.YieldsTo(core, own);
  // Threads on other cores see memory as this thread has left it when they come there themselves.
  if (cores_.size() > 1 && furthest > now) {
    furthest = now + lengths_.OfStep(core, now, furthest - now);
  }
  VirtualTime limit = furthest, idle = HasDeadline(running) ? VirtualTime() : furthest;
  if (HasDeadline(running)) {
    limit = std::min(limit, AtMostNever(now, VirtualNs(running.server.budget_ns())));
  }
  const VirtualTime input = std::min(std::max(outlook.input, now), outlook.output);
  for (std::size_t place = 0; place < entities_.size(); ++place) {
    // Nothing that ends this wait comes before the limits that the running thread has already.
    const Glance& glance = glances_[place];
    const VirtualTime end = glance.for_others ? std::min(glance.due, input) : glance.due;
    if (glance.waits && end >= limit && end >= idle) continue;
    const Entity& other = entities_[place];
    const Wait& wait = other.wait;
    const auto precedes_at = [&](VirtualTime time) {
      return PriorityIfWoken(other, std::max(time, now)) > own;
    };
    // A timer that releases the other thread does so in time, also where it is not that thread's
    // turn yet.
    if (wait.process == process || HasDeadline(other) || precedes_at(wait.next_expiry)) {
      limit = std::min(limit, wait.next_expiry);
    }
    idle = std::min(idle, wait.next_expiry);
    if (&other == &running) continue;
    if (!wait.waits) {
      idle = {};
      continue;
    }
    idle = std::min(idle, wait.until);
    if (glance.priority == own && takes_turns) {
      const VirtualTime due = std::min(wait.until, wait.next_expiry);
      if (due != kNever && yields && PreemptsOnWakeup(other, due - now)) {
        const VirtualTime until = due + lengths_.SlackOf(other.thread, due);
        if (MakesRoom(core, other, due)) limit = std::min(limit, std::max(until, now));
      } else {
        limit = std::min(limit, std::max(due, turn_end));  // `other` has the next turn
      }
    }
    if (wait.for_input) {
      idle = std::min({idle, PastInput(core, outlook.input, outlook), outlook.output});
    }
    if (precedes_at(wait.until)) limit = std::min(limit, wait.until);
    limit = std::min(limit, HorizonForInput(core, running, other, wait, outlook));
  }
  limit = std::min(limit, queue_.NextToPrecede(core));
  if (queue_.HasWaitingEqual(core)) limit = std::min(limit, turn_end);
  return {.run = limit, .idle = std::min(idle, limit)};
}

VirtualTime RobotScheduler::HorizonWhileWorldStands(std::size_t core, Thread thread) const {
  const Entity* found = Find(thread);
  if (found == nullptr) return kNever;  // the thread has ended since it was dispatched
  const Entity& running = *found;
  const Priority own = PriorityAt(running);
  const std::uint32_t process = wait_of_(thread).process;
  const VirtualTime turn_end = TurnEnd(core, running);
  VirtualTime limit = queue_.HasWaitingEqual(core) ? turn_end : kNever;
  for (const Entity& other : entities_) {
    const Wait wait = wait_of_(other.thread);
    if (wait.process != process || !wait.waits || wait.own_until == kNever) continue;
    const VirtualTime due = wait.own_until;
    const Priority priority = PriorityIfWoken(other, due);
    if (priority < own) continue;
    limit = std::min(limit, priority > own ? due : std::max(due, turn_end));
  }
  return limit;
}

}  // namespace tcs
