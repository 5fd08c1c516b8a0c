#include "coordinator/answers/chain_book.h"

#include <algorithm>
#include <memory>

#include "coordinator/answers/by_number.h"

namespace tcs {

namespace {

std::vector<const LineageStep*> StepsOf(const KnownSample& sample) {
  std::vector<const LineageStep*> steps;
  for (const LineageStep* step = sample.last.get(); step != nullptr; step = step->before.get())
    steps.push_back(step);
  std::ranges::reverse(steps);
  return steps;
}

}  // namespace

void ChainBook::Open(std::vector<std::string> clients, std::vector<Sensor> sensors,
                     std::vector<Command> commands, std::vector<Chain> chains) {
  clients_ = std::move(clients);
  sensors_ = std::move(sensors);
  commands_ = std::move(commands);
  chains_ = std::move(chains);
  for (const Chain& chain : chains_) {
    Kept& kept = named_.emplace_back();
    kept.figures.name = chain.name;
    kept.figures.deadline_ns = chain.deadline_ns;
    kept.figures.is_named = true;
  }
}

Lineage ChainBook::Sampled(int sensor, std::int64_t sampled_ns) const {
  auto knowledge = std::make_shared<Knowledge>();
  knowledge->push_back({{.sensor = sensor}, {.sampled_ns = sampled_ns}});
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    if (chains_[i].sensor != sensor || chains_[i].through.empty()) continue;
    knowledge->push_back({{sensor, static_cast<int>(i), 0}, {.sampled_ns = sampled_ns}});
  }
  return knowledge;
}

ChainBook::Had& ChainBook::HadOf(Knows& knows, const LineageOf& of) {
  const auto place = std::ranges::lower_bound(knows, of, {}, &Knows::value_type::first);
  if (place != knows.end() && place->first == of) return place->second;
  return knows.insert(place, {of, {}})->second;
}

void ChainBook::Dies(int thread) {
  if (static_cast<std::size_t>(thread) < threads_.size()) PlaceOf(threads_, thread).clear();
}

ChainBook::Knows& ChainBook::UsedBy(const Who& who, std::int64_t at_ns) {
  const bool has_taken = static_cast<std::size_t>(who.thread) < threads_.size() &&
                         !PlaceOf(threads_, who.thread).empty();
  Knows& knows = has_taken ? PlaceOf(threads_, who.thread) : PlaceOf(of_clients_, who.client);
  for (auto& [of, had] : knows) {
    if (had.first_ns < 0) had.first_ns = at_ns;
  }
  return knows;
}

Lineage ChainBook::Sends(const Who& who, std::int64_t at_ns) {
  const Knows& knows = UsedBy(who, at_ns);
  if (knows.empty()) return nullptr;
  auto knowledge = std::make_shared<Knowledge>();
  knowledge->reserve(knows.size());
  for (const auto& [of, had] : knows) {
    if (had.sample.steps == kMostSteps) continue;
    knowledge->push_back(
        {of,
         {had.sample.sampled_ns,
          std::make_shared<LineageStep>(LineageStep{who.client, had.arrived_ns, had.took_ns,
                                                    had.first_ns, at_ns, had.sample.last}),
          had.sample.steps + 1}});
  }
  return knowledge;
}

void ChainBook::Took(const Who& who, const Lineage& lineage, std::int64_t arrived_ns,
                     std::int64_t at_ns) {
  if (lineage == nullptr) return;
  Knows& thread = PlaceOf(threads_, who.thread);
  Knows& client = PlaceOf(of_clients_, who.client);
  for (const auto& [of, sample] : *lineage) {
    LineageOf reached = of;
    if (of.chain >= 0) {
      const std::vector<int>& through = chains_[static_cast<std::size_t>(of.chain)].through;
      const auto stage = static_cast<std::size_t>(of.stage);
      if (stage < through.size() && through[stage] == who.client) ++reached.stage;
    }
    for (Knows* knows : {&thread, &client}) {
      Had& had = HadOf(*knows, reached);
      if (had.took_ns > 0 && had.sample.sampled_ns >= sample.sampled_ns) continue;
      had = {sample, arrived_ns, at_ns};
    }
  }
}

const std::string& ChainBook::NameOf(int client) const {
  return clients_[static_cast<std::size_t>(client)];
}

