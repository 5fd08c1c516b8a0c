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
constexpr std::int64_t kQuantumNs = 1'000'000, kRoundRobinQuantumNs = 100'000'000;
// How far a core may run past what others could send to a more urgent thread on it.
constexpr std::int64_t kGrainNs = 100'000;

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
         (entity.parameters.policy == SCHED_OTHER && entity.client_deadline_ns > 0);
}

RobotScheduler::Priority RobotScheduler::OwnPriority(const Entity& entity) {
  const SchedulingParameters& parameters = entity.parameters;
  if (HasDeadline(entity)) return OfDeadline(entity.server.deadline_ns());
  if (IsRealTime(parameters.policy)) return kRealTimeBand + parameters.priority;
  return entity.client_priority + (parameters.policy == SCHED_IDLE ? kIdleBand : 0);
}

RobotScheduler::Priority RobotScheduler::PriorityIfWoken(const Entity& entity,
                                                         std::int64_t now_ns) const {
  if (!HasDeadline(entity)) return PriorityAt(entity);
  return std::max(entity.inherited, OfDeadline(entity.server.DeadlineIfWoken(now_ns)));
}

std::int64_t RobotScheduler::QuantumOf(const Entity& entity) {
  if (entity.parameters.policy == SCHED_FIFO || HasDeadline(entity)) return kNever;
  return entity.parameters.policy == SCHED_RR ? kRoundRobinQuantumNs : kQuantumNs;
}

void RobotScheduler::StartServer(Entity& entity, std::int64_t now_ns) {
  if (!HasDeadline(entity)) return;
  const bool is_own = entity.parameters.policy == SCHED_DEADLINE;
  entity.server.Start(is_own ? entity.parameters.deadline
                             : DeadlineParameters{.deadline_ns = entity.client_deadline_ns},
                      now_ns);
}

void RobotScheduler::SetParameters(Thread thread, const SchedulingParameters& parameters,
                                   std::int64_t now_ns) {
  ChargeBudgetOf(thread);
  At(thread).parameters = parameters;
  StartServer(At(thread), now_ns);
}

