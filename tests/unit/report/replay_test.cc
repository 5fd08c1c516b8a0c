#include "coordinator/report/replay.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "coordinator/report/replay_sections.h"
#include "tests/unit/report/result_folder.h"

namespace tcs::report {
namespace {

using nlohmann::json;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pointwise;
using testing::SizeIs;

constexpr const char* kBodiesHead =
    "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps\n";

json Link(const char* name, const char* kind = nullptr, int parent = -1, double x = 0) {
  json link{{"name", name}, {"shapes", json::array()}, {"visuals", json::array()}};
  if (kind != nullptr) {
    link["kind"] = kind;
    link["parent"] = parent;
    link["joint"] = std::string(name).substr(std::string(name).find('/') + 1) + "_joint";
    link["pose"] = {x, 0, 0, 0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // a quarter turn about z
  }
  return link;
}
json Box(double x) {
  return {{"kind", "box"}, {"size", {1, 1, 1}}, {"pose", {x, 0, 0, 0, 0, 0, 1}}};
}
json Scene() {
  return {{"version", 1},
          {"region_m", nullptr},
          {"bodies", json::array()},
          {"fixtures", json::array()},
          {"models", json::array()},
          {"sensors", json::array()},
          {"meshes", json::array()}};
}

// The numbers of a track or a signal, as the page reads them.
std::vector<std::int64_t> Decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((have += 6) >= 8) bytes += static_cast<char>(bits >> (have -= 8) & 255);
  }
  std::vector<std::int64_t> numbers;
  std::uint64_t value = 0;
  int shift = 0;
  for (const char c : bytes) {
    value |= static_cast<std::uint64_t>(c & 127) << shift;
    shift += 7;
    if (c & 128) continue;
    numbers.push_back(static_cast<std::int64_t>(value >> 1) ^
                      -static_cast<std::int64_t>(value & 1));
    value = 0;
    shift = 0;
  }
  return numbers;
}

class ReplayTest : public ResultFolderTest {
 protected:
  void State(double time_s, const char* body, double x, double qw = 1, double vx = 0) {
    bodies_ += fmt::format("{:.9f},{},{},0,0,0,0,{},{},{},0,0,0,0,0\n", time_s, body, x,
                           std::sqrt(1 - qw * qw), qw, vx);
  }
  Replay Read(double end_s = 1, std::size_t room = kRoom) {
    Write("run/bodies.csv", bodies_);
    auto read = ReadReplay(Path("run"), "run", end_s, room, &warnings_);
    EXPECT_TRUE(std::holds_alternative<Replay>(read)) << std::get<LoadError>(read).message;
    return std::get<Replay>(std::move(read));
  }
  std::string bodies_ = kBodiesHead;
  std::vector<std::string> warnings_;
};

TEST_F(ReplayTest, HasFiftyMomentsASecond) {
  for (int i = 0; i <= 100; ++i) State(i * 0.01, "a", i);
  const Replay replay = Read();
  ASSERT_THAT(replay.time_s, SizeIs(51));
  EXPECT_NEAR(replay.time_s[50], 1.0, 1e-12);
  EXPECT_EQ(replay.tracks[0].poses[50][0], 100);
}

TEST_F(ReplayTest, HasAsManyMomentsAsThereIsRoomFor) {
  json scene = Scene();
  for (int body = 0; body < 10; ++body) {
    const std::string name = "b" + std::to_string(body);
    scene["bodies"].push_back({{"name", name}, {"mass_kg", 1}, {"inertia_kgm2", {0.1, 0.1, 0.1}}});
    for (int i = 0; i <= 100; ++i) State(i * 0.01, name.c_str(), i * 0.1 + body);
  }
  // The file has them in the order of time.
  std::vector<std::string> lines;
  std::istringstream text(bodies_.substr(bodies_.find('\n') + 1));
  for (std::string line; std::getline(text, line);) lines.push_back(line + "\n");
  std::stable_sort(lines.begin(), lines.end(), [](const std::string& a, const std::string& b) {
    return a.substr(0, 11) < b.substr(0, 11);
  });
  bodies_ = kBodiesHead;
  for (const std::string& line : lines) bodies_ += line;
  Write("run/scene.json", scene.dump());
  EXPECT_THAT(Read().time_s, SizeIs(51));
  const Replay small = Read(1, 4000);
  EXPECT_GE(small.time_s.size(), 8u);
  EXPECT_LT(small.time_s.size(), 20u);
  EXPECT_LT(Encoded(small).size(), 4000u * 4 / 3 + 10 * 400);
}

TEST_F(ReplayTest, WhatIsFixedToALinkMovesWithIt) {
  json scene = Scene();
  json base = Link("cart/base"), mast = Link("cart/mast", "fixed", 0, 2),
       top = Link("cart/top", "fixed", 1, 3), wheel = Link("cart/wheel", "continuous", 0, 1);
  base["shapes"].push_back(Box(0));
  top["shapes"].push_back(Box(1));
  wheel["shapes"].push_back(Box(0));
  scene["models"] = {
      {{"name", "cart"}, {"root", 0}, {"fixed_base", false}, {"links", {base, mast, top, wheel}}}};
  scene["sensors"] = {{{"link", "cart/top"}, {"pose", {0, 0, 0, 0, 0, 0, 1}}}};
  Write("run/scene.json", scene.dump());
  for (const char* link : {"cart/base", "cart/mast", "cart/top", "cart/wheel"}) State(0, link, 5);
  Replay replay = Read();
  ASSERT_THAT(replay.tracks, SizeIs(2));
  EXPECT_EQ(replay.tracks[0].name, "cart/base");
  EXPECT_EQ(replay.tracks[1].name, "cart/wheel");
  ASSERT_THAT(replay.robots, SizeIs(1));
  const json shapes = replay.scene["tracks"][0];
  ASSERT_THAT(shapes, SizeIs(2));
  // Two metres along x, a quarter turn, three along the new x, another quarter turn, one along it.
  const auto pose = shapes[1]["pose"].get<std::vector<double>>();
  const double wanted[] = {1, 3, 0, 0, 0, 1, 0};
  EXPECT_THAT(pose, Pointwise(DoubleNear(1e-12), wanted));
  EXPECT_EQ(replay.scene["sensors"][0]["track"], 0);
  EXPECT_NEAR(replay.scene["sensors"][0]["pose"][1].get<double>(), 3, 1e-12);
}

TEST_F(ReplayTest, LooksAreShownRatherThanWhatCollides) {
  json scene = Scene();
  json drawn = Link("a"), with_mesh = Link("b");
  drawn["shapes"].push_back(Box(1));
  drawn["visuals"].push_back({{"kind", "sphere"}, {"radius", 2}, {"pose", {0, 0, 0, 0, 0, 0, 1}}});
  with_mesh["shapes"].push_back(Box(1));
  with_mesh["visuals"].push_back({{"kind", "mesh_file"},
                                  {"name", "b.stl"},
                                  {"pose", {0, 0, 0, 0, 0, 0, 1}},
                                  {"colour", {1, 0, 0, 1}}});
  scene["models"] = {{{"name", "a"}, {"root", 0}, {"fixed_base", false}, {"links", {drawn}}},
                     {{"name", "b"}, {"root", 0}, {"fixed_base", false}, {"links", {with_mesh}}}};
  Write("run/scene.json", scene.dump());
  State(0, "a", 0);
  State(0, "b", 0);
  const Replay replay = Read();
  EXPECT_EQ(replay.scene["tracks"][0][0]["kind"], "sphere");
  EXPECT_EQ(replay.scene["tracks"][1][0]["kind"], "box");
  EXPECT_EQ(replay.scene["tracks"][1][0]["colour"][0], 1);
}

TEST_F(ReplayTest, MeshesThatAreOnlyLooksAreReadOnce) {
  Write("run/roof.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 1\nf 1 2 4\nf 2 3 4\n");
  const auto mesh = [&](const std::string& file, double scale) {
    return json{{"kind", "mesh_file"},           {"name", "package://it/" + file},
                {"path", Path("run/" + file)},   {"scale", {scale, scale, scale}},
                {"pose", {0, 0, 3, 0, 0, 0, 1}}, {"colour", {0, 1, 0, 1}}};
  };
  json scene = Scene();
  const auto add = [&](const char* name, const json& visual) {
    json link = Link(name);
    link["shapes"].push_back(Box(1));
    link["visuals"].push_back(visual);
    scene["models"].push_back(
        {{"name", name}, {"root", 0}, {"fixed_base", false}, {"links", {link}}});
    State(0, name, 0);
  };
  add("a", mesh("roof.obj", 1));
  add("b", mesh("roof.obj", 1));
  add("c", mesh("roof.obj", -0.5));
  add("d", mesh("gone.obj", 1));
  Write("run/scene.json", scene.dump());
  const Replay replay = Read();
  const json tracks = replay.scene["tracks"];
  EXPECT_EQ(tracks[0][0]["kind"], "mesh");
  EXPECT_EQ(tracks[0][0]["pose"][2], 3);
  EXPECT_EQ(tracks[0][0]["colour"][1], 1);
  EXPECT_FALSE(tracks[0][0].contains("path")) << "nobody needs to know where it was";
  EXPECT_EQ(tracks[1][0]["mesh"], tracks[0][0]["mesh"]);
  EXPECT_NE(tracks[2][0]["mesh"], tracks[0][0]["mesh"]);
  EXPECT_EQ(tracks[3][0]["kind"], "box") << "what collides, for one that is not there";
  ASSERT_THAT(replay.scene["meshes"], SizeIs(2));
  const json first = replay.scene["meshes"][0];
  std::vector<double> corners;
  std::array<std::int64_t, 3> sums{};
  for (const std::int64_t number : Decoded(first["vertices"])) {
    const std::size_t axis = corners.size() % 3;
    sums[axis] += number;
    corners.push_back(first["least"][axis].get<double>() +
                      static_cast<double>(sums[axis]) * first["step"][axis].get<double>());
  }
  const double wanted[] = {0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 2, 0};
  EXPECT_THAT(corners, Pointwise(DoubleNear(1e-4), wanted));
  EXPECT_THAT(Decoded(first["triangles"]), ElementsAre(0, 1, 1, -1, 2, -1));
  // A mirror turns them round.
  EXPECT_THAT(Decoded(replay.scene["meshes"][1]["triangles"]), ElementsAre(0, 2, -1, 0, 1, 1));
}

TEST_F(ReplayTest, ABodyLooksLikeABoxOfItsMoments) {
  json scene = Scene();
  // Of 12 kg, 1 m by 2 m by 3 m.
  scene["bodies"] = {{{"name", "a"}, {"mass_kg", 12}, {"inertia_kgm2", {13, 10, 5}}}};
  Write("run/scene.json", scene.dump());
  State(0, "a", 0);
  const auto size = Read().scene["tracks"][0][0]["size"].get<std::vector<double>>();
  const double wanted[] = {1, 2, 3};
  EXPECT_THAT(size, Pointwise(DoubleNear(1e-12), wanted));
}

TEST_F(ReplayTest, WithoutASceneAllBodiesAreShown) {
  State(0, "a", 1);
  State(0, "b", 2);
  State(0.02, "a", 3);
  State(0.02, "b", 2);
  const Replay replay = Read();
  ASSERT_THAT(replay.robots, SizeIs(2));
  EXPECT_EQ(replay.robots[1].name, "b");
  EXPECT_FALSE(replay.tracks[0].IsStill());
  EXPECT_TRUE(replay.tracks[1].IsStill());
  EXPECT_TRUE(replay.scene.is_null());
}

TEST_F(ReplayTest, AnOrientationDoesNotJumpToItsOtherSign) {
  State(0, "a", 0, 0.6);
  bodies_ += "0.02,a,0,0,0,0,0,-0.8,-0.6,0,0,0,0,0,0\n";
  const Replay replay = Read();
  EXPECT_NEAR(replay.tracks[0].poses[1][6], 0.6, 1e-12);
  EXPECT_NEAR(replay.tracks[0].poses[1][5], 0.8, 1e-12);
}

TEST_F(ReplayTest, ACommandHoldsFromWhenItActs) {
  for (int i = 0; i < 5; ++i) State(i * 0.02, "a", i);
  Write("run/commands.csv",
        "sent_ns,acts_ns,channel,target,quantity,value\n"
        "20000000,20001000,c,a,force_x,7\n"   // just after the second moment
        "60000000,60000000,c,a,force_x,-3\n"  // at the fourth
        "0,0,c,nobody,force_x,1\n");
  const Replay replay = Read();
  const auto force = std::find_if(replay.signals.begin(), replay.signals.end(),
                                  [](const Signal& s) { return s.panel == "commanded force [N]"; });
  ASSERT_NE(force, replay.signals.end());
  EXPECT_EQ(force->name, "x");
  EXPECT_EQ(force->first, 2u);
  EXPECT_THAT(force->values, ElementsAre(7, -3, -3));
}

TEST_F(ReplayTest, JointsHaveTheirUnits) {
  json scene = Scene();
  json base = Link("cart/base"), lift = Link("cart/lift", "prismatic", 0);
  scene["models"] = {
      {{"name", "cart"}, {"root", 0}, {"fixed_base", true}, {"links", {base, lift}}}};
  Write("run/scene.json", scene.dump());
  for (int i = 0; i < 3; ++i) {
    State(i * 0.02, "cart/base", 0);
    State(i * 0.02, "cart/lift", i);
  }
  Write("run/joints.csv",
        "time_s,joint,position,velocity,effort\n0.000000000,cart/lift_joint,0.5,2,9\n"
        "0.010000000,cart/lift_joint,9,9,9\n0.020000000,cart/lift_joint,0.75,2,9\n");
  Write("run/commands.csv",
        "sent_ns,acts_ns,channel,target,quantity,value\n0,0,c,cart/lift_joint,velocity,2\n");
  const Replay replay = Read();
  std::map<std::string, std::vector<double>> panels;
  for (const Signal& signal : replay.signals) panels[signal.panel + signal.name] = signal.values;
  EXPECT_THAT(panels["joint positions [m]lift_joint"], ElementsAre(0.5, 0.75, 0.75));
  EXPECT_TRUE(panels.contains("joint efforts [N]lift_joint"));
  EXPECT_TRUE(panels.contains("commanded joint speeds [m/s]lift_joint"));
  // What stands is drawn by what moves on it.
  EXPECT_THAT(replay.robots[0].paths, ElementsAre(1));
}

TEST_F(ReplayTest, ContactsAreThoseOfItsMoments) {
  json scene = Scene();
  json table = Link("table"), cart = Link("cart/base"), wheel = Link("cart/wheel", "continuous", 0);
  scene["models"] = {
      {{"name", "table"}, {"root", 0}, {"fixed_base", true}, {"links", {table}}},
      {{"name", "cart"}, {"root", 0}, {"fixed_base", false}, {"links", {cart, wheel}}}};
  Write("run/scene.json", scene.dump());
  for (int i = 0; i < 3; ++i) {
    for (const char* link : {"table", "cart/base", "cart/wheel"}) State(i * 0.02, link, i);
  }
  Write("run/contacts.csv",
        "time_s,first,second,x_m,y_m,z_m,normal_x,normal_y,normal_z,force_x_n,force_y_n,force_z_n\n"
        "0.010000000,cart/wheel,floor,9,9,9,0,0,1,9,9,9\n"
        "0.020000000,cart/base,cart/wheel,1,0,0,0,0,1,0,0,-3\n"
        "0.020000000,cart/wheel,table,0.25,-1,0.5,0,0,1,1,0,20\n"
        "0.020000000,cart/wheel,table,0.5,-1,0.5,0,0,1,nonsense,0,20\n"
        "0.040000000,cart/wheel,table,0.5,-1,0.5,0,0,1,-1,0,21\n");
  const Replay replay = Read();
  ASSERT_THAT(replay.contacts.points(), SizeIs(3));
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("contacts.csv has 1 line that cannot be used")));
  const json encoded = json::parse(Encoded(replay))["contacts"];
  EXPECT_EQ(encoded["pairs"], json::parse(R"([["cart/base","cart/wheel",true],)"
                                          R"(["cart/wheel","table",false]])"));
  EXPECT_EQ(encoded["stride"], 1);
}

