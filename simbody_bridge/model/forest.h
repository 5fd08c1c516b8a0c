// The models of one island as one system: their trees beside each other, all numbered through, and
// what they may touch. Both engines that have joints build from it. Pure.
#pragma once

#include <set>
#include <span>
#include <utility>
#include <vector>

#include "simbody_bridge/model/rigid_tree.h"

namespace tcs {

// A forest points into the models and fixtures that it was made of, which outlive it.
struct ForestJoint {
  const Joint* joint = nullptr;
  int body = kWorldBody;  // moved by the joint; kWorldBody: a fixed joint
  int leader = -1;        // the joint that it mimics
};

struct ForestShape {
  const Shape* shape = nullptr;
  int body = kWorldBody;
  Pose pose;       // in the body's frame, or in the world
  int model = -1;  // -1: a fixture of the world
  // The owner of the shape: a link, as Dynamics numbers the links of all models, or one of the
  // world's fixtures, by index; the other one is -1.
  int link = -1, fixture = -1;
};

struct Forest {
  std::vector<TreeBody> bodies;    // TreeBody::joint counts `joints`
  std::vector<int> model_of_body;  // counted as ForestShape::model
  std::vector<TreeLink> links;     // of the first model, then of the second …
  std::vector<ForestJoint> joints;
  std::vector<ForestShape> shapes;       // fixtures last
  std::vector<bool> has_self_collision;  // of each model
  // Pairs of links, as ForestShape numbers them, that pass through each other; the lower one first.
  std::set<std::pair<int, int>> ignored_pairs;
};

// The forest of the models of these indices among all, which have passed CheckModel.
Forest MakeForest(std::span<const RobotModel> models, std::span<const int> indices,
                  std::span<const Shape> fixtures);

// Adds shapes that do not move, whose links are numbered as Dynamics does; the shapes outlive the
// forest.
void AddFixtures(std::span<const StaticShape> shapes, Forest* forest);

// Whether two shapes can ever be in contact: they are of different bodies, one of which moves, that
// no joint joins; and if they are of one model, it collides with itself and does not ignore the two
// links. Shapes without a link are of their body as a whole.
bool MayTouch(const Forest& forest, const ForestShape& a, const ForestShape& b);

}  // namespace tcs
