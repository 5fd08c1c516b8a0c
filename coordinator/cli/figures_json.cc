#include "coordinator/cli/figures_json.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

Json JsonOf(const Distribution& of) {
  return {{"count", of.count()},
          {"min", of.min()},
          {"p50", of.Quantile(0.5)},
          {"p99", of.Quantile(0.99)},
          {"max", of.max()}};
}

Json JsonOf(const InputFigures& input) {
  return {{"from", input.from},
          {"sent", input.sent},
          {"received", input.received},
          {"lost", input.lost},
          {"replaced", input.replaced},
          {"unread", input.unread},
          {"most_waiting", input.most_waiting},
          {"age_ns", JsonOf(input.age)}};
}

// "sensor", "waiting"…
const char* KindOf(ChainHop::Of of) {
  switch (of) {
    case ChainHop::Of::kSensor:
      return "sensor";
    case ChainHop::Of::kWaiting:
      return "waiting";
    case ChainHop::Of::kProgram:
      return "program";
    case ChainHop::Of::kHeld:
      return "held";
    case ChainHop::Of::kWay:
      return "way";
    case ChainHop::Of::kActuator:
      return "actuator";
  }
  return "";
}

Json JsonOf(const ChainCase& one) {
  Json hops = Json::array();
  for (const ChainHop& hop : one.hops)
    hops.push_back({{"of", KindOf(hop.of)}, {"name", hop.name}, {"ns", hop.ns}});
  return {{"sampled_ns", one.sampled_ns}, {"acts_ns", one.acts_ns}, {"hops", std::move(hops)}};
}

}  // namespace

nlohmann::ordered_json ChainJson(const ChainFigures& chain) {
  Json worst = Json::array();
  for (const ChainCase& one : chain.worst) worst.push_back(JsonOf(one));
  return {{"deadline_ns", chain.deadline_ns > 0 ? Json(chain.deadline_ns) : Json()},
          {"missed", chain.missed},
          {"first_missed_ns", chain.first_missed_ns},
          {"age_ns", JsonOf(chain.age)},
          {"reaction_ns", JsonOf(chain.reaction)},
          {"through", chain.path},
          {"worst", std::move(worst)}};
}

void AddFigures(const ClientFigures& figures, nlohmann::ordered_json& client) {
  const DeadlineFigures& deadline = figures.deadline;
  client["response_ns"] = JsonOf(figures.times.response);
  client["start_delay_ns"] = JsonOf(figures.times.start_delay);
  client["execution_ns"] = JsonOf(figures.times.execution);
  // The jitter is that of the ends, as control engineers count it.
  const Distribution& response = figures.times.response;
  client["jitter_ns"] = response.count() > 0 ? Json(response.max() - response.min()) : Json();
  client["counted_after_ns"] = figures.after_ns;
  client["deadline"] = nullptr;
  if (deadline.deadline_ns > 0) {
    client["deadline"] = {{"deadline_ns", deadline.deadline_ns},
                          {"period_of", deadline.source},
                          {"judged", deadline.judged},
                          {"missed", deadline.missed},
                          {"most_in_a_row", deadline.most_in_a_row},
                          {"first_missed_ns", deadline.first_missed_ns}};
    client["late"] = {
        {"total_ns", figures.late.total_ns},       {"queued_ns", figures.late.queued_ns},
        {"executed_ns", figures.late.executed_ns}, {"others_ns", figures.late.others_ns},
        {"locks_ns", figures.late.locks_ns},       {"away_ns", figures.late.away_ns},
        {"wakeup_ns", figures.late.wakeup_ns},     {"room_ns", figures.late.room_ns}};
  }
  client["inputs"] = Json::array();
  for (const InputFigures& input : figures.inputs) client["inputs"].push_back(JsonOf(input));
  client["command_age_ns"] = figures.commands ? JsonOf(figures.command_age) : Json();
}

}  // namespace tcs