TEST_F(ReplayTest, WithoutContactsThePageHasNone) {
  State(0, "a", 0);
  EXPECT_TRUE(json::parse(Encoded(Read()))["contacts"].is_null());
}

TEST_F(ReplayTest, LinesCountFromWhenTheirEndWasThere) {
  State(0, "a", 0);
  Write("run/r-p.out.log", "hello\nmark:  lift off\nhalf a line and more\n\nrest");
  Write("run/r-p.err.log", "oh\n");
  Write("run/output.csv",
        "time_ns,client,stream,begin,end\n"
        "1000,r/p,out,0,6\n2500,r/p,out,6,35\n2000,r/p,err,0,3\n9000,r/p,out,35,52\n"
        "1,gone/q,out,0,5\nbroken\n");
  const Replay replay = Read();
  ASSERT_THAT(replay.said, SizeIs(5));
  const auto is = [&](std::size_t i, std::int64_t us, const char* text, bool mark) {
    EXPECT_EQ(replay.said[i].time_us, us) << i;
    EXPECT_EQ(replay.said[i].text, text) << i;
    EXPECT_EQ(replay.said[i].is_mark, mark) << i;
  };
  is(0, 1, "hello", false);
  is(1, 2, "lift off", true);
  is(2, 2, "oh", false);
  is(3, 9, "half a line and more", false);
  is(4, 9, "rest", false);
  EXPECT_EQ(replay.said[2].stream, "err");
  EXPECT_THAT(SaidSection({replay}), HasSubstr("5 lines in virtual time"));
}

