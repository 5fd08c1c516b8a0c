// scenario.schema.json, which editors complete by, knows every key that the reader knows, and no
// other: where the reader meets a key that it does not know, it says which it knows there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using Json = nlohmann::json;
using Keys = std::set<std::string>;

constexpr std::string_view kUrdf = R"(<robot name="cart">
  <link name="base"/>
  <link name="hull"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="wheel"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="hull_joint" type="fixed"><parent link="base"/><child link="hull"/></joint>
  <joint name="axle" type="continuous"><parent link="hull"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
</robot>
)";

// A key that is near no other, in every map that there can be: QQ stands for it.
constexpr std::string_view kAllMaps = R"(QQ
duration: 1s
dynamics:
  QQ
  region: {QQ}
  wind: {QQ}
bodies:
  b: {mass: 1, inertia: [1, 1, 1], drag: {QQ}, QQ}
models:
  cart: {urdf: cart.urdf, at: {QQ}, self_collision: true, collisions: {QQ}, rotors: {m: {link: hull, at: {QQ}, thrust: 1, QQ}, n: {link: hull, thrust: 1}}, QQ}
  box: {box: [1, 1, 1], mass: 1, QQ}
  ball: {sphere: 1, mass: 1, QQ}
  can: {cylinder: {radius: 1, length: 1, QQ}, mass: 1, QQ}
  pill: {capsule: {radius: 1, length: 1, QQ}, mass: 1, QQ}
  floor: {plane: [0, 0, 1], QQ}
  rock: {mesh: rock.stl, mass: 1, QQ}
robots:
  r:
    QQ
    cpu: {wakeup: {QQ}, QQ}
    clients:
      c: {command: [./controller], working_directory: {fresh: true, QQ}, outside: {QQ}, QQ}
network: {links: [{between: [r, r], QQ}], QQ}
clock: {qos: {QQ}, QQ}
chains: {e: {from: x, to: push, QQ}}
metrics: {m: {max: b.z, QQ}}
channels:
  x: {type: udp_json, sensors: {bodies: [b], to: "127.0.0.1:47001", noise: {QQ}, bias: {QQ}, QQ}, QQ}
  unix: {type: unix_json, sensors: {bodies: [b], to: a.sock, QQ}}
  pty: {type: pty, sensors: {bodies: [b], device: /dev/ttyUSB0, QQ}}
  dds: {type: dds, sensors: {bodies: [b], message: nav_msgs/msg/Odometry, topic: /o, qos: {QQ}, QQ}}
  joints: {type: udp_json, sensors: {model: cart, to: "127.0.0.1:47002", noise: {QQ}, bias: {QQ}, QQ}}
  imu: {type: dds, sensors: {kind: imu, on: cart/hull, at: {QQ}, topic: /imu, noise: {QQ}, bias: {QQ}, QQ}}
  odometry: {type: dds, sensors: {kind: odometry, on: cart/hull, topic: /t, QQ}}
  wheels: {type: dds, sensors: {kind: wheel_odometry, model: cart, left: axle, right: axle, separation: 1, radius: 1, topic: /w, QQ}}
  tf: {type: dds, sensors: {kind: transforms, model: cart, QQ}}
  tf_static: {type: dds, sensors: {kind: fixed_transforms, model: cart, QQ}}
  description: {type: dds, sensors: {kind: description, model: cart, QQ}}
  lidar: {type: dds, sensors: {kind: lidar, on: cart/hull, topic: /l, noise: {QQ}, bias: {QQ}, QQ}}
  lidar_3d: {type: dds, sensors: {kind: lidar_3d, on: cart/hull, topic: /l3, QQ}}
  range: {type: dds, sensors: {kind: range, on: cart/hull, topic: /r, QQ}}
  depth: {type: dds, sensors: {kind: depth_camera, on: cart/hull, topic: /d, QQ}}
  gnss: {type: dds, sensors: {kind: gnss, on: cart/hull, origin: [0, 0, 0], topic: /g, QQ}}
  compass: {type: dds, sensors: {kind: magnetometer, on: cart/hull, topic: /m, noise: {QQ}, bias: {QQ}, QQ}}
  barometer: {type: dds, sensors: {kind: barometer, on: cart/hull, topic: /b, noise: {QQ}, bias: {QQ}, QQ}}
  contact: {type: dds, sensors: {kind: contact, on: cart/hull, topic: /c, QQ}}
  push: {type: udp_json, commands: {body: b, listen: "127.0.0.1:47003", limits: {QQ}, QQ}}
  pull: {type: pty, commands: {on: cart/hull, device: /dev/ttyUSB1, QQ}}
  turn: {type: dds, commands: {model: cart, joints: [axle], topic: /j, qos: {QQ}, QQ}}
  follow: {type: dds, commands: {model: cart, drive: trajectory, topic: /f, QQ}}
  drive: {type: dds, commands: {model: cart, drive: differential, topic: /v, QQ}}
  motors: {type: dds, commands: {model: cart, rotors: [m, n], topic: /n, QQ}}
)";

