#include "coordinator/cli/report_command.h"

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/errors/visible.h"
#include "coordinator/report/page.h"
#include "coordinator/report/read_results.h"
#include "coordinator/report/text.h"
#include "coordinator/report/write.h"

namespace tcs {

int ReportCommand(const ReportArguments& arguments) {
  std::vector<std::string> bodies;
  if (!arguments.bodies.empty()) {
    const std::size_t comma = arguments.bodies.find(',');
    bodies = {arguments.bodies.substr(0, comma),
              comma == std::string::npos ? "" : arguments.bodies.substr(comma + 1)};
    if (bodies[0].empty() || bodies[1].empty() || bodies[0] == bodies[1]) {
      return Fail("--bodies needs two different names, such as --bodies predator,prey, not '" +
                  arguments.bodies + "'");
    }
  }
  const bool wants_distance = !bodies.empty() || !arguments.marks.empty();
  const auto read =
      report::ReadResults(arguments.folders, bodies,
                          wants_distance ? report::Distance::kRead : report::Distance::kLeftOut);
  if (const auto* error = std::get_if<LoadError>(&read)) return Fail(error->message);
  const auto& results = std::get<report::Results>(read);
  const report::MeasureRequest request{arguments.measures, arguments.against};
  if (const std::string why = WhyNoMeasure(results, request); !why.empty()) return Fail(why);
  const report::Page page = report::MakePage(results, {arguments.title, arguments.marks, request});
  for (const std::string& warning : page.warnings) {
    Say("warning: " + warning);
  }
  const auto files = arguments.figures == "svg"   ? report::FigureFiles::kSvg
                     : arguments.figures == "png" ? report::FigureFiles::kPng
                                                  : report::FigureFiles::kNone;
  std::vector<std::string> written;
  const std::string error = report::WritePage(page, arguments.out, files, &written);
  if (!error.empty()) return Fail(error);
  Print("{}\nwritten: {}\n", VisibleLines(page.text), report::Listed(written));
  return kSucceeded;
}

}  // namespace tcs
