#include "coordinator/scenario/yaml_documents.h"

#include <yaml-cpp/emitterstyle.h>
#include <yaml-cpp/eventhandler.h>

#include <sstream>
#include <utility>

namespace tcs {

namespace {

// Notes where what it is told of begins.
class FirstPlace : public YAML::EventHandler {
 public:
  int line() const { return line_; }

  void OnDocumentStart(const YAML::Mark& mark) override { Note(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { NoteNode(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { NoteNode(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    NoteNode(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    NoteNode(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    NoteNode(mark);
  }
  void OnMapEnd() override {}

 private:
  void Note(const YAML::Mark& mark) { line_ = mark.line + 1; }
  // The first thing in a document rather than the line above it.
  void NoteNode(const YAML::Mark& mark) {
    if (!std::exchange(has_node_, true) && !mark.is_null()) Note(mark);
  }

  int line_ = 1;
  bool has_node_ = false;
};

}  // namespace

YamlDocuments LoadDocuments(const std::string& text) {
  YamlDocuments documents;
  documents.first = YAML::Load(text);
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  FirstPlace first, second;
  documents.count += parser.HandleNextDocument(first);
  if (documents.count > 0) documents.count += parser.HandleNextDocument(second);
  documents.second_line = second.line();
  return documents;
}

}  // namespace tcs