TEST_F(ReplayTest, ATalkativeProgramIsCutShort) {
  State(0, "a", 0);
  std::string text;
  for (int i = 0; i < 7000; ++i) text += fmt::format("line {}\n", i);
  Write("run/r-p.out.log", text + "mark: end\n");
  Write("run/r-q.out.log", "hello\n");
  Write("run/output.csv",
        fmt::format("time_ns,client,stream,begin,end\n5,r/p,out,0,{}\n7000,r/q,out,0,6\n",
                    text.size() + 10));
  // Two clients share the room.
  const Replay replay = Read();
  EXPECT_THAT(replay.said, SizeIs(2000 + 1 + 1));
  EXPECT_EQ(replay.said_more, 5000);
  EXPECT_EQ(replay.said[1999].text, "line 1999");
  EXPECT_EQ(replay.said[2000].text, "end");
  EXPECT_EQ(replay.said.back().text, "hello");
}

TEST_F(ReplayTest, IsWrittenToAStepOfItsRange) {
  for (int i = 0; i <= 50; ++i) State(i * 0.02, "a", 20 * std::sin(i * 0.1), std::cos(i * 0.02));
  const Replay replay = Read();
  const json encoded = json::parse(Encoded(replay));
  const json& track = encoded["tracks"][0];
  const auto numbers = Decoded(track["data"]);
  ASSERT_THAT(numbers, SizeIs(51 * 7));
  std::int64_t sums[7] = {};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    sums[i % 7] += numbers[i];
    const double value = track["least"][i % 7].get<double>() +
                         static_cast<double>(sums[i % 7]) * track["step"][i % 7].get<double>();
    EXPECT_NEAR(value, replay.tracks[0].poses[i / 7][i % 7], i % 7 < 3 ? 40.0 / 65535 : 1e-4);
  }
  EXPECT_LT(track["data"].get<std::string>().size(), 51u * 7 * 2);
}

