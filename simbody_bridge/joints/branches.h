// Systems of equations of the joints of trees: joints on different branches do not push each other,
// and an element that is 0 in the matrix stays 0 if leaves go first (Featherstone, Efficient
// factorization of the joint-space inertia matrix for branched kinematic trees, International
// Journal of Robotics Research 24, 2005).
#pragma once

#include <Eigen/Core>

namespace tcs {

// Solves `system` y = `x`, and writes y into `x`. The system is symmetric and positive definite;
// its upper triangle is read and overwritten. The solution is quick where joints come behind the
// joints that carry them: any order gives it.
void SolveByBranches(Eigen::MatrixXd* system, Eigen::VectorXd* x);

}  // namespace tcs
