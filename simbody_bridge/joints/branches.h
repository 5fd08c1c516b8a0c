// Systems of equations of the joints of trees: those on different branches do not push each other,
// and what is 0 in the matrix stays 0 if leaves go first (Featherstone, Efficient factorization of
// the joint-space inertia matrix for branched kinematic trees, International Journal of Robotics
// Research 24, 2005).
#pragma once

#include <Eigen/Core>

namespace tcs {

// Solves `system` y = `x`, and writes y into `x`. The system is symmetric and positive definite;
// its upper triangle is read and overwritten. It is quick where joints come behind those that carry
// them: any order gives the solution.
void SolveByBranches(Eigen::MatrixXd* system, Eigen::VectorXd* x);

}  // namespace tcs