// From where the sensor measured to where the actuator acts, without a gap.
ChainCase ChainBook::CaseOf(const LineageOf& of, const Had& had, int client, int command,
                            std::int64_t at_ns) const {
  using Of = ChainHop::Of;
  const Command& to = commands_[static_cast<std::size_t>(command)];
  ChainCase found{.sampled_ns = had.sample.sampled_ns, .acts_ns = at_ns + to.latency_ns};
  std::int64_t until_ns = found.sampled_ns;
  const auto add = [&](Of what, const std::string& name, std::int64_t next_ns) {
    found.hops.push_back({what, name, next_ns - until_ns});
    until_ns = next_ns;
  };
  Of way = Of::kSensor;
  std::string from = sensors_[static_cast<std::size_t>(of.sensor)].name;
  const auto pass = [&](int through, std::int64_t arrived_ns, std::int64_t took_ns,
                        std::int64_t first_ns, std::int64_t sent_ns) {
    add(way, from, arrived_ns);
    from = NameOf(through);
    add(Of::kWaiting, from, took_ns);
    add(Of::kProgram, from, first_ns);
    add(Of::kHeld, from, sent_ns);
    way = Of::kWay;
  };
  for (const LineageStep* step : StepsOf(had.sample))
    pass(step->client, step->arrived_ns, step->took_ns, step->first_ns, step->sent_ns);
  pass(client, had.arrived_ns, had.took_ns, had.first_ns, at_ns);
  add(Of::kActuator, to.name, found.acts_ns);
  return found;
}

void ChainBook::Count(const LineageOf& of, const Had& had, int client, int command,
                      std::int64_t at_ns) {
  const Sensor& sensor = sensors_[static_cast<std::size_t>(of.sensor)];
  const Command& to = commands_[static_cast<std::size_t>(command)];
  const std::int64_t acts_ns = at_ns + to.latency_ns, age_ns = acts_ns - had.sample.sampled_ns;
  path_ = {client};
  for (const LineageStep* step = had.sample.last.get(); step != nullptr; step = step->before.get())
    path_.push_back(step->client);
  std::ranges::reverse(path_);
  const auto count = [&](Kept& kept) {
    ChainFigures& figures = kept.figures;
    figures.age.Add(age_ns);
    // Most commands come on the same path as the command before.
    if (kept.newest == nullptr || kept.newest->first != path_)
      kept.newest = &*kept.paths.try_emplace(path_).first;
    ++kept.newest->second;
    // Samples that no command before could know of.
    const std::int64_t last_ns =
        std::exchange(kept.last_sampled_ns, std::max(kept.last_sampled_ns, had.sample.sampled_ns));
    if (last_ns < 0) {
      figures.reaction.Add(age_ns);
    } else if (sensor.period_ns > 0) {
      for (std::int64_t sampled = had.sample.sampled_ns; sampled > last_ns;
           sampled -= sensor.period_ns)
        figures.reaction.Add(acts_ns - sampled);
    }
    if (figures.deadline_ns > 0 && age_ns > figures.deadline_ns) {
      ++figures.missed;
      if (figures.first_missed_ns < 0) figures.first_missed_ns = acts_ns;
    }
    std::vector<ChainCase>& worst = figures.worst;
    if (worst.size() == kMostWorst && worst.back().AgeNs() >= age_ns) return;
    const auto place = std::ranges::find_if(
        worst, [age_ns](const ChainCase& one) { return one.AgeNs() < age_ns; });
    worst.insert(place, CaseOf(of, had, client, command, at_ns));
    if (worst.size() > kMostWorst) worst.pop_back();
  };
  if (of.chain < 0) {
    Kept& kept = kept_[{of.sensor, command}];
    if (kept.figures.name.empty()) kept.figures.name = sensor.name + "->" + to.name;
    count(kept);
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      if (chains_[i].through.empty() && chains_[i].sensor == of.sensor &&
          chains_[i].command == command)
        count(named_[i]);
    }
    return;
  }
  const auto index = static_cast<std::size_t>(of.chain);
  const Chain& chain = chains_[index];
  if (chain.command == command && static_cast<std::size_t>(of.stage) == chain.through.size())
    count(named_[index]);
}

void ChainBook::Commanded(const Who& who, int command, std::int64_t at_ns) {
  for (const auto& [of, had] : UsedBy(who, at_ns)) Count(of, had, who.client, command, at_ns);
}

std::vector<ChainFigures> ChainBook::Conclude() const {
  std::vector<ChainFigures> all;
  const auto add = [&](const Kept& kept) {
    ChainFigures& figures = all.emplace_back(kept.figures);
    const auto most =
        std::ranges::max_element(kept.paths, {}, [](const auto& path) { return path.second; });
    if (most == kept.paths.end()) return;
    for (const int client : most->first) figures.path.push_back(NameOf(client));
  };
  for (const Kept& kept : named_) add(kept);
  for (const auto& [ends, kept] : kept_) {
    // A chain that the scenario names by its ends is in the list already.
    const bool is_named = std::ranges::any_of(
        named_, [&](const Kept& one) { return one.figures.name == kept.figures.name; });
    if (!is_named) add(kept);
  }
  return all;
}

}  // namespace tcs
