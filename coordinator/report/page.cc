#include "coordinator/report/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/explain/told.h"
#include "coordinator/report/answer_sections.h"
#include "coordinator/report/expected_words.h"
#include "coordinator/report/measure_sections.h"
#include "coordinator/report/metric_sections.h"
#include "coordinator/report/misses.h"
#include "coordinator/report/page_files.h"
#include "coordinator/report/replay.h"
#include "coordinator/report/replay_sections.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

namespace {

// The most slices of all timelines together: about 11 bytes of the page each.
constexpr std::size_t kMostSlices = 200'000;
// The most bytes of all replays together, before they become text, which is a third longer.
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
    // The answer first, then what happened, then why; what the simulation did itself is no robot's.
    ReadTold();
    AddVerdict();
    AddFirst(InTimeSection(results_), "in-time");
    AddFirst(ChainsSection(results_), "chains");
    AddExplained();
    AddReplays();
    AddTimelines();
    Add(ResponseTimes(results_));
    Add(MetricsOverTime(results_));
    Add(MetricsSection(results_), "metrics");
    AddFirst(SystemsSection(results_, options_.marks), "systems");
    Add(DistanceHistogram(results_, options_.marks));
    Add(DistanceOverTime(results_, options_.marks));
    AddMeasures();
    for (const std::string& key : VariedKeys(results_)) {
      Add(SweepFigure(results_, key, options_.marks));
      AddFirst(SweepSection(results_, key, options_.marks), "sweep-of-" + FileName(key));
    }
    AddWarnings();
    AddFailures();
    AddSimulation();
    page_.html = Whole();
    return std::move(page_);
  }

 private:
  // Adds a part of the page, which the table of contents names.
  void AddHtml(std::string_view id, const std::string& heading, const std::string& inner,
               std::string_view classes = "") {
    contents_ += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, Escaped(heading));
    body_ += fmt::format("<section id=\"{}\"{}>\n<h2>{}</h2>\n{}</section>\n", id,
                         classes.empty() ? "" : fmt::format(" class=\"{}\"", classes),
                         Escaped(heading), inner);
  }
  void Add(const std::optional<Section>& section, std::string_view id) {
    if (!section) return;
    AddHtml(id, section->heading, Paragraph("says", section->sentence) + section->html);
  }
  // Adds a section that a terminal shows, too.
  void AddFirst(const std::optional<Section>& section, const std::string& id) {
    Add(section, id);
    if (section) AddText(section->heading, section->text);
  }
  void AddText(const std::string& heading, const std::string& text) {
    page_.text += fmt::format("{}{}:\n{}", page_.text.empty() ? "" : "\n", heading, text);
  }
  void Add(const std::optional<Figure>& figure) {
    if (figure) AddFigure(*figure, "");
  }

  void AddFigure(const Figure& figure, std::string_view more) {
    ++figures_;
    AddHtml("about-" + figure.id, figure.title,
            fmt::format("{}<figure id=\"{}\">\n{}\n{}\n{}<figcaption><b>Figure {}.</b> "
                        "{}</figcaption>\n</figure>\n",
                        Paragraph("says", figure.sentence), figure.id,
                        InlineSvg(figure, figure.wide, "wide"),
                        InlineSvg(figure, figure.narrow, "narrow"), more, figures_,
                        Escaped(figure.note)));
    page_.svgs.emplace_back(figure.id, StandaloneSvg(figure));
  }

  // Reads what each system's first run has told.
  void ReadTold() {
    for (const System& system : results_.systems) {
      ToldOf& of = told_.emplace_back(ToldOf{&system, {}});
      const Run& run = system.runs.front();
      if (!run.has_answers || !IsFile(run.folder + "/responses.csv")) continue;
      auto read = explain::ReadTold(run.folder);
      if (auto* told = std::get_if<explain::Told>(&read)) {
        of.told = std::move(*told);
      } else {
        page_.warnings.push_back(std::get<LoadError>(read).message);
      }
    }
  }

  void AddVerdict() {
    const std::string html = VerdictHtml(results_);
    if (html.empty()) return;
    AddHtml("verdict", "The verdict", html);
    std::string lines;
    for (const System& system : results_.systems) {
      for (const std::string& sentence : system.runs.front().verdict)
        lines += fmt::format("! {}\n", sentence);
      for (const std::string& sentence : NotAsExpected(system))
        lines += fmt::format("not as expected: {}\n", sentence);
    }
    if (!lines.empty()) AddText("The verdict", lines);
  }

  void AddExplained() {
    const std::string html = ExplainedHtml(results_, told_);
    if (html.empty()) return;
    AddHtml("why", "Why the worst was late",
            Paragraph("says",
                      "What the time from the cause to the end of the work went into. Of any other "
                      "activation “tcsim explain” tells the same, and so does a click on its mark "
                      "in the timeline.") +
                html);
  }

  // Adds the warnings that the runs gave while they went.
  void AddWarnings() {
    std::string items;
    for (const System& system : results_.systems) {
      for (const std::string& warning : system.runs.front().warnings)
        items += fmt::format("<li>{}</li>\n", Escaped(warning));
    }
    if (!items.empty()) AddHtml("warnings", "Warnings", "<ul>\n" + items + "</ul>\n", "failures");
  }

  void AddSimulation() {
    std::string inner;
    for (const auto& section : {CostsSection(results_), ClientsSection(results_)}) {
      if (!section) continue;
      inner += fmt::format("<h3>{}</h3>\n{}{}", Escaped(section->heading),
                           Paragraph("says", section->sentence), section->html);
    }
    if (inner.empty()) return;
    AddHtml("simulation", "Of the simulation itself",
            Paragraph("says",
                      "These are figures of tcs, not of the robots: how well it kept them in one "
                      "time, and what that cost on this computer. A robot whose deadlines are all "
                      "missed can have perfect figures here.") +
                inner,
            "simulation");
  }

  void AddMeasures() {
    for (const MeasureParts& parts : MeasureSections(results_, options_.measures)) {
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
    if (const std::string world = WorldSection(replays); !world.empty()) {
      contents_ += "<li><a href=\"#world\">The world</a></li>\n";
      body_ += world;
    }
    if (const auto paths = PathsFigure(replays)) AddFigure(*paths, kPathsLive);
    if (const auto motion = MotionFigure(replays)) AddFigure(*motion, kMotionControls);
    if (const std::string said = SaidSection(replays); !said.empty()) {
      contents_ += "<li><a href=\"#said\">What programs said</a></li>\n";
      body_ += said;
    }
  }

  void AddTimelines() {
    std::vector<Timeline> timelines;
    for (const System& system : results_.systems) {
      auto read = ReadTimeline(system.runs.front().folder, system.name);
      if (auto* timeline = std::get_if<Timeline>(&read)) {
        // All of a run's time is shown, also if nothing happens at its end.
        timeline->virtual_end =
            std::max(timeline->virtual_end, system.runs.front().virtual_ns / 1000);
        const auto of = std::ranges::find(told_, &system, &ToldOf::system);
        if (of->told.has_value()) AddMisses(*of->told, timeline);
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

  // The page names what is missing, too.
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
    AddHtml("missing", "What is missing", "<ul>\n" + items + "</ul>\n", "failures");
  }

  std::string Whole() const {
    // A run without a summary does not know its scenario.
    const std::string scenario = results_.scenario.empty() && !results_.systems.empty()
                                     ? results_.systems.front().name
                                     : results_.scenario;
    const std::string title = options_.title.empty() ? scenario : options_.title;
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
        "'unsafe-inline'; script-src 'unsafe-inline'\">\n"
        "<title>{0}</title>\n<style>\n{1}{2}</style>\n</head>\n<body class=\"has-contents\">\n"
        "<nav class=\"contents\" aria-label=\"Contents\">\n<ol>\n{8}</ol>\n</nav>\n"
        "<main>\n<h1>{0}</h1>\n{3}"
        "<footer>Made by tcsim report from result folders of the scenario “{4}”.</footer>\n"
        "</main>\n{5}<script>\n{6}</script>\n<script>\n{7}</script>\n</body>\n</html>\n",
        Escaped(title), PageStyle(), kReportCss, body_, Escaped(scenario),
        has_world_ ? fmt::format("<script>\n{}</script>\n", kThreeJs) : "", kReplayDataJs, kPageJs,
        contents_);
  }

  const Results& results_;
  const PageOptions& options_;
  Page page_;
  std::vector<ToldOf> told_;
  std::string contents_, body_;
  int figures_ = 0;
  bool has_world_ = false;
};

}  // namespace

Page MakePage(const Results& results, const PageOptions& options) {
  return Builder(results, options).Build();
}

}  // namespace tcs::report
