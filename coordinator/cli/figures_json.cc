#include "coordinator/cli/figures_json.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

Json JsonOf(const Distribution& of) {
  return {{"count", of.count()},
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

}  // namespace

void AddFigures(const ClientFigures& figures, nlohmann::ordered_json& client) {
  const DeadlineFigures& deadline = figures.deadline;
  client["response_ns"] = JsonOf(figures.times.response);
  client["start_delay_ns"] = JsonOf(figures.times.start_delay);
  client["execution_ns"] = JsonOf(figures.times.execution);
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
        {"room_ns", figures.late.room_ns}};
  }
  client["inputs"] = Json::array();
  for (const InputFigures& input : figures.inputs) client["inputs"].push_back(JsonOf(input));
  client["command_age_ns"] = figures.commands ? JsonOf(figures.command_age) : Json();
}

}  // namespace tcs
