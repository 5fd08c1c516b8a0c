// The notes about a robot's file: all its mistakes, and what was mended, by kind.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tcs {

// Remarks for the reader of the file.
struct UrdfRemarks {
  std::vector<std::string> warnings;  // a sentence for each kind of thing
  // A sentence for each thing by itself, of the kinds that have several.
  std::vector<std::string> details;
};

class UrdfNotes {
 public:
  explicit UrdfNotes(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }

  // Something that has no meaning; the file is refused in the end. 20 mistakes are kept.
  void AddMistake(int line, std::string_view sentence);
  // "PATH:LINE: SENTENCE", in the order of the lines.
  std::vector<std::string> Mistakes() const;
  bool HasMistakes() const { return !mistakes_.empty(); }

  // Something that was mended or left out. Of one `kind` a single sentence is said, the worst one:
  // the first with the largest `how_bad`.
  void AddMend(std::string_view kind, int line, std::string_view sentence, double how_bad = 0);
  // Adds a sentence of its own.
  void AddWarning(int line, std::string_view sentence);

  // Adds the sentences to the end of `remarks`.
  void Tell(UrdfRemarks* remarks) const;

 private:
  struct Mend {
    std::string kind;
    std::vector<std::string> sentences;
    std::size_t worst = 0;
    double how_bad = 0;
  };

  std::string Placed(int line, std::string_view sentence) const;

  const std::string path_;
  std::multimap<int, std::string> mistakes_;  // by line
  std::vector<Mend> mends_;                   // in the order in which the kinds came
};

}  // namespace tcs