void RobotScheduler::SetClientDeadline(Thread thread, std::int64_t deadline_ns,
                                       std::int64_t now_ns) {
  At(thread).client_deadline_ns = deadline_ns;
  StartServer(At(thread), now_ns);
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

void RobotScheduler::Enqueue(Thread thread, std::int64_t from_ns, bool goes_first) {
  const Entity& entity = At(thread);
  if (HasDeadline(entity)) from_ns = std::max(from_ns, entity.server.throttled_until_ns());
  queue_.Add({thread, PriorityAt(entity), from_ns, entity.allowed, goes_first});
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
  const Wait& wait = entity.wait = wait_of_(entity.thread);
  const std::int64_t before_ns = glance.due_ns;
  glance.due_ns = wait.waits ? std::min(wait.until_ns, wait.next_expiry_ns) : wait.next_expiry_ns;
  if (wait.waits && wait.is_over) glance.due_ns = INT64_MIN;
  glance.process = wait.process;
  glance.waits = wait.waits;
  glance.for_others = wait.for_input || wait.for_thread;
  glance.is_stale = false;
  if (before_ns <= first_due_ns_ && glance.due_ns > before_ns) knows_first_due_ = false;
  first_due_ns_ = std::min(first_due_ns_, glance.due_ns);
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
void RobotScheduler::Assign(std::int64_t own_due_ns) {
  AskForStaleWaits();
  queue_.Assign(progress_);
  const auto rank = [this](std::size_t core) {
    return std::pair(progress_[core], Next(core).start_ns != kNever);
  };
  std::size_t idle = cores_.size();
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    cores_[core].next_action_ns = Next(core).start_ns;
    if (Next(core).start_ns <= progress_[core]) continue;
    if (idle == cores_.size() || rank(core) < rank(idle)) idle = core;
  }
  if (idle == cores_.size()) return;
  std::int64_t due = std::min(DueAt(progress_[idle]), own_due_ns);
  if (due != kNever) due = std::max(due, progress_[idle]);
  cores_[idle].next_action_ns = std::min(cores_[idle].next_action_ns, due);
}

std::int64_t RobotScheduler::FirstDue() const {
  if (!std::exchange(knows_first_due_, true)) {
    first_due_ns_ = kNever;
    for (const Glance& glance : glances_) first_due_ns_ = std::min(first_due_ns_, glance.due_ns);
  }
  return first_due_ns_;
}

bool RobotScheduler::IsAnythingDue(std::int64_t now_ns) const {
  return !preempts_on_wakeup_ || !stale_.empty() || FirstDue() <= now_ns;
}

// When the next wait ends by itself, or the next timer expires, for a core that has come so far.
std::int64_t RobotScheduler::DueAt(std::int64_t progress_ns) const {
  std::int64_t due = FirstDue();
  if (due > progress_ns) return due;
  due = kNever;
  for (std::size_t place = 0; place < entities_.size(); ++place) {
    if (glances_[place].due_ns >= due) continue;
    const Wait& wait = entities_[place].wait;
    if (wait.waits) {
      const bool over = wait.is_over || wait.until_ns <= progress_ns;
      due = std::min(due, over ? std::max(progress_ns, wait.from_ns) : wait.until_ns);
    }
    due = std::min(due, wait.next_expiry_ns);
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
  cores_[core].charged_to_ns = progress_[core];
}

// What the core's thread has run since it was charged last. Where that is all that it has, its next
// deadline is its next period's, and it runs no earlier.
void RobotScheduler::ChargeBudget(Core& core, std::int64_t now_ns) {
  const std::int64_t ran_ns = now_ns - std::exchange(core.charged_to_ns, now_ns);
  Entity* entity = Find(core.running);
  if (entity == nullptr || entity->parameters.policy != SCHED_DEADLINE) return;
  entity->server.Spend(ran_ns, now_ns);
  FindEffectivePriority(entity->thread);
}

void RobotScheduler::ChargeBudgetOf(Thread thread) {
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    if (cores_[core].running == thread) ChargeBudget(cores_[core], progress_[core]);
  }
}

void RobotScheduler::WakeUp(Thread thread, std::int64_t now_ns, bool is_release) {
  Entity& entity = At(thread);
  entity.turn_ns = 0;
  if (!HasDeadline(entity)) return;
  ChargeBudgetOf(thread);
  const bool has_budget = entity.parameters.policy == SCHED_DEADLINE;
  if (!has_budget && !is_release && now_ns < entity.server.deadline_ns()) return;
  entity.server.WakeUp(now_ns);
  FindEffectivePriority(thread);
}

// Under SCHED_DEADLINE it has done what it had to do in this period.
void RobotScheduler::Yield(Thread thread) {
  Entity* entity = Find(thread);
  if (entity == nullptr || entity->parameters.policy != SCHED_DEADLINE) {
    return queue_.Rotate(thread);
  }
  ChargeBudgetOf(thread);
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    if (cores_[core].running == thread) entity->server.GiveUp(progress_[core]);
  }
  FindEffectivePriority(thread);
}

void RobotScheduler::Stop(std::size_t core, std::int64_t advanced_ns, std::int64_t used_ns) {
  Core& its = cores_[core];
  TCS_CHECK(its.running != kNobody && advanced_ns >= 0);
  ShareOut(its, advanced_ns);
  ChargeBudget(its, progress_[core]);
  Entity* ran = Find(std::exchange(its.running, kNobody));
  if (ran == nullptr) return;  // it has ended
  ran->turn_ns += used_ns;
  if (ran->turn_ns < QuantumOf(*ran)) return;
  ran->turn_ns = 0;
  if (queue_.IsReady(ran->thread)) its.turn_over = ran->thread;
}

void RobotScheduler::SleptSince(Thread thread, std::int64_t ran_ns) {
  if (Entity* entity = Find(thread); entity != nullptr) entity->turn_ns = -ran_ns;
}

void RobotScheduler::EndTurn(std::size_t core) {
  queue_.Rotate(std::exchange(cores_[core].turn_over, kNobody));
}

void RobotScheduler::ShareOut(const Core& core, std::int64_t ns) {
  for (Glance& glance : glances_) {
    if (glance.priority == core.priority) glance.share.Earn(ns, core.sharing);
  }
  if (const Entity* ran = Find(core.running); ran != nullptr) GlanceAt(*ran).share.Spend(ns);
}