TEST_F(ReplayTest, WhatStandsIsWrittenOnce) {
  for (int i = 0; i <= 50; ++i) State(i * 0.02, "a", 3);
  const json encoded = json::parse(Encoded(Read()));
  EXPECT_EQ(encoded["tracks"][0]["count"], 1);
  EXPECT_EQ(encoded["count"], 51);
}

TEST_F(ReplayTest, ADamagedSceneIsNamed) {
  Write("run/bodies.csv", kBodiesHead);
  for (const char* text : {"{", "{}", R"({"version":1,"bodies":[{"name":5}]})"}) {
    Write("run/scene.json", text);
    const auto read = ReadReplay(Path("run"), "run", 1, kRoom, &warnings_);
    ASSERT_TRUE(std::holds_alternative<LoadError>(read)) << text;
    EXPECT_THAT(std::get<LoadError>(read).message, HasSubstr("scene.json is damaged"));
  }
}

TEST_F(ReplayTest, AModelWhoseParentsGoRoundIsRefusedOrLeftOut) {
  json scene = Scene();
  scene["models"] = {{{"name", "m"},
                      {"root", 0},
                      {"fixed_base", false},
                      {"links", {Link("m/a", "fixed", 1), Link("m/b", "fixed", 0)}}}};
  Write("run/scene.json", scene.dump());
  State(0, "m/a", 0);
  EXPECT_THAT(Read().robots, IsEmpty());
}

