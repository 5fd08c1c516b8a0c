#include "coordinator/models/urdf_grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "coordinator/errors/nearest.h"
#include "coordinator/errors/visible.h"
#include "coordinator/models/urdf_friction.h"
#include "coordinator/models/urdf_rules.h"
#include "coordinator/models/urdf_xml.h"

namespace tcs {
namespace {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

using urdf_rules::Attribute;
using urdf_rules::Child;
using urdf_rules::Kind;
using urdf_rules::kJoint;
using urdf_rules::kLink;
using urdf_rules::kRobot;
using urdf_rules::Rule;

bool HasName(const Rule& rule) { return &rule == &kRobot || &rule == &kLink || &rule == &kJoint; }

// Whether the attribute is about XML, or says what is so anyway.
bool IsLeftOutSilently(const Rule& rule, const XMLAttribute& attribute) {
  const std::string_view name = attribute.Name();
  if (name.starts_with("xmlns") || name.starts_with("xml:")) return true;
  return &rule == &kRobot && name == "version" && std::string_view(attribute.Value()) == "1.0";
}

std::optional<double> NumberOf(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

std::vector<std::string_view> WordsOf(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = text.find_first_not_of(kSpace);
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(text.find_first_of(kSpace, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
}

class Copy {
 public:
  explicit Copy(UrdfNotes* notes) : notes_(*notes) {}

  // Copies `from` into `to`, as deep as the rules are.
  void Take(const Rule& rule, const XMLElement& from, XMLElement* to) {
    to->SetUserData(const_cast<XMLElement*>(&from));  // nothing changes it
    TakeAttributes(rule, from, to);
    std::map<std::string_view, const XMLElement*> first;
    std::map<std::string_view, int> counts;
    for (const XMLElement* child = from.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const Child* known = Find(rule, child->Name());
      if (known == nullptr) {
        LeaveOut(rule, *child);
        continue;
      }
      const XMLElement* earlier = first.try_emplace(known->rule->name, child).first->second;
      if (++counts[known->rule->name] > known->most) {
        const std::string name = known->rule->name;
        notes_.AddMend("second " + name, child->GetLineNum(),
                       fmt::format("{} has a second <{}>, which is left out; the first is on line "
                                   "{}",
                                   OwnerOf(from), name, earlier->GetLineNum()));
        continue;
      }
      Take(*known->rule, *child, to->InsertNewChildElement(known->rule->name));
    }
    CheckCounts(rule, from, counts);
  }

  // Called once, at the end.
  void SayWhatWasLeftOut() {
    for (const std::string& what : order_) {
      const LeftOut& left_out = left_out_.at(what);
      const int more = left_out.count - 1;
      const std::string also =
          more == 0 ? ""
                    : fmt::format(", as {} {} more of its kind", more == 1 ? "is" : "are", more);
      notes_.AddWarning(left_out.line, fmt::format("{} is not understood and left out{}{}", what,
                                                   also, left_out.hint));
    }
  }

 private:
  struct LeftOut {
    int line = 0;
    int count = 0;
    std::string hint;
  };

  void Fail(const XMLElement& element, std::string_view sentence) {
    notes_.AddMistake(element.GetLineNum(), sentence);
  }

  static const Child* Find(const Rule& rule, std::string_view name) {
    for (const Child& child : rule.children) {
      if (child.rule->name == name) return &child;
    }
    return nullptr;
  }

  void TakeAttributes(const Rule& rule, const XMLElement& from, XMLElement* to) {
    for (const XMLAttribute* a = from.FirstAttribute(); a != nullptr; a = a->Next()) {
      const auto known = std::find_if(
          rule.attributes.begin(), rule.attributes.end(),
          [&](const Attribute& each) { return std::string_view(each.name) == a->Name(); });
      if (known != rule.attributes.end()) {
        if (const auto value = Value(rule, *known, from, *a)) {
          to->SetAttribute(known->name, value->c_str());
        }
      } else if (!IsLeftOutSilently(rule, *a)) {
        std::vector<std::string> names;
        for (const Attribute& each : rule.attributes) names.emplace_back(each.name);
        Note(fmt::format("the attribute {} of <{}>", Quoted(a->Name()), rule.name), a->GetLineNum(),
             Nearest(a->Name(), names));
      }
    }
    for (const Attribute& needed : rule.attributes) {
      if (!needed.is_needed || from.Attribute(needed.name) != nullptr) continue;
      if (HasName(rule)) {
        Fail(from,
             fmt::format("this <{0}> has no {1}; write <{0} {1}=\"…\">", rule.name, needed.name));
        continue;
      }
      Fail(from, fmt::format("<{0}> in {1} has no {2}; write <{0} {2}=\"…\">", rule.name,
                             OwnerOf(from), needed.name));
    }
  }

  // None: a mistake.
  std::optional<std::string> Value(const Rule& rule, const Attribute& attribute,
                                   const XMLElement& from, const XMLAttribute& value) {
    const std::string_view text = value.Value();
    const auto mistake = [&](std::string_view what) -> std::optional<std::string> {
      notes_.AddMistake(value.GetLineNum(),
                        fmt::format("{} of <{}> in {} is {}; it must be {}", attribute.name,
                                    rule.name, OwnerOf(from), Quoted(text), what));
      return std::nullopt;
    };
    switch (attribute.kind) {
      case Kind::kName:
        return Name(attribute, from, value);
      case Kind::kFile:
        if (text.empty()) return mistake("the path of a file");
        return std::string(text);
      case Kind::kNumber:
      case Kind::kNotNegative: {
        const std::vector<std::string_view> words = WordsOf(text);
        const auto number = words.size() == 1 ? NumberOf(words[0]) : std::nullopt;
        if (!number) return mistake("a finite number");
        if (attribute.kind == Kind::kNotNegative && !(*number >= 0)) return mistake("0 or more");
        return fmt::format("{}", *number);
      }
      case Kind::kThree:
      case Kind::kThreeNotNegative:
        break;
    }
    std::string three;
    const std::vector<std::string_view> words = WordsOf(text);
    if (words.size() != 3) return mistake("three numbers, like \"0 0 1\"");
    for (const std::string_view word : words) {
      const auto number = NumberOf(word);
      if (!number) return mistake("three finite numbers, like \"0 0 1\"");
      if (attribute.kind == Kind::kThreeNotNegative && !(*number >= 0)) {
        return mistake("three numbers of 0 or more");
      }
      three += fmt::format("{}{}", three.empty() ? "" : " ", *number);
    }
    return three;
  }

  // Names become names of files, topics and columns.
  std::optional<std::string> Name(const Attribute& attribute, const XMLElement& from,
                                  const XMLAttribute& value) {
    constexpr std::size_t kLongest = 256;
    const std::string_view text = value.Value();
    if (text.empty() && !attribute.is_needed) return std::nullopt;
    const bool fits = text.find_first_of(",\"") == std::string_view::npos && Visible(text) == text;
    if (text.empty() || text.size() > kLongest || !fits) {
      notes_.AddMistake(
          value.GetLineNum(),
          fmt::format("{} of <{}> is {}; it must be a name of 1 to {} bytes that can be shown, "
                      "without commas and quotes",
                      attribute.name, from.Name(), Quoted(text), kLongest));
      return std::nullopt;
    }
    return std::string(text);
  }

  void CheckCounts(const Rule& rule, const XMLElement& from,
                   const std::map<std::string_view, int>& counts) {
    for (const Child& child : rule.children) {
      if (counts.contains(child.rule->name) || child.least == 0) continue;
      Fail(from, fmt::format("{} has no <{}>; add it",
                             HasName(rule) ? OwnerOf(from)
                                           : fmt::format("<{}> in {}", rule.name, OwnerOf(from)),
                             child.rule->name));
    }
    if (!rule.has_one_child || counts.size() == 1) return;
    std::vector<std::string> names;
    for (const Child& child : rule.children) names.emplace_back(child.rule->name);
    const XMLElement* inside = from.FirstChildElement();
    if (counts.size() > 1) {
      Fail(from, fmt::format("<{}> in {} holds more than one shape; give each a <collision> of its "
                             "own",
                             rule.name, OwnerOf(from)));
      return;
    }
    Fail(inside == nullptr ? from : *inside,
         fmt::format(
             "<{}> in {} {}; {}", rule.name, OwnerOf(from),
             inside == nullptr ? "is empty" : "has the unknown shape " + Quoted(inside->Name()),
             Suggest(inside == nullptr ? "" : inside->Name(), names, "shapes")));
  }

  void LeaveOut(const Rule& rule, const XMLElement& child) {
    const std::string_view name = child.Name();
    for (const char* silently : rule.left_out_silently) {
      if (name == silently) return;
    }
    if (rule.has_one_child) return;  // CheckCounts says what is wrong
    if ((name == "gazebo" || name == "contact") && IsOnlyFriction(child)) return;
    std::vector<std::string> names;
    for (const Child& each : rule.children) names.emplace_back(each.rule->name);
    Note("<" + Quoted(name).substr(1, Quoted(name).size() - 2) + ">", child.GetLineNum(),
         Nearest(name, names));
  }

  void Note(const std::string& what, int line, const std::optional<std::string>& nearest) {
    constexpr std::size_t kMost = 50;
    const auto [entry, is_new] = left_out_.try_emplace(what);
    ++entry->second.count;
    if (!is_new) return;
    if (left_out_.size() > kMost) {
      left_out_.erase(entry);
      return;
    }
    entry->second.line = line;
    if (nearest) entry->second.hint = "; did you mean '" + *nearest + "'?";
    order_.push_back(what);
  }

  UrdfNotes& notes_;
  std::map<std::string, LeftOut> left_out_;
  std::vector<std::string> order_;
};

}  // namespace

std::unique_ptr<XMLDocument> UnderstoodPart(const XMLDocument& document, UrdfNotes* notes) {
  auto understood = std::make_unique<XMLDocument>();
  XMLElement* root = understood->NewElement(kRobot.name);
  understood->InsertEndChild(root);
  Copy copy(notes);
  copy.Take(kRobot, *document.RootElement(), root);
  copy.SayWhatWasLeftOut();
  return understood;
}

int LineOf(const XMLElement& understood) {
  for (const XMLElement* e = &understood; e != nullptr; e = e->Parent()->ToElement()) {
    if (const auto* from = static_cast<const XMLElement*>(e->GetUserData())) {
      return from->GetLineNum();
    }
  }
  return 1;
}

std::string OwnerOf(const XMLElement& element) {
  const XMLElement* root = element.GetDocument()->RootElement();
  const XMLElement* top = &element;
  while (top != root && top->Parent() != root) top = top->Parent()->ToElement();
  const char* name = top->Attribute("name");
  if (top == root || name == nullptr) return "the robot";
  return fmt::format("{} {}", top->Name(), Quoted(name));
}

}  // namespace tcs
