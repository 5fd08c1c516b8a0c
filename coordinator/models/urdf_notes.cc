#include "coordinator/models/urdf_notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/errors/visible.h"

namespace tcs {
namespace {

constexpr std::size_t kMostMistakes = 20;
// The most sentences of a kind: a file of 4 MiB has room for many.
constexpr std::size_t kMostListed = 1000;

}  // namespace

std::string UrdfNotes::Placed(int line, std::string_view sentence) const {
  return Visible(fmt::format("{}:{}: {}", path_, line, sentence));
}

void UrdfNotes::AddMistake(int line, std::string_view sentence) {
  if (mistakes_.size() < kMostMistakes) mistakes_.emplace(line, Placed(line, sentence));
}

std::vector<std::string> UrdfNotes::Mistakes() const {
  std::vector<std::string> sentences;
  for (const auto& [line, sentence] : mistakes_) sentences.push_back(sentence);
  return sentences;
}

void UrdfNotes::AddMend(std::string_view kind, int line, std::string_view sentence,
                        double how_bad) {
  auto mend = std::ranges::find(mends_, kind, &Mend::kind);
  if (mend == mends_.end()) {
    mends_.push_back({std::string(kind), {}, 0, how_bad});
    mend = mends_.end() - 1;
  }
  if (mend->sentences.size() == kMostListed) return;
  if (how_bad > mend->how_bad) {
    mend->how_bad = how_bad;
    mend->worst = mend->sentences.size();
  }
  mend->sentences.push_back(Placed(line, sentence));
}

void UrdfNotes::AddWarning(int line, std::string_view sentence) {
  mends_.push_back({"", {Placed(line, sentence)}, 0, 0});
}

void UrdfNotes::Tell(UrdfRemarks* remarks) const {
  for (const Mend& mend : mends_) {
    const std::size_t count = mend.sentences.size();
    std::string sentence = mend.sentences[mend.worst];
    if (count > 1) {
      sentence += fmt::format(" ({} {} such; `tcsim check -v` lists them)",
                              mend.how_bad > 0 ? "the worst of" : "one of", count);
      remarks->details.insert(remarks->details.end(), mend.sentences.begin(), mend.sentences.end());
    }
    remarks->warnings.push_back(std::move(sentence));
  }
}

}  // namespace tcs
