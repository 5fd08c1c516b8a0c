#include "coordinator/perfetto/perfetto_trace.h"

#include <variant>

#include "coordinator/perfetto/counters.h"
#include "coordinator/perfetto/event_writer.h"
#include "coordinator/perfetto/flows.h"
#include "coordinator/perfetto/gzip_file.h"
#include "coordinator/perfetto/misses.h"
#include "coordinator/perfetto/schedule.h"

namespace tcs::perfetto {

std::string WriteTrace(const std::string& folder, const std::string& path) {
  const auto read = Schedule::Read(folder + "/trace.json");
  if (const auto* error = std::get_if<LoadError>(&read)) return error->message;
  const Schedule& schedule = std::get<Schedule>(read);
  GzipFile file;
  if (std::string error = file.Open(path); !error.empty()) return error;
  file.Append("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n");
  file.Append(schedule.events());
  {
    EventWriter events(file, !schedule.events().empty(), schedule.last_pid());
    for (const std::string& error :
         {AddBodies(folder, &events), AddJoints(folder, &events), AddCommands(folder, &events),
          AddMeasurements(folder, &events), AddMessages(folder, schedule, &events)}) {
      if (!error.empty()) return error;
    }
    AddOutput(folder, schedule, &events);
    AddMisses(folder, schedule, &events);
  }
  file.Append("\n]}\n");
  return file.Close();
}

}  // namespace tcs::perfetto
