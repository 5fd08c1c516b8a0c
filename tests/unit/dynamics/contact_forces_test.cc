// What models that touch do to each other, as Dynamics::ReadContacts tells it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "tests/unit/dynamics/taken_back.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

using testing::Each;
using testing::Field;
using testing::IsEmpty;
using testing::Not;

class ContactForces : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ContactForces, testing::ValuesIn(ModelEngines()), NameOfEngine);

constexpr double kEdgeM = 0.2;

Shape CubeShape(double edge_m) {
  return {.geometry = BoxShape{{edge_m, edge_m, edge_m}}, .friction = 0.8};
}

RobotModel Box(const std::string& name, double mass_kg, const std::array<double, 3>& at,
               const std::array<double, 4>& turned = {0, 0, 0, 1}) {
  RobotModel model;
  model.name = name;
  model.links.push_back(LinkOf(name, MassAt(mass_kg, {}, mass_kg * kEdgeM * kEdgeM / 6)));
  model.links[0].shapes.push_back(CubeShape(kEdgeM));
  model.at = {at, turned};
  return model;
}

// Its first link is fixed to the world, its second one hangs in the air above.
RobotModel Table() {
  RobotModel table = Pendulum(1, 0.1);
  table.name = "table";
  table.at.position_m = {0, 0, 3};
  table.links[0].shapes.push_back(
      {.geometry = BoxShape{{1, 1, 0.1}}, .pose = {{0, 0, -3.05}, {0, 0, 0, 1}}, .friction = 0.8});
  return table;
}

std::vector<ContactForce> ContactsAt(Dynamics& dynamics, VirtualTime t) {
  std::vector<ContactForce> contacts(3);  // which are not kept
  dynamics.ReadContacts(t, &contacts);
  return contacts;
}

// What a link feels of all that touches it.
std::array<double, 3> ForceOn(int link, const std::vector<ContactForce>& contacts) {
  std::array<double, 3> sum{};
  for (const ContactForce& contact : contacts) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (contact.first == link) sum[i] += contact.force_n[i];
      if (contact.second == link) sum[i] -= contact.force_n[i];
    }
  }
  return sum;
}

TEST_P(ContactForces, HoldABoxUpThatRests) {
  constexpr double kMass = 2;
  WorldSpec world = WorldOf({Box("box", kMass, {0.3, -0.2, kEdgeM / 2})}, GetParam());
  world.fixtures = {{.geometry = SphereShape{0.1}, .pose = {{5, 5, 0}, {0, 0, 0, 1}}}, Floor()};
  auto dynamics = MakeDynamics(world);
  const auto contacts = ContactsAt(*dynamics, AtMs(2000));
  ASSERT_GE(contacts.size(), 3u) << "it stands";
  for (const ContactForce& contact : contacts) {
    EXPECT_EQ(contact.first, 0);
    EXPECT_EQ(contact.second, -1);
    EXPECT_EQ(contact.fixture, 1) << "the floor is the second of the fixtures";
    EXPECT_NEAR(contact.normal[2], 1, 1e-6) << "towards the box";
    EXPECT_GT(contact.force_n[2], 0);
    EXPECT_NEAR(std::abs(contact.point_m[0] - 0.3), kEdgeM / 2, 1e-3);
    EXPECT_NEAR(std::abs(contact.point_m[1] + 0.2), kEdgeM / 2, 1e-3);
    EXPECT_NEAR(contact.point_m[2], 0, 1e-3);
  }
  const auto force = ForceOn(0, contacts);
  EXPECT_NEAR(force[2], kMass * kG, 1e-4 * kMass * kG);
  EXPECT_NEAR(force[0], 0, 1e-4 * kMass * kG);
  EXPECT_NEAR(force[1], 0, 1e-4 * kMass * kG);
}

// What pushes changes the momentum by as much, in each step of a fall that ends in a tumble.
TEST_P(ContactForces, AreWhatChangesMomenta) {
  constexpr double kMass = 1.5, kStepS = 1e-3;
  IntegratorSpec spec = GetParam();
  spec.fixed_step = VirtualDuration::Milliseconds(1);
  RobotModel box = Box("box", kMass, {0, 0, 0.4}, FromRollPitchYaw(0.3, 0.5, 0));
  box.linear_velocity_mps = {1, 0.3, 0};
  WorldSpec world = WorldOf({box}, spec);
  world.fixtures = {Floor()};
  auto dynamics = MakeDynamics(world);
  std::array<double, 3> before = ReadLink(*dynamics, 0, AtMs(0)).linear_velocity_mps;
  double hardest_n = 0;
  for (int ms = 1; ms <= 1500; ++ms) {
    const std::array<double, 3> now = ReadLink(*dynamics, 0, AtMs(ms)).linear_velocity_mps;
    const auto force = ForceOn(0, ContactsAt(*dynamics, AtMs(ms)));
    for (std::size_t i = 0; i < 3; ++i) {
      const double needed = kMass * ((now[i] - before[i]) / kStepS + (i == 2 ? kG : 0));
      ASSERT_NEAR(force[i], needed, 1e-6 * (1 + std::abs(needed))) << "at " << ms << " ms, " << i;
      hardest_n = std::max(hardest_n, force[i]);
    }
    before = now;
    dynamics->AdvanceTo(AtMs(ms));
  }
  EXPECT_GT(hardest_n, 10 * kMass * kG) << "it hits the floor";
}

