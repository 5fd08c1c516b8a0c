#include "tests/zoo/robots.h"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/fuzz/fuzz.h"
#include "tests/unit/fuzz/mutate.h"
#include "tests/unit/fuzz/try_robot.h"
#include "tests/unit/models/model_folder.h"

namespace tcs::fuzz {
namespace {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;

// What draughtsmen and exporters leave behind.
constexpr std::array<std::string_view, 11> kNumbers = {
    "0", "-0", "1e-22", "1e-15", "1e-9", "1e-4", "1", "3.14159", "1000", "1e6", "1e15"};
constexpr std::array<std::string_view, 6> kTypes = {"fixed",     "revolute", "continuous",
                                                    "prismatic", "planar",   "floating"};

void Collect(XMLElement* element, std::vector<XMLElement*>* all) {
  all->push_back(element);
  for (XMLElement* e = element->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    Collect(e, all);
  }
}

// One of its words becomes another number.
std::string WithAnother(std::string_view text, Mutator* mutator) {
  const std::string number(kNumbers[mutator->Below(kNumbers.size())]);
  std::vector<std::string> words = {""};
  for (const char c : text) {
    if (c == ' ') words.emplace_back();
    if (c != ' ') words.back() += c;
  }
  std::string& word = words[mutator->Below(words.size())];
  // The same, and as many times as large, are likelier to be taken.
  const double value = std::strtod(word.c_str(), nullptr);
  constexpr std::array<double, 6> kTimes = {-1, 1e-6, 1e-3, 0.5, 30, 1e4};
  word = mutator->OneIn(2) ? number : std::to_string(value * kTimes[mutator->Below(kTimes.size())]);
  std::string joined;
  for (const std::string& each : words) joined += (joined.empty() ? "" : " ") + each;
  return joined;
}

void Change(tinyxml2::XMLDocument* robot, Mutator* mutator) {
  std::vector<XMLElement*> all;
  Collect(robot->RootElement(), &all);
  XMLElement* element = all[mutator->Below(all.size())];
  std::vector<const XMLAttribute*> attributes;
  for (const XMLAttribute* a = element->FirstAttribute(); a != nullptr; a = a->Next()) {
    attributes.push_back(a);
  }
  if (element == robot->RootElement()) return;
  if (attributes.empty() || mutator->OneIn(20)) {
    // Elements within others, and few of those that stand for themselves.
    const bool has_name = element->Parent() == robot->RootElement();
    if (mutator->OneIn(has_name ? 20 : 4)) element->Parent()->DeleteChild(element);
    return;
  }
  const XMLAttribute& attribute = *attributes[mutator->Below(attributes.size())];
  const std::string name = attribute.Name();
  if (mutator->OneIn(10)) {
    element->DeleteAttribute(name.c_str());
  } else if (name == "type") {
    element->SetAttribute("type", kTypes[mutator->Below(kTypes.size())].data());
  } else if (name == "name" || name == "link" || name == "joint") {
    // That of another part; seldom, since few such robots are taken.
    const char* other = all[mutator->Below(all.size())]->Attribute("name");
    if (other != nullptr && mutator->OneIn(4)) {
      element->SetAttribute(name.c_str(), std::string(other).c_str());
    }
  } else if (name != "filename") {
    element->SetAttribute(name.c_str(), WithAnother(attribute.Value(), mutator).c_str());
  }
}

}  // namespace

Tally FuzzRobots(int count, std::uint64_t seed) {
  const ModelFolder folder;
  const std::vector<zoo::Robot> robots = zoo::All();
  Tally tally;
  for (int number = 0; number < count; ++number) {
    Mutator mutator(seed * 1'000'003 + static_cast<std::uint64_t>(number), {});
    tinyxml2::XMLDocument robot;
    robot.Parse(robots[mutator.Below(robots.size())].urdf.c_str());
    for (std::size_t changes = 1 + mutator.Below(5); changes > 0; --changes) {
      Change(&robot, &mutator);
    }
    tinyxml2::XMLPrinter printer;
    robot.Print(&printer);
    const std::string path = folder.Write("damaged.urdf", printer.CStr());
    const auto wrong = tally.Count([&](bool* refused) {
      return TryRobot(path, path, VirtualDuration::Milliseconds(200), refused);
    });
    if (wrong.has_value()) SayWrong("robots", number, *wrong, printer.CStr());
  }
  return tally;
}

}  // namespace tcs::fuzz
