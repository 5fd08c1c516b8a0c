#include "coordinator/report/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/measure_sections.h"
#include "coordinator/report/metric_sections.h"
#include "coordinator/report/page_files.h"
#include "coordinator/report/replay.h"
#include "coordinator/report/replay_sections.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// Of all timelines together: about 11 bytes of the page each.
constexpr std::size_t kMostSlices = 200'000;
// Of all replays together, before they become text, which is a third longer.
constexpr std::size_t kMostReplayBytes = 5'000'000;

std::string Paragraph(std::string_view classes, const std::string& text) {
  if (text.empty()) return {};
  return fmt::format("<p class=\"{}\">{}</p>\n", classes, Escaped(text));
}

class Builder {
 public:
  Builder(const Results& results, const PageOptions& options)
      : results_(results), options_(options) {
    page_.warnings = results.warnings;
  }

  Page Build() {
    // What happened first, then why.
    AddReplays();
    AddTimelines();
    if (!results_.systems.empty()) AddFirst(SystemsSection(results_, options_.marks));
    AddFailures();
    Add(DistanceHistogram(results_, options_.marks));
    Add(DistanceOverTime(results_, options_.marks));
    Add(MetricsOverTime(results_));
    Add(MetricsSection(results_));
    Add(CostsSection(results_));
    Add(ResponseTimes(results_));
    Add(Lateness(results_));
    Add(ClientsSection(results_));
    AddMeasures();
    for (const std::string& key : VariedKeys(results_)) {
      Add(SweepFigure(results_, key, options_.marks));
      AddFirst(SweepSection(results_, key, options_.marks));
    }
    page_.html = Whole();
    return std::move(page_);
  }

 private:
  void Add(const Section& section) {
    body_ += fmt::format("<section>\n<h2>{}</h2>\n{}{}</section>\n", Escaped(section.heading),
                         Paragraph("says", section.sentence), section.html);
  }
  // One that a terminal shows, too.
  void AddFirst(const Section& section) {
    Add(section);
    page_.text +=
        fmt::format("{}{}:\n{}", page_.text.empty() ? "" : "\n", section.heading, section.text);
  }
  void Add(const std::optional<Section>& section) {
    if (section) Add(*section);
  }
  void Add(const std::optional<Figure>& figure) {
    if (figure) AddFigure(*figure, "");
  }

  void AddFigure(const Figure& figure, std::string_view more) {
    ++figures_;
    body_ += fmt::format(
        "<section>\n<h2>{}</h2>\n{}<figure id=\"{}\">\n{}\n{}\n{}<figcaption><b>Figure {}.</b> "
        "{}</figcaption>\n</figure>\n</section>\n",
        Escaped(figure.title), Paragraph("says", figure.sentence), figure.id,
        InlineSvg(figure, figure.wide, "wide"), InlineSvg(figure, figure.narrow, "narrow"), more,
        figures_, Escaped(figure.note));
    page_.svgs.emplace_back(figure.id, StandaloneSvg(figure));
  }

  void AddMeasures() {
    for (const MeasureParts& parts : MeasureSections(results_, options_.wish)) {
      AddFigure(parts.figure, parts.table);
      page_.text += (page_.text.empty() ? "" : "\n") + parts.text;
    }
  }

  void AddReplays() {
    std::vector<Replay> replays;
    for (const System& system : results_.systems) {
      const Run& run = system.runs.front();
      auto read = ReadReplay(run.folder, system.name, static_cast<double>(run.virtual_ns) * 1e-9,
                             kMostReplayBytes / results_.systems.size(), &page_.warnings);
      if (auto* replay = std::get_if<Replay>(&read)) {
        replay->trials = system.runs.size();
        replays.push_back(std::move(*replay));
      } else {
        page_.warnings.push_back(std::get<LoadError>(read).message +
                                 "; the world is not shown without it");
      }
    }
    has_world_ = std::any_of(replays.begin(), replays.end(),
                             [](const Replay& replay) { return !replay.time_s.empty(); });
    body_ += WorldSection(replays);
    if (const auto paths = PathsFigure(replays)) AddFigure(*paths, kPathsLive);
    if (const auto motion = MotionFigure(replays)) AddFigure(*motion, kMotionControls);
    body_ += SaidSection(replays);
  }

  void AddTimelines() {
    std::vector<Timeline> timelines;
    for (const System& system : results_.systems) {
      auto read = ReadTimeline(system.runs.front().folder, system.name);
      if (auto* timeline = std::get_if<Timeline>(&read)) {
        timelines.push_back(std::move(*timeline));
      } else {
        page_.warnings.push_back(std::get<LoadError>(read).message +
                                 "; the timeline goes without it");
      }
    }
    Shorten(&timelines, kMostSlices);
    const auto figure = TimelineFigure(timelines);
    if (!figure) return;
    std::string more(kTimelineControls);
    for (const Timeline& timeline : timelines) {
      more += fmt::format("<script type=\"application/json\" class=\"timeline\">{}</script>\n",
                          Encoded(timeline));
    }
    AddFigure(*figure, more);
  }

  // What is missing is said on the page, too.
  void AddFailures() {
    std::string items;
    const auto add = [&](const System& system) {
      for (const std::string& failure : Failures(system)) {
        items += fmt::format("<li>{}</li>\n", Escaped(failure));
        page_.warnings.push_back(failure);
      }
    };
    for (const System& system : results_.systems) add(system);
    for (const Sweep& sweep : results_.sweeps) {
      for (const SweepValue& value : sweep.values) add(value.system);
    }
    for (const Grid& grid : results_.grids) {
      for (const GridCell& cell : grid.cells) add(cell.system);
    }
    for (const std::string& warning : results_.warnings) {
      items += fmt::format("<li>{}</li>\n", Escaped(warning));
    }
    if (items.empty()) return;
    body_ += "<section class=\"failures\">\n<h2>What is missing</h2>\n<ul>\n" + items +
             "</ul>\n</section>\n";
  }

  std::string Whole() const {
    const std::string title = options_.title.empty() ? results_.scenario : options_.title;
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
        "'unsafe-inline'; script-src 'unsafe-inline'\">\n"
        "<title>{0}</title>\n<style>\n{1}{2}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n{3}"
        "<footer>Made by tcsim report from result folders of the scenario “{4}”.</footer>\n"
        "</main>\n{5}<script>\n{6}</script>\n<script>\n{7}</script>\n</body>\n</html>\n",
        Escaped(title), PageStyle(), kReportCss, body_, Escaped(results_.scenario),
        has_world_ ? fmt::format("<script>\n{}</script>\n", kThreeJs) : "", kReplayDataJs, kPageJs);
  }

  const Results& results_;
  const PageOptions& options_;
  Page page_;
  std::string body_;
  int figures_ = 0;
  bool has_world_ = false;
};

}  // namespace

Page MakePage(const Results& results, const PageOptions& options) {
  return Builder(results, options).Build();
}

}  // namespace tcs::report
