#include "coordinator/report/page.h"

#include <algorithm>

#include "coordinator/report/page_files.h"
#include "coordinator/report/read_results.h"
#include "coordinator/report/write.h"
#include "tests/unit/report/result_folder.h"

namespace tcs::report {
namespace {

class PageTest : public ResultFolderTest {
 protected:
  Page Make(const std::vector<std::string>& names, const PageOptions& options = {"", {5}}) {
    std::vector<std::string> paths;
    for (const std::string& name : names) paths.push_back(Path(name));
    auto read = ReadResults(paths, {});
    const auto* error = std::get_if<LoadError>(&read);
    EXPECT_EQ(error, nullptr) << error->message;
    return error == nullptr ? MakePage(std::get<Results>(read), options) : Page{};
  }
  // But for its scripts, which are the same in all pages.
  static bool Has(const Page& page, const std::string& text) {
    std::string html = page.html;
    for (const std::string_view script : {kThreeJs, kReplayDataJs, kPageJs}) {
      const std::size_t at = html.find(script);
      if (at != std::string::npos) html.erase(at, script.size());
    }
    return html.find(text) != std::string::npos;
  }
  static bool HasFigure(const Page& page, const std::string& name) {
    return std::any_of(page.svgs.begin(), page.svgs.end(),
                       [&](const auto& svg) { return svg.first == name; });
  }
};

TEST_F(PageTest, SaysWhatItsDataSay) {
  WriteRun("near", 4, 4);
  WriteRun("far", 6, 4);
  const Page page = Make({"near", "far"});
  EXPECT_TRUE(Has(page, "The median distance is 4.00\u00a0m in “near” and 6.00\u00a0m in “far”."));
  EXPECT_TRUE(Has(
      page,
      "The share of the samples below 5\u00a0m is 100\u00a0% in “near” and 0\u00a0% in “far”."));
  EXPECT_TRUE(Has(page,
                  "Longer than the deadline: r/controller for 1 of 2 activations in “near” and "
                  "r/controller for 1 of 2 activations in “far”."));
  EXPECT_TRUE(Has(page, "2 of 4 deadlines were missed."));
  for (const char* name : {"distances", "distance-over-time", "timeline", "response-times"}) {
    EXPECT_TRUE(HasFigure(page, name)) << name;
  }
  EXPECT_TRUE(page.warnings.empty());
}

TEST_F(PageTest, SaysWhatIsNotAsExpected) {
  WriteRun("one");
  auto summary = Summary();
  const auto expect = [&](bool holds) {
    summary["expectations"] = {{{"subject", "body <drone>"},
                                {"figure", "z"},
                                {"what", "z was between 0 and 2, expected at least 1"},
                                {"holds", holds}},
                               {{"subject", "r/planner"},
                                {"figure", "misses"},
                                {"what", "misses was 0, expected at most 0"},
                                {"holds", true}}};
    return summary.dump();
  };
  EXPECT_FALSE(Has(Make({"one"}), "expectations"));
  Write("one/summary.json", expect(false));
  const Page page = Make({"one"});
  EXPECT_TRUE(Has(page, "1 of 2 expectations hold. Not as expected:"));
  EXPECT_TRUE(Has(page, "body &lt;drone&gt;: z was between 0 and 2, expected at least 1</li>"));
  EXPECT_FALSE(Has(page, "misses was 0"));
  Write("one/summary.json", expect(true));
  EXPECT_TRUE(Has(Make({"one"}), "2 of 2 expectations hold.</p>"));
}

TEST_F(PageTest, ThePapersNumbersStandOnlyBesideItsScenario) {
  WriteRun("one");
  EXPECT_FALSE(Has(Make({"one"}), "the paper"));
  auto summary = Summary();
  summary["scenario"] = "predator_prey";
  Write("one/summary.json", summary.dump());
  EXPECT_TRUE(Has(Make({"one"}), "the paper: callback"));
}

TEST_F(PageTest, NamesAreNoMarkup) {
  WriteRun("one");
  Write("trials/trials.json",
        R"({"name": "<img src=x>&\"</script>", "first_seed": 1, "trials": 2})");
  WriteRun("trials/seed-0001");
  Write("trials/seed-0002/tcsim.log", "tcsim: <script>alert(1)</script>\n");
  const Page page = Make({"trials"}, {"<h1>", {}});
  EXPECT_FALSE(Has(page, "<img"));
  EXPECT_FALSE(Has(page, "<script>alert"));
  EXPECT_TRUE(Has(page, "<title>&lt;h1&gt;</title>"));
  EXPECT_TRUE(Has(page, "&lt;img src=x&gt;&amp;&quot;&lt;/script&gt;"));
}

TEST_F(PageTest, NeedsNothingButItself) {
  WriteRun("one");
  const Page page = Make({"one"});
  for (const char* outside : {"http://", "https://", "src=", "@import", "url("}) {
    EXPECT_FALSE(Has(page, outside)) << outside;
  }
  // Links are to the page itself.
  for (std::size_t at = 0; (at = page.html.find("href=", at)) != std::string::npos; ++at) {
    EXPECT_EQ(page.html.substr(at, 7), "href=\"#");
  }
  EXPECT_NE(page.html.find(kThreeJs), std::string::npos);
}

TEST_F(PageTest, BeginsWithTheAnswerAndEndsWithTheSimulation) {
  WriteRun("one", 5, 4);
  const Page page = Make({"one"});
  const char* const order[] = {"<h2>The verdict</h2>",
                               "<h2>Who was in time</h2>",
                               "<h2>Why the worst was late</h2>",
                               "<h2>The world</h2>",
                               "<h2>Where the robots went</h2>",
                               "<h2>What a robot did over time</h2>",
                               "<h2>What programs said</h2>",
                               "<h2>Who ran when</h2>",
                               "<h2>Response times against deadlines</h2>",
                               "<h2>The systems</h2>",
                               "<h2>Of the simulation itself</h2>"};
  std::size_t last = 0;
  for (const char* heading : order) {
    const std::size_t at = page.html.find(heading);
    ASSERT_NE(at, std::string::npos) << heading;
    EXPECT_GT(at, last) << heading;
    last = at;
  }
  // Each of them is in the table of contents.
  std::size_t sections = 0, entries = 0;
  for (std::size_t at = 0; (at = page.html.find("<h2>", at)) != std::string::npos; ++at) ++sections;
  for (std::size_t at = 0; (at = page.html.find("<li><a href=", at)) != std::string::npos; ++at)
    ++entries;
  EXPECT_EQ(sections, entries);
}

TEST_F(PageTest, SaysThatAllDeadlinesWereMetOnlyWhereThereAreSome) {
  auto summary = Summary();
  summary["clients"]["r/controller"]["deadline"]["missed"] = 0;
  WriteRun("one");
  Write("one/summary.json", summary.dump());
  EXPECT_TRUE(Has(Make({"one"}), "All 2 deadlines were met. One client has no deadline."));
  summary["clients"]["r/controller"]["deadline"] = nullptr;
  Write("one/summary.json", summary.dump());
  EXPECT_TRUE(Has(Make({"one"}), "No client has a deadline, so none could be missed."));
  summary.erase("verdict");
  Write("one/summary.json", summary.dump());
  EXPECT_TRUE(Has(Make({"one"}), "There is none: the run was made by an earlier version"));
}

TEST_F(PageTest, ExplainsWhatWasLateAndMarksIt) {
  WriteRun("one");
  const Page page = Make({"one"});
  EXPECT_TRUE(
      Has(page, "<li><p>at 0.000 s r/controller answered 4 us late, after 9 us: r/planner"));
  EXPECT_TRUE(Has(page, "\"misses\":[[1,6,11,15,\"at 0.000 s r/controller answered 4 us late"));
}

TEST_F(PageTest, WithoutAWorldItSaysWhyAndDoesNotCarryThreeJs) {
  WriteRun("one");
  std::filesystem::remove(Path("one") + "/bodies.csv");
  const Page page = Make({"one"});
  EXPECT_TRUE(Has(page, "There is none to show"));
  EXPECT_EQ(page.html.find(kThreeJs), std::string::npos);
}

TEST_F(PageTest, OneSampleIsEnough) {
  WriteRun("one", 5, 1);
  const Page page = Make({"one"});
  EXPECT_TRUE(Has(page, "The median distance is 5.00\u00a0m."));
  EXPECT_FALSE(Has(page, "nan"));
  EXPECT_FALSE(Has(page, "inf"));
}

TEST_F(PageTest, ARunWithoutBodiesActivationsAndDispatchesStillHasItsCosts) {
  WriteRun("one");
  for (const char* name : {"bodies.csv", "activations.csv", "dispatches.csv", "responses.csv"}) {
    std::filesystem::remove(Path("one") + "/" + name);
  }
  const Page page = Make({"one"});
  EXPECT_TRUE(Has(page, "Progress came apart by up to 1.00\u00a0ms."));
  EXPECT_TRUE(page.svgs.empty());
  ASSERT_EQ(page.warnings.size(), 1u);
  EXPECT_NE(page.warnings[0].find("the timeline goes without it"), std::string::npos);
}

TEST_F(PageTest, EmptyTablesAreNoValues) {
  WriteRun("one");
  Write("one/bodies.csv", "time_s,body,x_m,y_m,z_m\n");
  Write("one/activations.csv", "client,thread,cause,release_ns,start_ns,end_ns,charged_ns\n");
  EXPECT_FALSE(HasFigure(Make({"one"}), "distances"));
}

TEST_F(PageTest, ASweepHasAFigureAndItsTable) {
  Write("sweep/trials.json",
        R"({"name": "tcs", "first_seed": 1, "trials": 2,
            "vary": {"key": "robots.r.cpu.speed", "values": [0.5, 1, 2]}})");
  for (const char* seed : {"seed-0001", "seed-0002"}) {
    WriteRun(std::string("sweep/0.5/") + seed, 9);
    WriteRun(std::string("sweep/1/") + seed, 6);
    WriteRun(std::string("sweep/2/") + seed, 3);
  }
  const Page page = Make({"sweep"});
  EXPECT_TRUE(HasFigure(page, "sweep-robots.r.cpu.speed"));
  EXPECT_TRUE(
      Has(page,
          "“tcs”: 9.00\u00a0m at robots.r.cpu.speed = 0.5 and 3.00\u00a0m at 2, below 5\u00a0m "
          "first at 2."));
  EXPECT_TRUE(Has(page, "1.00\u00a0ms at each value in tcs"));
}

TEST_F(PageTest, IsWrittenWithItsFiguresOrSaysWhyNot) {
  WriteRun("one");
  const Page page = Make({"one"});
  std::vector<std::string> written;
  EXPECT_EQ(WritePage(page, Path("page.html"), FigureFiles::kSvg, &written), "");
  EXPECT_EQ(written.size(), 1 + page.svgs.size());
  EXPECT_TRUE(std::filesystem::exists(Path("page-distances.svg")));
  EXPECT_NE(WritePage(page, Path("no/folder/page.html"), FigureFiles::kNone, &written)
                .find("page.html cannot be written"),
            std::string::npos);
}

}  // namespace
}  // namespace tcs::report
