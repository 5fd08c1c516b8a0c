#include "coordinator/models/mend_masses.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "simbody_bridge/model/principal_axes.h"
#include "simbody_bridge/model/rigid_tree.h"

namespace tcs {
namespace {

using Moments = std::array<double, 3>;

// A triangle inequality that is broken by less is rounding.
constexpr double kRounding = 1e-6;
// The margin of a mended triangle inequality, in relation to the largest moment, so that it holds
// for engines, too, after they have turned the inertia.
constexpr double kMargin = 1e-9;
// A body that has no mass gets this part of the mass that it carries, or of the mass that carries
// it …
constexpr double kLeastPart = 1e-3;
// … and at least this mass.
constexpr double kLeastMassKg = 1e-6;
// A body without extent is a ball of iron.
constexpr double kIronKgPerM3 = 7900;
// A radius that is smaller is what rounding left of 0.
constexpr double kNoRadiusM = 1e-8;
// The radius of a body without mass: a link as people see it.
constexpr double kMasslessRadiusM = 0.02;

Matrix3 MatrixOf(const PrincipalAxes& principal, const Moments& moments) {
  Matrix3 m{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        m[row][column] += moments[i] * principal.axes[i][row] * principal.axes[i][column];
      }
    }
  }
  return m;
}

// Adds `change`, along the axes of a body, to the inertia of a link that has the pose `pose` in it.
void Add(const Matrix3& change, const Pose& pose, Inertial* inertial) {
  const auto q = Times(pose.orientation_xyzw, inertial->frame.orientation_xyzw);
  std::array<std::array<double, 3>, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 3> unit{};
    unit[i] = 1;
    axes[i] = Rotate(q, unit);
  }
  const auto along = [&](std::size_t a, std::size_t b) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) sum += axes[a][i] * change[i][k] * axes[b][k];
    }
    return sum;
  };
  inertial->ixx_kgm2 += along(0, 0);
  inertial->iyy_kgm2 += along(1, 1);
  inertial->izz_kgm2 += along(2, 2);
  inertial->ixy_kgm2 += along(0, 1);
  inertial->ixz_kgm2 += along(0, 2);
  inertial->iyz_kgm2 += along(1, 2);
}

double MomentOfIron(double mass_kg) {
  const double radius_m = std::cbrt(3 * mass_kg / (4 * std::numbers::pi * kIronKgPerM3));
  return 0.4 * mass_kg * radius_m * radius_m;
}

std::string Text(const Moments& moments) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) kg m^2", moments[0], moments[1], moments[2]);
}

// By how much of the largest moment the triangle inequality is broken.
double Broken(const Moments& moments) {
  return moments[2] > 0 ? (moments[2] - moments[0] - moments[1]) / moments[2] : 1;
}

class Mender {
 public:
  // The arguments outlive this.
  Mender(RobotModel* model, const std::function<int(std::size_t)>& line_of, UrdfNotes* notes)
      : model_(*model), line_of_(line_of), notes_(*notes) {}

  void Mend() {
    LeaveInertiasWithoutMassOut();
    tree_ = MakeTree(model_);
    SumMasses();
    for (std::size_t body = 0; body < tree_.bodies.size(); ++body) {
      if (!(tree_.bodies[body].mass_kg > 0)) {
        GiveMass(body);
      } else {
        MendInertia(body);
      }
    }
  }

 private:
  void Say(std::string_view kind, std::size_t link, std::string_view what, double how_bad) {
    notes_.AddMend(kind, line_of_(link), fmt::format("link '{}' {}", model_.links[link].name, what),
                   how_bad);
  }

  // "moves (joint 'elbow' moves it)".
  std::string Moves(std::size_t body) const {
    const int joint = tree_.bodies[body].joint;
    if (joint < 0) return "moves (its base is free)";
    return fmt::format("moves (joint '{}' moves it)",
                       model_.joints[static_cast<std::size_t>(joint)].name);
  }

  void LeaveInertiasWithoutMassOut() {
    for (std::size_t link = 0; link < model_.links.size(); ++link) {
      auto& inertial = model_.links[link].inertial;
      if (!inertial.has_value() || inertial->mass_kg > 0) continue;
      inertial.reset();
      Say("inertia without mass", link, "has an inertia but a mass of 0: it counts as without both",
          0);
    }
  }

  // The mass of each body with all that it carries.
  void SumMasses() {
    carried_kg_.resize(tree_.bodies.size());
    for (std::size_t i = tree_.bodies.size(); i-- > 0;) {
      carried_kg_[i] += tree_.bodies[i].mass_kg;
      const int parent = tree_.bodies[i].parent;
      if (parent != kWorldBody) carried_kg_[static_cast<std::size_t>(parent)] += carried_kg_[i];
    }
  }

  // The body's first link: the child of its joint.
  std::size_t TopOf(std::size_t body) const {
    const int joint = tree_.bodies[body].joint;
    return static_cast<std::size_t>(
        joint < 0 ? model_.root : model_.joints[static_cast<std::size_t>(joint)].child);
  }

