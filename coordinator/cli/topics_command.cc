#include "coordinator/cli/topics_command.h"

#include <fmt/format.h>

#include <variant>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/dds/topics_file.h"
#include "coordinator/dds/topics_table.h"
#include "coordinator/errors/visible.h"

namespace tcs {

int TopicsCommand(const TopicsArguments& arguments) {
  const auto read = dds::ReadTopics(arguments.folder);
  if (const auto* error = std::get_if<LoadError>(&read)) return Fail(error->message);
  const auto& topics = std::get<std::vector<dds::TopicReport>>(read);
  Print("{}", VisibleLines(dds::TopicsTable(topics, arguments.with_qos)));
  for (const std::string& warning : dds::TopicWarnings(topics)) {
    Say("warning: " + warning);
  }
  return kSucceeded;
}

}  // namespace tcs