TEST_P(ContactForces, AreNoneInFreeFallNorAtTheStart) {
  WorldSpec world =
      WorldOf({Box("falls", 1, {0, 0, 5}), Box("stands", 1, {9, 0, kEdgeM / 2})}, GetParam());
  world.fixtures = {Floor()};
  auto dynamics = MakeDynamics(world);
  EXPECT_THAT(ContactsAt(*dynamics, AtMs(0)), IsEmpty()) << "no step has been taken";
  for (const int ms : {1, 10, 500, 900}) {
    const auto contacts = ContactsAt(*dynamics, AtMs(ms));
    if (ms > 100) {
      EXPECT_THAT(contacts, Not(IsEmpty())) << ms;
    }
    EXPECT_THAT(contacts, Each(Field(&ContactForce::first, 1))) << "the one that stands, at " << ms;
  }
}

// Each box feels all that touches it, and what it stands on the opposite.
TEST_P(ContactForces, AreOppositeForTheOther) {
  WorldSpec world =
      WorldOf({Box("top", 1, {0, 0, 2.5 * kEdgeM}), Box("middle", 2, {0, 0, 1.5 * kEdgeM}),
               Box("bottom", 4, {0, 0, 0.5 * kEdgeM})},
              GetParam());
  world.fixtures = {Floor()};
  auto dynamics = MakeDynamics(world);
  const auto contacts = ContactsAt(*dynamics, AtMs(3000));
  const double masses[] = {1, 2, 4};
  for (int link = 0; link < 3; ++link) {
    EXPECT_NEAR(ForceOn(link, contacts)[2], masses[link] * kG, 1e-2 * kG) << link;
  }
  // Between two that move the lower number is first, and the order is that of the numbers.
  std::vector<std::pair<int, int>> pairs;
  std::array<double, 3> between{};
  for (const ContactForce& contact : contacts) {
    pairs.emplace_back(contact.first, contact.second);
    if (contact.first == 0 && contact.second == 1) between[2] += contact.force_n[2];
    EXPECT_GT(contact.force_n[2] * contact.normal[2], 0) << "they push, and do not pull";
  }
  EXPECT_NEAR(between[2], 1 * kG, 1e-2 * kG) << "the middle one holds the top one up";
  EXPECT_EQ(pairs.front(), std::pair(0, 1));
  EXPECT_EQ(pairs.back(), std::pair(2, -1));
  const auto with_floor = std::ranges::find(pairs, std::pair(2, -1));
  EXPECT_EQ(std::ranges::find(pairs, std::pair(1, 2)) - pairs.begin(),
            std::ranges::count(pairs, std::pair(0, 1)));
  EXPECT_EQ(pairs.end() - with_floor, std::ranges::count(pairs, std::pair(2, -1)));
}

// A link that is fixed to the world is named, and comes second although its number is lower.
TEST_P(ContactForces, NameTheLinkThatSomethingStandsOn) {
  WorldSpec world = WorldOf({Table(), Box("box", 1, {0.1, 0, kEdgeM / 2})}, GetParam());
  auto dynamics = MakeDynamics(world);
  const int box = *dynamics->FindLink("box", "box"), board = *dynamics->FindLink("table", "base");
  ASSERT_LT(board, box);
  const auto contacts = ContactsAt(*dynamics, AtMs(2000));
  ASSERT_THAT(contacts, Not(IsEmpty()));
  for (const ContactForce& contact : contacts) {
    EXPECT_EQ(contact.first, box);
    EXPECT_EQ(contact.second, board);
    EXPECT_EQ(contact.fixture, -1);
  }
  EXPECT_NEAR(ForceOn(box, contacts)[2], kG, 1e-3 * kG);
}

