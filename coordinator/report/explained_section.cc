// Why the worst was late, as `tcsim explain` says it.
#include <fmt/format.h>

#include <algorithm>

#include "coordinator/explain/explanation.h"
#include "coordinator/report/answer_sections.h"
#include "coordinator/report/text.h"
#include "coordinator/text/spoken.h"

namespace tcs::report {

namespace {

constexpr std::size_t kWorst = 5;

// A link that opens the timeline there, with as much on both sides.
std::string LinkTo(std::int64_t from_ns, std::int64_t to_ns) {
  const double from = static_cast<double>(from_ns) * 1e-9, to = static_cast<double>(to_ns) * 1e-9;
  const double around = std::max((to - from) / 2, 1e-4);
  return fmt::format("<a href=\"#t={:.6f}-{:.6f}\">Show {:.3f} s in the timeline</a>",
                     std::max(0.0, from - around), to + around, from);
}

std::string Bars(const std::vector<explain::Part>& parts) {
  std::int64_t whole = 1;
  for (const explain::Part& part : parts) whole += part.ns;
  std::string items;
  for (const explain::Part& part : parts) {
    items += fmt::format(
        "<li><span class=\"n\">{}</span><span class=\"bar\" aria-hidden=\"true\"><i "
        "style=\"width:{:.1f}%\"></i></span><span>{}</span></li>\n",
        Escaped(Spoken(part.ns)), 100 * static_cast<double>(part.ns) / static_cast<double>(whole),
        Escaped(part.what));
  }
  return "<ul class=\"parts\">\n" + items + "</ul>\n";
}

std::string Item(const std::string& sentence, const std::string& more, const std::string& parts) {
  return fmt::format("<li><p>{}. {}</p>\n{}</li>\n", Escaped(sentence), more, parts);
}

// The item of one activation of `all`.
std::string ActivationItem(const explain::Told& told,
                           const std::vector<const explain::Activation*>& all,
                           const explain::Activation& one) {
  std::string behind;
  if (const explain::Activation* first = explain::QueuedBehind(told, one)) {
    const auto listed = std::ranges::find(all, first);
    behind = fmt::format("<p class=\"behind\">The queue goes back to {}.</p>\n",
                         listed != all.end()
                             ? fmt::format("number {} of these", listed - all.begin() + 1)
                             : "this: " + Escaped(explain::SentenceOn(*first, told.clients)));
  }
  return Item(explain::SentenceOn(one, told.clients), LinkTo(one.release_ns, one.end_ns),
              Bars(explain::PartsOf(one, told.clients)) + behind);
}

std::string ItemsOf(const explain::Told& told) {
  std::string items;
  auto worst = explain::Choose(told, {.client = "", .at_ns = {}, .most = kWorst});
  std::erase_if(worst, [](const explain::Activation* one) { return one->LateNs() <= 0; });
  for (const explain::Activation* one : worst) items += ActivationItem(told, worst, *one);
  for (const auto& [name, chain] : told.chains) {
    if (chain.missed == 0 || chain.worst.empty()) continue;
    const explain::ChainCase& oldest = chain.worst.front();
    items += Item(explain::SentenceOn(name, chain, oldest),
                  LinkTo(oldest.sampled_ns, oldest.acts_ns), Bars(explain::PartsOf(oldest)));
  }
  return items;
}

}  // namespace

std::string ExplainedHtml(const Results& results, const std::vector<ToldOf>& all) {
  std::string html;
  for (const ToldOf& of : all) {
    if (!of.told.has_value()) continue;
    const std::string items = ItemsOf(*of.told);
    if (items.empty()) continue;
    if (results.systems.size() > 1)
      html += fmt::format("<p class=\"of-system\">{}</p>\n", Escaped(Quoted(of.system->name)));
    html += "<ol class=\"explained\">\n" + items + "</ol>\n";
  }
  return html;
}

}  // namespace tcs::report
