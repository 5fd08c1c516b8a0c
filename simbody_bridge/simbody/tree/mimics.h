// Joints that mimic others, in steps that solve for the speeds.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simbody_bridge/simbody/tree/tree.h"

namespace tcs {

// All speeds are `reduction` times the speeds of joints that mimic no other.
void Reduce(const SimbodyTree& tree, Eigen::MatrixXd* reduction);

// The same, by rows. Returns how many speeds mimic no other.
Eigen::Index Reduce(const SimbodyTree& tree, std::vector<ReducedSpeed>* reduced);

// Reduces the mass matrix and the forces of all speeds to the `count` speeds that mimic no other.
void ReduceSystem(std::span<const ReducedSpeed> reduced, Eigen::Index count,
                  const Eigen::MatrixXd& mass, const Eigen::VectorXd& forces,
                  Eigen::MatrixXd* reduced_mass, Eigen::VectorXd* reduced_forces);
// Changes or rates of all speeds, from those of the speeds that mimic no other.
Eigen::VectorXd SpreadToAll(std::span<const ReducedSpeed> reduced, const Eigen::VectorXd& of_them);

}  // namespace tcs