TEST_P(ContactForces, HaveFrictionAcrossTheNormal) {
  constexpr double kFriction = 0.8;
  for (const bool slides : {false, true}) {
    const double angle = slides ? 0.8 : 0.3;
    const Pose slope{{}, FromRollPitchYaw(0, angle, 0)};
    const Pose at = Times(slope, Pose{{0, 0, kEdgeM / 2}, {0, 0, 0, 1}});
    WorldSpec world = WorldOf({Box("box", 1, at.position_m, at.orientation_xyzw)}, GetParam());
    world.fixtures = {Floor(0.8, angle)};
    auto dynamics = MakeDynamics(world);
    // What slides on MuJoCo does so by one corner after the other.
    constexpr int kSteps = 200;
    std::array<double, 3> force{};
    for (int ms = 0; ms < kSteps; ++ms) {
      const auto now = ForceOn(0, ContactsAt(*dynamics, AtMs(1000 + ms)));
      for (std::size_t i = 0; i < 3; ++i) force[i] += now[i] / kSteps;
    }
    const auto normal = Rotate(slope.orientation_xyzw, {0, 0, 1});
    const auto down = Rotate(slope.orientation_xyzw, {1, 0, 0});
    double along = 0, across = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      along += force[i] * normal[i];
      across -= force[i] * down[i];
    }
    const bool hops = slides && GetParam().engine == EngineKind::kMujoco;
    const double tolerance_n = (hops ? 0.08 : 0.02) * kG;
    EXPECT_NEAR(along, kG * std::cos(angle), tolerance_n) << slides;
    EXPECT_NEAR(across, slides ? kFriction * along : kG * std::sin(angle), tolerance_n) << slides;
  }
}

// Commands that come late, checkpoints and branches: contacts are those of a run in which nothing
// was taken back, to the byte; and that run is the same as one whose contacts nobody reads.
TEST_P(ContactForces, AreTakenBackAndChangeNothing) {
  WorldSpec world =
      WorldOf({Box("a", 1, {0, 0, kEdgeM / 2}), Box("b", 0.5, {0.25, 0.02, kEdgeM / 2}),
               Box("c", 2, {0.1, 0, 1.6 * kEdgeM})},
              GetParam());
  world.fixtures = {Floor()};
  auto known = MakeDynamics(world), leading = MakeDynamics(world), unread = MakeDynamics(world);
  std::mt19937_64 random(5);
  const auto draw = [&](std::uint64_t below) {
    return static_cast<std::int64_t>(random() % below);
  };
  struct Timed {
    std::int64_t at_ns;
    int link;
    double push_n;
  };
  std::vector<Timed> commands;
  std::int64_t at_ns = 0;
  for (int i = 0; i < 900; ++i) {
    if (draw(5) != 0) at_ns += 1 + draw(8'000'000);
    commands.push_back({at_ns, static_cast<int>(draw(3)), 3 * static_cast<double>(draw(9)) - 12});
  }
  const auto apply = [](Dynamics& dynamics, const Timed& command) {
    dynamics.ApplyToLink(command.link, WrenchFrame::kWorld,
                         {.force_n = {command.push_n, 0.3 * command.push_n, 2}}, At(command.at_ns));
  };
  struct All {
    std::array<LinkState, 3> links{};
    std::array<std::array<double, 12>, 60> contacts{};
  };
  std::size_t most = 0;
  const auto read = [&](Dynamics& dynamics, std::int64_t ns) {
    All all;
    dynamics.ReadLinks(At(ns), std::array{0, 1, 2}, all.links);
    const auto contacts = ContactsAt(dynamics, At(ns));
    EXPECT_LE(contacts.size(), all.contacts.size());
    most = std::max(most, contacts.size());
    for (std::size_t i = 0; i < std::min(contacts.size(), all.contacts.size()); ++i) {
      const ContactForce& c = contacts[i];
      all.contacts[i] = {static_cast<double>(c.first + 1),
                         static_cast<double>(c.second),
                         static_cast<double>(c.fixture),
                         c.point_m[0],
                         c.point_m[1],
                         c.point_m[2],
                         c.normal[0],
                         c.normal[1],
                         c.normal[2],
                         c.force_n[0],
                         c.force_n[1],
                         c.force_n[2]};
    }
    return all;
  };
  ASSERT_NO_FATAL_FAILURE(ExpectTheSameToTheByte(*known, *leading, commands, apply, read, draw));
  EXPECT_GE(most, 5u);
  for (const Timed& command : commands) apply(*unread, command);
  const VirtualTime end = At(commands.back().at_ns);
  std::array<LinkState, 3> with{}, without{};
  known->ReadLinks(end, std::array{0, 1, 2}, with);
  unread->ReadLinks(end, std::array{0, 1, 2}, without);
  EXPECT_EQ(std::memcmp(&with, &without, sizeof with), 0);
  EXPECT_EQ(known->work().steps, unread->work().steps);
}

TEST(ContactForcesOfBodies, AreNone) {
  for (const EngineKind engine : {EngineKind::kSimbody, EngineKind::kOde}) {
    WorldSpec world = OneBody({.engine = engine});
    world.gravity_mps2 = {0, 0, -kG};
    world.has_region = true;
    auto dynamics = MakeDynamics(world);
    EXPECT_THAT(ContactsAt(*dynamics, AtMs(3000)), IsEmpty())
        << "the region's walls are no contacts";
  }
}

}  // namespace
}  // namespace tcs