bool RobotScheduler::CanPreemptOnWakeup(const Entity& entity) const {
  return preempts_on_wakeup_ && entity.parameters.policy == SCHED_OTHER && !HasDeadline(entity);
}

bool RobotScheduler::PreemptsOnWakeup(const Entity& entity, std::int64_t after_ns) const {
  return CanPreemptOnWakeup(entity) &&
         GlanceAt(entity).share.GoesFirst(after_ns, queue_.CountOf(PriorityAt(entity)));
}

bool RobotScheduler::PreemptsOnWakeup(Thread thread, std::int64_t after_ns) const {
  return PreemptsOnWakeup(At(thread), after_ns);
}

// Whether the core has to stop at `due_ns` for a thread that goes first then: of the cores that
// would, the one that comes there last. The others need not.
bool RobotScheduler::MakesRoom(std::size_t core, const Entity& woken, std::int64_t due_ns) const {
  const auto may_take = [&](std::size_t which) {
    return Allows(woken.allowed, which) && queue_.YieldsTo(which, PriorityAt(woken));
  };
  if (!may_take(core)) return false;
  for (std::size_t other = 0; other < cores_.size(); ++other) {
    if (other != core && progress_[other] <= due_ns && may_take(other)) return false;
  }
  return true;
}

std::int64_t RobotScheduler::LatenessOf(Thread woken, std::int64_t sent_ns,
                                        std::int64_t earliest_ns, bool goes_first) const {
  const Entity& entity = At(woken);
  const Priority priority = PriorityIfWoken(entity, sent_ns);
  std::size_t best = cores_.size();
  std::int64_t start = kNever;
  for (std::size_t core = 0; core < cores_.size(); ++core) {
    if (!Allows(entity.allowed, core)) continue;
    if (!queue_.YieldsTo(core, priority, goes_first)) continue;
    const std::int64_t its = std::max({progress_[core], sent_ns, earliest_ns});
    if (its < start) best = core;
    start = std::min(start, its);
  }
  if (best == cores_.size()) return 0;
  // One that goes first only since its equals have run on had its turn to wait for.
  const std::int64_t late_ns = start - sent_ns;
  const bool counts = queue_.YieldsTo(best, priority, false) || PreemptsOnWakeup(entity, -late_ns);
  return counts ? late_ns : 0;
}

std::int64_t RobotScheduler::TurnEnd(std::size_t core, const Entity& running) const {
  const std::int64_t quantum = QuantumOf(running);
  return quantum == kNever ? kNever : progress_[core] + quantum - running.turn_ns;
}

// How far a core may run if what others do at `input_ns` could interrupt it. A program acts some
// time after it is woken, so the core goes on until then: each would stop the other otherwise. With
// set costs it does not, and at one and the same instant it gives way.
std::int64_t RobotScheduler::PastInput(std::size_t core, std::int64_t input_ns,
                                       const Outlook& outlook) const {
  const std::int64_t now = progress_[core];
  if (input_ns == kNever) return input_ns;
  if (!outlook.acts_at_once) return std::max(input_ns, now) + kGrainNs;
  if (input_ns > now) return input_ns;
  return outlook.has_given_way ? now + kGrainNs : now;
}

// Because input may have `other` run instead at once: being more urgent, or as an equal that goes
// first. What programs of other robots and the world do can be input; on a robot of several cores
// also what happens on the others.
std::int64_t RobotScheduler::HorizonForInput(std::size_t core, const Entity& running,
                                             const Entity& other, const Wait& wait,
                                             const Outlook& outlook) const {
  if (!wait.for_input && !(wait.for_thread && cores_.size() > 1)) return kNever;
  const std::int64_t first =
      std::min(PastInput(core, outlook.input_ns, outlook), outlook.output_ns);
  const Priority priority = PriorityIfWoken(other, std::max(first, progress_[core]));
  const Priority own = PriorityAt(running);
  if (priority > own) return first;
  if (priority < own || QuantumOf(running) == kNever || !wait.for_input ||
      !CanPreemptOnWakeup(other) || !queue_.YieldsTo(core, PriorityAt(other))) {
    return kNever;
  }
  const std::int64_t from =
      progress_[core] + GlanceAt(other).share.NsUntilFirst(queue_.CountOf(PriorityAt(other)));
  const std::int64_t sent = std::max(from, outlook.outside_input_ns);
  const std::int64_t at =
      std::min(PastInput(core, sent, outlook), std::max(from, outlook.output_ns));
  return MakesRoom(core, other, at) ? at : kNever;
}