Json Schema() { return Json::parse(std::ifstream(TCS_SCHEMA)); }

// What the reader says that it knows, by the map's place: "" is the scenario.
std::map<std::string, Keys> KnownToReader() {
  const ScenarioFolder folder;
  folder.Write("cart.urdf", kUrdf);
  const std::string text =
      std::regex_replace(std::string(kAllMaps), std::regex("QQ"), "QQQQQQQQQQQQQQQQ: 1");
  const auto checked = CheckScenario(folder.Write("s.yaml", text));
  std::map<std::string, Keys> known;
  const std::regex form("unknown key 'Q+'(?: in (\\S+))?; the keys here are (.*)$");
  for (const LoadError& mistake : std::get<std::vector<LoadError>>(checked)) {
    std::smatch parts;
    if (!std::regex_search(mistake.message, parts, form)) continue;
    const std::string list = parts[2].str();
    const std::regex word("[a-z_0-9]+");
    Keys& keys = known[parts[1].str()];
    for (std::sregex_iterator i(list.begin(), list.end(), word), end; i != end; ++i) {
      if (i->str() != "and") keys.insert(i->str());
    }
  }
  return known;
}

class SchemaOfKeys : public testing::Test {
 protected:
  // The map that a value of this schema can be; null: none.
  const Json* MapIn(const Json& node) const {
    if (node.contains("properties") || node.contains("additionalProperties")) return &node;
    if (node.contains("$ref")) {
      return MapIn(schema_.at(Json::json_pointer(node["$ref"].get<std::string>().substr(1))));
    }
    if (node.contains("items")) return MapIn(node["items"]);
    if (!node.contains("anyOf")) return nullptr;
    for (const Json& alternative : node["anyOf"]) {
      if (const Json* map = MapIn(alternative)) return map;
    }
    return nullptr;
  }

  // The map at "robots.r.cpu".
  const Json* MapAt(const std::string& path) const {
    const Json* map = &schema_;
    std::istringstream names(path);
    for (std::string name; map != nullptr && std::getline(names, name, '.');) {
      const Json& all = *map;
      name = name.substr(0, name.find('['));  // an element of a list
      if (all.contains("properties") && all["properties"].contains(name)) {
        map = MapIn(all["properties"][name]);
      } else if (all.contains("additionalProperties") && all["additionalProperties"].is_object()) {
        map = MapIn(all["additionalProperties"]);
      } else {
        map = nullptr;
      }
    }
    return map;
  }

  void FindMaps(const Json& node, std::set<const Json*>* maps) const {
    if (node.is_object() && node.contains("properties") && node["properties"].is_object()) {
      maps->insert(&node);
    }
    if (node.is_structured()) {
      for (const Json& part : node) FindMaps(part, maps);
    }
  }

  const Json schema_ = Schema();
};

TEST_F(SchemaOfKeys, IsTheReaders) {
  std::map<const Json*, Keys> read;
  std::map<const Json*, std::string> paths;
  for (const auto& [path, keys] : KnownToReader()) {
    const Json* map = MapAt(path);
    ASSERT_NE(map, nullptr) << "the schema has no map at " << path;
    read[map].insert(keys.begin(), keys.end());
    paths[map] = path;
  }
  for (const auto& [map, keys] : read) {
    Keys written;
    for (const auto& [key, value] : map->at("properties").items()) written.insert(key);
    EXPECT_EQ(written, keys) << "at '" << paths[map] << "' of scenario.schema.json";
    EXPECT_EQ(map->value("additionalProperties", true), false) << paths[map];
  }
  std::set<const Json*> all;
  FindMaps(schema_, &all);
  for (const Json* map : all) {
    EXPECT_TRUE(read.contains(map)) << "the reader does not know this map of the schema: "
                                    << map->value("description", map->dump().substr(0, 80));
  }
}

}  // namespace
}  // namespace tcs
