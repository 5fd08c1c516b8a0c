#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/fuzz/fuzz.h"
#include "tests/unit/fuzz/mutate.h"
#include "tests/unit/fuzz/try_robot.h"
#include "tests/unit/models/model_folder.h"

namespace tcs::fuzz {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> ModelTokens() {
  std::string deep, entities = "<!DOCTYPE robot [<!ENTITY a \"aaaaaaaaaa\">";
  for (int i = 0; i < 5'000; ++i) deep += "<link name=\"l\">";
  for (char c = 'b'; c < 'k'; ++c) {
    entities += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 8; ++i) entities += std::string("&") + static_cast<char>(c - 1) + ";";
    entities += "\">";
  }
  return {"<",
          ">",
          "/>",
          "\"",
          "'",
          "&",
          "&a;",
          "&#0;",
          "<!--",
          "-->",
          "nan",
          "inf",
          "-1",
          "0",
          "1e308",
          "1e-308",
          "1e999",
          "-0.5",
          "99999999999",
          "0x10",
          "1,5",
          std::string(1, '\0'),
          "\xff",
          "<link name=\"x\"/>",
          "<limit/>",
          "mimic",
          "floating",
          "planar",
          "continuous",
          "prismatic",
          "<mesh filename=\"/dev/zero\"/>",
          "package://",
          "package://../..",
          "<mesh filename=\"package://zoo_description/meshes/wedge.stl\" scale=\"0 1 1\"/>",
          "<parent link=\"x\"/>",
          "<child link=\"base_link\"/>",
          "<![CDATA[",
          "<?xml?>",
          "solid x\n",
          "facet normal 0 0 0\n",
          "v 0 0 0\n",
          "f 1 2 3\n",
          "f -1 9999999 0\n",
          deep,
          entities + "]>"};
}

// The zoo: robots, and the meshes that these are made of.
struct Input {
  std::string kind;  // the end of the file's name
  std::string text;
};
std::vector<Input> Corpus() {
  std::vector<Input> corpus;
  for (const auto& entry : fs::recursive_directory_iterator(TCS_MODEL_ZOO)) {
    if (!entry.is_regular_file()) continue;
    const std::string kind = entry.path().extension();
    if (kind == ".urdf" || kind == ".stl" || kind == ".obj" || kind == ".dae") {
      corpus.push_back({kind, TextOf(entry.path())});
    }
  }
  std::ranges::sort(corpus, {}, &Input::text);  // the folder has no order
  return corpus;
}

}  // namespace

Tally FuzzModels(int count, std::uint64_t seed) {
  const ModelFolder folder;
  const std::vector<Input> corpus = Corpus();
  const std::vector<std::string> tokens = ModelTokens();
  std::vector<std::string> texts;
  for (const Input& input : corpus) texts.push_back(input.text);
  Tally tally;
  for (int number = 0; number < count; ++number) {
    Mutator mutator(seed * 1'000'003 + static_cast<std::uint64_t>(number), tokens);
    const Input& input = corpus[mutator.Below(corpus.size())];
    const std::string text = mutator.Damage(input.text, texts);
    const std::string damaged = folder.Write("damaged" + input.kind, text);
    const std::string urdf =
        input.kind == ".urdf"
            ? damaged
            : folder.Write("robot.urdf",
                           "<robot name=\"r\"><link name=\"l\"><inertial><mass value=\"1\"/>"
                           "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>"
                           "</inertial><collision><geometry><mesh filename=\"damaged" +
                               input.kind + "\"/></geometry></collision></link></robot>");
    const auto wrong = tally.Count([&](bool* refused) {
      return TryRobot(urdf, damaged, VirtualDuration::Milliseconds(100), refused);
    });
    if (wrong.has_value()) SayWrong("models", number, *wrong, text);
  }
  return tally;
}

}  // namespace tcs::fuzz
