#include "coordinator/compare/side_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "coordinator/report/text.h"

namespace tcs::compare {

namespace {

constexpr std::size_t kMostNamed = 4;

std::string NamedFew(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), kMostNamed);
  std::vector<std::string> few(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown));
  if (shown < names.size()) few.push_back(fmt::format("{} more", names.size() - shown));
  return report::Listed(few);
}

std::string Lasted(const Side& side) {
  return report::Seconds(static_cast<double>(side.duration_ns) * 1e-9);
}

class SideWarnings {
 public:
  SideWarnings(const Side& a, const Side& b) : a_(a), b_(b) {}

  void OfSides() {
    for (const Side* side : {&a_, &b_}) {
      sentences_.insert(sentences_.end(), side->warnings.begin(), side->warnings.end());
    }
    if (a_.scenario != b_.scenario) {
      Add(fmt::format(
          "{} is of the scenario '{}', and {} of '{}': what differs may be the scenario", a_.folder,
          a_.scenario, b_.folder, b_.scenario));
    }
    OfOption("--accounting", a_.accounting, b_.accounting);
    OfOption("--sync", a_.sync, b_.sync);
    // Of a grid the first run says nothing of the others.
    if (a_.duration_ns != b_.duration_ns && a_.keys.empty()) {
      Add(fmt::format(
          "{} lasted {} of virtual time, and {} {}: counts of the longer one are greater",
          a_.folder, Lasted(a_), b_.folder, Lasted(b_)));
    }
  }

  void OfFigures(const std::string& folder, const std::vector<std::string>& names) {
    if (names.empty()) return;
    Add(fmt::format("only {} has {}, which {} not compared", folder, NamedFew(names),
                    names.size() == 1 ? "is" : "are"));
  }

  void OfRarer(const std::vector<std::string>& names) {
    if (names.empty()) return;
    Add(fmt::format(
        "fewer trials of {} than of {} have {}, as where a client never got so far; only "
        "those that have are compared",
        b_.folder, a_.folder, NamedFew(names)));
  }

  void OfCells(const Side& of, const Side& other) {
    std::vector<std::string> missing;
    for (const auto& [label, cell] : of.cells) {
      if (!other.cells.contains(label)) missing.push_back(label);
    }
    if (missing.empty()) return;
    Add(fmt::format("only {} has trials with {}, which are not compared", of.folder,
                    NamedFew(missing)));
  }

  std::vector<std::string> Take() { return std::move(sentences_); }

 private:
  void Add(std::string sentence) { sentences_.push_back(std::move(sentence)); }

  void OfOption(const char* option, const std::string& a, const std::string& b) {
    if (a == b) return;
    Add(fmt::format("{} was made with {} {}, and {} with {}: that alone may be what differs",
                    a_.folder, option, a, b_.folder, b));
  }

  const Side& a_;
  const Side& b_;
  std::vector<std::string> sentences_;
};

}  // namespace

std::vector<std::string> WarningsOf(const Side& a, const Side& b,
                                    const std::vector<std::string>& only_b,
                                    const std::vector<std::string>& rarer) {
  SideWarnings warnings(a, b);
  warnings.OfSides();
  warnings.OfFigures(b.folder, only_b);
  warnings.OfRarer(rarer);
  warnings.OfCells(a, b);
  warnings.OfCells(b, a);
  return warnings.Take();
}

}  // namespace tcs::compare