TEST_F(ReplayTest, SectionsThatHaveNothingSayWhy) {
  std::filesystem::create_directories(Path("run"));
  auto read = ReadReplay(Path("run"), "run", 1, kRoom, &warnings_);
  const Replay& replay = std::get<Replay>(read);
  EXPECT_THAT(WorldSection({replay}), HasSubstr("no bodies and no models"));
  EXPECT_THAT(SaidSection({replay}), HasSubstr("no program wrote"));
  EXPECT_FALSE(PathsFigure({replay}).has_value());
  EXPECT_FALSE(MotionFigure({replay}).has_value());
}

TEST_F(ReplayTest, TheWorldIsSaidInASentence) {
  State(0, "a", 0);
  State(0, "b", 0);
  State(0.02, "a", 4);
  State(0.02, "b", 0);
  const Replay replay = Read(0.5);
  EXPECT_THAT(
      WorldSection({replay}),
      HasSubstr("500\u00a0ms of virtual time, in which a went 4.00\u00a0m and b stood still."));
  Replay of_many = replay;
  of_many.trials = 10;
  EXPECT_THAT(WorldSection({of_many}), HasSubstr("The first of 10 trials: 500"));
  EXPECT_THAT(WorldSection({of_many, replay}), HasSubstr("“run”, the first of 10 trials: 500"));
  EXPECT_THAT(WorldSection({replay}), Not(HasSubstr("“run”")));
  EXPECT_THAT(WorldSection({replay, replay}), HasSubstr("“run”: 500\u00a0ms of virtual time"));
}

}  // namespace
}  // namespace tcs::report
