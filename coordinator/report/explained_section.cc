// Why the worst was late: what `tcsim explain` says of it.
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
  return fmt::format("<a href=\"#t={:.6f}-{:.6f}\">show it in the timeline</a>",
                     std::max(0.0, from - around), to + around);
}

std::string Bars(const std::vector<explain::Part>& parts) {
  std::int64_t whole = 1;
  for (const explain::Part& part : parts) whole += part.ns;
  std::string items;
  for (const explain::Part& part : parts) {
    items += fmt::format(
        "<li><span class=\"n\">{}</span><span class=\"bar\" aria-hidden=\"true\"><i "
        "style=\"width:{:.1f}%\"></i></span><span>{}</span></li>\n",
        Escaped(Spoken(part.ns)),
        100 * static_cast<double>(part.ns) / static_cast<double>(whole), Escaped(part.what));
  }
  return "<ul class=\"parts\">\n" + items + "</ul>\n";
}

std::string Item(const std::string& sentence, const std::string& more, const std::string& parts) {
  return fmt::format("<li><p>{}. {}</p>\n{}</li>\n", Escaped(sentence), more, parts);
}

std::string ActivationItem(const explain::Told& told, const explain::Activation& one) {
  std::string behind;
  if (const explain::Activation* first = explain::QueuedBehind(told, one)) {
    behind = fmt::format("<p class=\"behind\">The queue goes back to this: {}.</p>\n",
                         Escaped(explain::SentenceOn(*first, told.clients)));
  }
  return Item(explain::SentenceOn(one, told.clients), LinkTo(one.release_ns, one.end_ns),
              Bars(explain::PartsOf(one, told.clients)) + behind);
}

std::string ItemsOf(const explain::Told& told) {
  std::string items;
  for (const explain::Activation* one : explain::Choose(told, {.client = "", .at_ns = {}, .most = kWorst})) {
    if (one->LateNs() > 0) items += ActivationItem(told, *one);
  }
  for (const auto& [name, chain] : told.chains) {
    if (chain.missed == 0 || chain.worst.empty()) continue;
    const explain::ChainCase& worst = chain.worst.front();
    items += Item(explain::SentenceOn(name, chain, worst),
                  LinkTo(worst.sampled_ns, worst.acts_ns), Bars(explain::PartsOf(worst)));
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
