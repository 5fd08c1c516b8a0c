#include "coordinator/processes/run_records.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace tcs {

std::string RunRecords::Open() {
  std::string error = OpenFiles();
  if (error.empty() && world_.present()) world_row_ = schedule_.AddRow("dynamics", "dynamics");
  return error;
}

std::string RunRecords::Follow(AnswerFeed& answers) {
  answers_ = &answers;
  answers.book().Tell([this](const Response& response) {
    if (!answers_->IsOurs(response.client)) responses_.Write(response);
  });
  return responses_.Open(run_.options.output_directory + "/responses.csv",
                         answers.NamesOfClients());
}

std::string RunRecords::OpenFiles() {
  const std::string& directory = run_.options.output_directory;
  if (directory.empty()) return {};
  if (run_.options.before_writing) run_.options.before_writing();
  // Such a file says that a run has ended, and that of an earlier run would say it of this one.
  std::error_code ignored;
  for (const char* file : {"/summary.json", "/unfinished.json"}) {
    std::filesystem::remove(directory + file, ignored);
  }
  std::string error = schedule_.Open(directory, !run_.IsFixed());
  if (error.empty()) error = world_.OpenRecords(directory);
  if (error.empty()) {
    error = activations_.Open(directory + "/activations.csv", run_.options.counts_work);
  }
  if (error.empty()) error = output_.Open(directory);
  for (const RobotSpec& robot : run_.scenario.robots) {
    if (robot.is_ours) continue;
    for (const ClientSpec& client : robot.clients) {
      output_.Add(client.name, FileNameOf(client));
      client_metrics_.Add(client.name, directory + "/" + FileNameOf(client) + ".out.log");
    }
  }
  metrics_.OpenIn(directory);
  world_.Measure(metrics_);
  output_.Tell([this](const std::string& client, std::int64_t end, std::int64_t now_ns) {
    // Text that is printed after the run's end counts at its end.
    client_metrics_.Grew(client, end, std::min(now_ns, run_.grace_began.ns()));
  });
  return error;
}

void RunRecords::StartAt(const RunClock& clock) {
  if (run_.header == nullptr) return;  // the run does not begin
  client_metrics_.Begin({.monotonic_ns = run_.header->monotonic_offset_ns,
                         .realtime_ns = run_.header->realtime_offset_ns,
                         .duration_ns = run_.scenario.duration.ns()});
  schedule_.StartAt(clock.start_tsc(), clock.rate().ticks_per_ns);
}

void RunRecords::Flush(bool for_watchers) {
  schedule_.Flush();
  activations_.Flush();
  responses_.Flush();
  world_.FlushRecords();
  output_.Flush();
  // The lines of clients' metrics would stand where real time has it among those of the scenario's.
  if (for_watchers || !run_.IsFixed()) client_metrics_.CatchUp();
  metrics_.Flush();
}

std::string RunRecords::Close() {
  output_.LookAt(run_.latest.ns());
  const std::string errors[] = {schedule_.Close(), activations_.Close(), responses_.Close(),
                                world_.CloseRecords(), output_.Close()};
  for (const std::string& error : errors) {
    if (!error.empty()) return error;
  }
  return {};
}

std::string RunRecords::CloseMetrics(VirtualTime end) {
  // Where the run did not begin, the text that is there may be an earlier run's.
  if (run_.header != nullptr) client_metrics_.Finish(end.ns());
  return metrics_.Close();
}

void RunRecords::Ran(const Task& task, ShownSpan shown, WorldSpan world, std::uint64_t until_tsc) {
  const std::uint64_t since_tsc = std::exchange(run_.turn.recorded_tsc, until_tsc);
  schedule_.Slice(task.row, {shown.start.ns(), shown.end.ns()}, {world.start.ns(), world.end.ns()},
                  {since_tsc, until_tsc});
  output_.LookAt(world.end.ns());
  if (answers_ == nullptr || world.start == world.end) return;
  if (const auto who = answers_->WhoIs(task))
    answers_->book().Ran(*who, static_cast<int>(task.cpu->core), world.start.ns(), world.end.ns());
}

}  // namespace tcs
