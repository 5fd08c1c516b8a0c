#include "tests/zoo/robots.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace tcs::zoo {
namespace {

namespace fs = std::filesystem;

std::string TextOf(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void Write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

std::vector<Robot> OfFiles() {
  const fs::path models(TCS_MODEL_ZOO);
  return {{"pendulum", TextOf(models / "pendulum.urdf"), true, 2},
          {"every_joint", TextOf(models / "every_joint.urdf"), true, 1},
          {"arm", TextOf(models / "zoo_description/urdf/arm.urdf"), true, 1},
          {"hand", TextOf(models / "hand.urdf"), true, 1, true},
          {"humanoid", TextOf(models / "humanoid.urdf"), false, 1},
          {"rover", TextOf(models / "rover.urdf"), false, 0},
          {"quadruped", TextOf(models / "quadruped.urdf"), false, 0.5},
          {"quadrotor", TextOf(models / "quadrotor.urdf"), false, 1}};
}

std::vector<Robot> All() {
  std::vector<Robot> all;
  for (const auto& some :
       {OfFiles(), Arms(), Bases(), Legged(), Humanoids(), Hands(), Craft(), Machines()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

fs::path UrdfOf(const fs::path& folder, const Robot& robot) {
  return folder / "clone" / (robot.name + "_description") / "urdf" / (robot.name + ".urdf");
}

fs::path WriteScenario(const fs::path& folder, const Robot& robot) {
  const fs::path clone = folder / "clone", shared = clone / "zoo_description";
  if (!fs::exists(shared)) {
    fs::create_directories(clone / ".git");
    fs::copy(fs::path(TCS_MODEL_ZOO) / "zoo_description", shared, fs::copy_options::recursive);
  }
  const std::string package = robot.name + "_description";
  Write(clone / package / "package.xml", "<package><name>" + package + "</name></package>\n");
  const fs::path urdf = UrdfOf(folder, robot);
  Write(urdf, robot.urdf);
  const fs::path scenario = folder / (robot.name + ".yaml");
  Write(scenario,
        fmt::format("duration: 5s\n"
                    "dynamics: {{gravity: [0, 0, -9.81]}}\n"
                    "models:\n"
                    "  robot: {{urdf: {}{}{}, at: {{position: [0, 0, {}]}}}}\n"
                    "  floor: {{plane: [0, 0, 1]}}\n"
                    "robots: {{computer: {{clients: {{idle: {{command: [sleep, \"5\"]}}}}}}}}\n",
                    fs::relative(urdf, folder).string(),
                    robot.has_fixed_base ? ", fixed_base: true" : "",
                    robot.touches_itself ? ", self_collision: true" : "", robot.height_m));
  return scenario;
}

fs::path WriteScenarioOf(const fs::path& folder, const fs::path& urdf) {
  fs::create_directories(folder);
  fs::path scenario = folder / urdf.stem();
  scenario += ".yaml";
  Write(scenario,
        fmt::format("duration: 5s\n"
                    "dynamics: {{gravity: [0, 0, -9.81]}}\n"
                    "models: {{robot: {{urdf: \"{}\", fixed_base: true}}}}\n"
                    "robots: {{computer: {{clients: {{idle: {{command: [sleep, \"5\"]}}}}}}}}\n",
                    fs::absolute(urdf).string()));
  return scenario;
}

}  // namespace tcs::zoo
