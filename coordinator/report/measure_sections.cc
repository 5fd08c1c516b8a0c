#include "coordinator/report/measure_sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "coordinator/report/measure_figure.h"
#include "coordinator/report/measure_words.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"
#include "coordinator/report/varied.h"

namespace tcs::report {

namespace {

constexpr std::size_t kMostSaid = 2;  // curves that the sentence tells of one by one

double MedianOf(const MeasurePoint& point) { return MeasureSpreadOf(point.values).median; }

// "missed deadlines of r/planner", with a large letter.
std::string Headed(std::string text) {
  // The words for a metric are its name, which stays as it is.
  const std::size_t of = text.find(" of ");
  if (of != std::string::npos && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

// The least value from which on all medians are 0; empty if the last median is not 0.
std::string FreeFrom(const MeasureCurve& curve) {
  std::string label;
  for (auto point = curve.points.rbegin(); point != curve.points.rend(); ++point) {
    if (MedianOf(*point) != 0) break;
    label = point->label;
  }
  return label;
}

// "cpu.cores = 2, drift = 1ms"
std::string CurveName(const MeasurePlotData& data, const MeasurePanel& panel,
                      const MeasureCurve& curve) {
  std::string name = curve.name;
  if (!name.empty() && !data.curves_are.empty())
    name = fmt::format("{} = {}", data.curves_are, name);
  if (!panel.title.empty()) name += (name.empty() ? "" : ", ") + panel.title;
  return name;
}

std::string AboutCurve(const MeasurePlotData& data, const MeasurePanel& panel,
                       const MeasureCurve& curve) {
  const std::string of = CurveName(data, panel, curve);
  const MeasurePoint &first = curve.points.front(), &last = curve.points.back();
  std::string text = fmt::format("{} at {}", MeasureText(MedianOf(first), data.unit), first.label);
  if (curve.points.size() > 1) {
    text += fmt::format(", {} at {}", MeasureText(MedianOf(last), data.unit), last.label);
  }
  const bool is_miss = data.measure.ends_with(".missed") || data.measure.ends_with(".misses");
  const std::string free = is_miss ? FreeFrom(curve) : "";
  if (!free.empty() && free != first.label && free != last.label) {
    text += fmt::format(" (none from {} on)", free);
  }
  return of.empty() ? text : of + ": " + text;
}

// Tells the extremes of many curves.
std::string AboutMany(const MeasurePlotData& data, std::size_t curves) {
  struct Extreme {
    double value = 0;
    std::string where;
  } least{1e300, ""}, most{-1e300, ""};
  for (const MeasurePanel& panel : data.panels) {
    for (const MeasureCurve& curve : panel.curves) {
      for (const MeasurePoint& point : curve.points) {
        const double median = MedianOf(point);
        const std::string where = fmt::format("{} = {}, {}", ShortKeys({data.against}).front(),
                                              point.label, CurveName(data, panel, curve));
        if (median < least.value) least = {median, where};
        if (median > most.value) most = {median, where};
      }
    }
  }
  return fmt::format("Median over the trials, for {}: from {} ({}) to {} ({}).",
                     Count(static_cast<std::int64_t>(curves), "combination"),
                     MeasureText(least.value, data.unit), least.where,
                     MeasureText(most.value, data.unit), most.where);
}

std::string AboutPlot(const MeasurePlotData& data) {
  std::vector<std::string> said;
  for (const MeasurePanel& panel : data.panels) {
    for (const MeasureCurve& curve : panel.curves) said.push_back(AboutCurve(data, panel, curve));
  }
  if (said.size() > kMostSaid) return AboutMany(data, said.size());
  return fmt::format("Median over the trials: {}.", fmt::join(said, "; "));
}

Table TableOf(const MeasurePlotData& data) {
  const std::string curves = data.curves_are.empty() ? std::string("trials of") : data.curves_are;
  std::vector<Column> columns{{ShortKeys({data.against}).front(), false}};
  const bool has_names = !data.panels.front().curves.front().name.empty();
  const bool has_titles = !data.panels.front().title.empty();
  if (has_names) columns.push_back({curves, false});
  if (has_titles) columns.push_back({"at", false});
  for (const char* title : {"trials", "10 %", "median", "90 %"}) columns.push_back({title});
  Table table(fmt::format("{} against {}: of the trials with each value the median, and what 10 % "
                          "and 90 % of them lie below.",
                          Headed(MeasureWords(data.measure)), data.against),
              columns);
  for (const MeasurePanel& panel : data.panels) {
    for (const MeasureCurve& curve : panel.curves) {
      for (const MeasurePoint& point : curve.points) {
        std::vector<std::string> cells{point.label};
        if (has_names) cells.push_back(curve.name);
        if (has_titles) cells.push_back(panel.title);
        const MeasureSpread spread = MeasureSpreadOf(point.values);
        cells.push_back(fmt::format("{}", point.values.size()));
        for (const double value : {spread.low, spread.median, spread.high}) {
          cells.push_back(MeasureText(value, data.unit));
        }
        table.Row(std::move(cells));
      }
    }
  }
  return table;
}

std::string NoteOf(const MeasurePlotData& data) {
  std::string note =
      "The line joins the medians of the trials with each value; the band is between what 10 % and "
      "90 % of them lie below.";
  if (data.without_value > 0) {
    note += fmt::format(
        " {} no such figure, as where a client never got so far, and {} not among them.",
        data.without_value == 1 ? "One trial has"
                                : fmt::format("{} trials have", data.without_value),
        data.without_value == 1 ? "is" : "are");
  }
  if (data.left_out > 0) {
    note +=
        fmt::format(" {} not shown.",
                    data.left_out == 1 ? "One further combination is"
                                       : fmt::format("{} further combinations are", data.left_out));
  }
  return note;
}

}  // namespace

std::vector<MeasureParts> MeasureSections(const Results& results, const MeasureRequest& request) {
  std::vector<MeasureParts> all;
  for (const MeasurePlotData& data : MeasurePlots(results, request)) {
    const std::string title =
        fmt::format("{} against {}", Headed(MeasureWords(data.measure)), data.against);
    const Table table = TableOf(data);
    all.push_back(
        {MakeFigure("measure-" + FileName(data.measure) + "-" + FileName(data.against), title,
                    AboutPlot(data), NoteOf(data),
                    [&](int width) { return DrawMeasure(data, width); }),
         fmt::format("<details>\n<summary>The numbers</summary>\n{}</details>\n", table.Html()),
         fmt::format("{}:\n{}", title, table.Text())});
  }
  return all;
}

}  // namespace tcs::report