RobotScheduler::Horizon RobotScheduler::HorizonOf(std::size_t core, Thread thread,
                                                  std::int64_t limit_ns,
                                                  const Outlook& outlook) const {
  const Entity* found = Find(thread);
  if (found == nullptr) return {.run_ns = limit_ns};  // it has ended since it was dispatched
  const Entity& running = *found;
  const Priority own = PriorityAt(running);
  const std::uint32_t process = running.wait.process;
  const std::int64_t now = progress_[core];
  const bool takes_turns = QuantumOf(running) != kNever;
  const std::int64_t turn_end = TurnEnd(core, running);
  const bool yields = queue_.YieldsTo(core, own);
  std::int64_t limit = limit_ns, idle = HasDeadline(running) ? 0 : limit_ns;
  if (HasDeadline(running) && running.server.budget_ns() != kNever) {
    limit = std::min(limit, now + running.server.budget_ns());
  }
  const std::int64_t input = std::min(std::max(outlook.input_ns, now), outlook.output_ns);
  for (std::size_t place = 0; place < entities_.size(); ++place) {
    // Nothing that ends its wait comes before what limits the thread already.
    const Glance& glance = glances_[place];
    const std::int64_t end = glance.for_others ? std::min(glance.due_ns, input) : glance.due_ns;
    if (glance.waits && end >= limit && end >= idle) continue;
    const Entity& other = entities_[place];
    const Wait& wait = other.wait;
    const auto precedes_at = [&](std::int64_t ns) {
      return PriorityIfWoken(other, std::max(ns, now)) > own;
    };
    // A timer that releases it does so in time, also where it is not its turn yet.
    if (wait.process == process || HasDeadline(other) || precedes_at(wait.next_expiry_ns)) {
      limit = std::min(limit, wait.next_expiry_ns);
    }
    idle = std::min(idle, wait.next_expiry_ns);
    if (&other == &running) continue;
    if (!wait.waits) {
      idle = 0;
      continue;
    }
    idle = std::min(idle, wait.until_ns);
    if (glance.priority == own && takes_turns) {
      const std::int64_t due = std::min(wait.until_ns, wait.next_expiry_ns);
      if (due != kNever && yields && PreemptsOnWakeup(other, due - now)) {
        if (MakesRoom(core, other, due)) limit = std::min(limit, std::max(due, now));
      } else {
        limit = std::min(limit, std::max(due, turn_end));  // it has the next turn
      }
    }
    if (wait.for_input) {
      idle = std::min({idle, PastInput(core, outlook.input_ns, outlook), outlook.output_ns});
    }
    if (precedes_at(wait.until_ns)) limit = std::min(limit, wait.until_ns);
    limit = std::min(limit, HorizonForInput(core, running, other, wait, outlook));
  }
  limit = std::min(limit, queue_.NextToPrecede(core));
  if (queue_.HasWaitingEqual(core)) limit = std::min(limit, turn_end);
  return {.run_ns = limit, .idle_ns = std::min(idle, limit)};
}

std::int64_t RobotScheduler::HorizonWhileWorldStands(std::size_t core, Thread thread) const {
  const Entity* found = Find(thread);
  if (found == nullptr) return kNever;  // it has ended since it was dispatched
  const Entity& running = *found;
  const Priority own = PriorityAt(running);
  const std::uint32_t process = wait_of_(thread).process;
  const std::int64_t turn_end = TurnEnd(core, running);
  std::int64_t limit = queue_.HasWaitingEqual(core) ? turn_end : kNever;
  for (const Entity& other : entities_) {
    const Wait wait = wait_of_(other.thread);
    if (wait.process != process || !wait.waits || wait.own_until_ns == kNever) continue;
    const std::int64_t due = wait.own_until_ns;
    const Priority priority = PriorityIfWoken(other, due);
    if (priority < own) continue;
    limit = std::min(limit, priority > own ? due : std::max(due, turn_end));
  }
  return limit;
}

}  // namespace tcs
