// Joints that mimic others, in steps that solve for the speeds.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simbody_bridge/simbody/tree/tree.h"

namespace tcs {

// The speeds are `reduction` times those of joints that mimic no other.
void Reduce(const SimbodyTree& tree, Eigen::MatrixXd* reduction);

// The same by rows. Returns how many there are.
Eigen::Index Reduce(const SimbodyTree& tree, std::vector<ReducedSpeed>* reduced);

}  // namespace tcs