  void GiveMass(std::size_t body) {
    double beside_kg = carried_kg_[body];
    for (int above = tree_.bodies[body].parent; !(beside_kg > 0) && above != kWorldBody;) {
      const auto index = static_cast<std::size_t>(above);
      beside_kg = tree_.bodies[index].mass_kg;
      above = tree_.bodies[index].parent;
    }
    Inertial inertial;
    inertial.mass_kg = std::max(kLeastMassKg, kLeastPart * beside_kg);
    const double moment = inertial.mass_kg * kMasslessRadiusM * kMasslessRadiusM;
    inertial.ixx_kgm2 = inertial.iyy_kgm2 = inertial.izz_kgm2 = moment;
    const std::size_t link = TopOf(body);
    model_.links[link].inertial = inertial;
    Say("no mass", link,
        fmt::format("{} but has no mass: {:.3g} kg and {:.3g} kg m^2 are taken", Moves(body),
                    inertial.mass_kg, moment),
        inertial.mass_kg);
  }

  // The link of the body whose own inertia is broken most; else the heaviest one.
  std::size_t WorstOf(std::size_t body) const {
    std::size_t worst = TopOf(body);
    double how_bad = -1;
    for (std::size_t link = 0; link < model_.links.size(); ++link) {
      const auto& inertial = model_.links[link].inertial;
      if (tree_.links[link].body != static_cast<int>(body) || !inertial.has_value()) continue;
      const Moments moments =
          PrincipalAxesOf({{{inertial->ixx_kgm2, inertial->ixy_kgm2, inertial->ixz_kgm2},
                            {inertial->ixy_kgm2, inertial->iyy_kgm2, inertial->iyz_kgm2},
                            {inertial->ixz_kgm2, inertial->iyz_kgm2, inertial->izz_kgm2}}})
              .moments;
      const double this_bad = std::max({0.0, moments[2] - moments[0] - moments[1], -moments[0]});
      if (this_bad > how_bad) {
        how_bad = this_bad;
        worst = link;
      }
    }
    return worst;
  }

  void MendInertia(std::size_t body) {
    const TreeBody& of = tree_.bodies[body];
    const PrincipalAxes principal = PrincipalAxesOf(of.inertia_kgm2);
    const Moments& had = principal.moments;
    Moments moments = NearestMoments(had);
    // A point or a thin rod has no moment to speak of.
    const double least = MomentOfIron(of.mass_kg);
    const bool is_thin =
        !(moments[0] > std::max(kMargin * moments[2], of.mass_kg * kNoRadiusM * kNoRadiusM));
    if (is_thin) {
      for (double& moment : moments) moment = std::max(moment, least);
    }
    const double short_of = moments[2] * (1 + 4 * kMargin) - moments[0] - moments[1];
    if (short_of > 0) {
      moments[0] += short_of;
      moments[1] = std::max(moments[0], moments[1]);
    }
    if (moments == had) return;
    const std::size_t link = WorstOf(body);
    Moments change;
    for (std::size_t i = 0; i < 3; ++i) change[i] = moments[i] - had[i];
    Add(MatrixOf(principal, change), tree_.links[link].pose, &*model_.links[link].inertial);
    if (is_thin) {
      Say("no inertia", link,
          fmt::format("{} but has the moments of inertia {}: {} are taken", Moves(body), Text(had),
                      Text(moments)),
          of.mass_kg);
    } else if (Broken(had) > kRounding) {
      Say("impossible inertia", link,
          fmt::format("has the moments of inertia {}, one of which exceeds the sum of the two "
                      "others, which no body has: the nearest are taken, {}",
                      Text(had), Text(moments)),
          Broken(had));
    }
  }

  RobotModel& model_;
  const std::function<int(std::size_t)>& line_of_;
  UrdfNotes& notes_;
  RigidTree tree_;
  std::vector<double> carried_kg_;
};

}  // namespace

void MendMasses(RobotModel* model, const std::function<int(std::size_t)>& line_of,
                UrdfNotes* notes) {
  Mender(model, line_of, notes).Mend();
}

// A body's moments are sums of two of three second moments that are not negative. The function
// tries which of these are 0 in the nearest body: there are few ways.
Moments NearestMoments(const Moments& moments) {
  if (moments[0] >= 0 && moments[2] <= moments[0] + moments[1]) return moments;
  Moments best{};
  double least = -1;
  for (unsigned which = 0; which < 8; ++which) {
    // The second moments in `which` are free and of least squares. With A = 1 1^T - I, which makes
    // moments of them,
    std::array<double, 3> target{};  // A^T moments
    const double sum = moments[0] + moments[1] + moments[2];
    for (std::size_t i = 0; i < 3; ++i) target[i] = sum - moments[i];
    // and A^T A = I + 1 1^T, of n free ones, has the inverse I - 1 1^T / (n + 1).
    double free_sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if ((which >> i & 1U) == 0) continue;
      free_sum += target[i];
      ++count;
    }
    std::array<double, 3> second{};
    bool is_body = true;
    for (std::size_t i = 0; i < 3; ++i) {
      if ((which >> i & 1U) == 0) continue;
      second[i] = target[i] - free_sum / (count + 1);
      is_body = is_body && second[i] >= 0;
    }
    if (!is_body) continue;
    const double all = second[0] + second[1] + second[2];
    Moments candidate;
    double distance = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      candidate[i] = all - second[i];
      distance += (candidate[i] - moments[i]) * (candidate[i] - moments[i]);
    }
    if (least >= 0 && distance >= least) continue;
    least = distance;
    best = candidate;
  }
  return best;
}

}  // namespace tcs
