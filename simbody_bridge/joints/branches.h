// Systems of equations of the joints of trees: those on different branches do not push each other,
// and what is 0 in the matrix stays 0 if leaves go first (Featherstone, Efficient factorization of
// the joint-space inertia matrix for branched kinematic trees, International Journal of Robotics
// Research 24, 2005).
#pragma once

#include <Eigen/Core>

namespace tcs {

// Makes of `x` what `system` times it was. The system is symmetric and positive definite; of it the
// upper right half is read and overwritten. Joints come behind those that carry them, for the sake
// of time: any order gives the solution.
void SolveByBranches(Eigen::MatrixXd* system, Eigen::VectorXd* x);

}  // namespace tcs
