// Systems of joints, solved by their branches and as if there were none.
#include "simbody_bridge/joints/branches.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>
#include <vector>

namespace tcs {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// As a mass matrix: 0 where neither joint carries the other one. -1 carries what nothing does.
MatrixXd SystemOf(const std::vector<Index>& carriers, std::mt19937_64* random) {
  std::uniform_real_distribution<double> draw(-0.5, 0.5);
  const auto size = static_cast<Index>(carriers.size());
  MatrixXd lower = MatrixXd::Identity(size, size);
  for (Index joint = 0; joint < size; ++joint) {
    for (Index by = carriers[static_cast<std::size_t>(joint)]; by >= 0;
         by = carriers[static_cast<std::size_t>(by)]) {
      lower(joint, by) = draw(*random);
    }
  }
  return lower.transpose() * lower;
}

void ExpectSolved(const MatrixXd& system, std::mt19937_64* random) {
  std::uniform_real_distribution<double> draw(-1, 1);
  VectorXd x(system.rows());
  for (double& of : x) of = draw(*random);
  const VectorXd expected = system.llt().solve(x);
  MatrixXd half = system;
  half.triangularView<Eigen::StrictlyLower>().setConstant(1e300);  // is not read
  SolveByBranches(&half, &x);
  EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm()) << system;
}

TEST(Branches, OfAnyTreeAreSolvedAsIfThereWereNone) {
  std::mt19937_64 random(3);
  for (int size = 1; size < 40; ++size) {
    std::vector<Index> carriers;
    for (Index joint = 0; joint < size; ++joint) {
      carriers.push_back(static_cast<Index>(random() % static_cast<std::uint64_t>(joint + 1)) - 1);
    }
    ExpectSolved(SystemOf(carriers, &random), &random);
  }
}

// Contacts between branches make rows of what were none: a system need not be that of a tree.
TEST(Branches, ThatPushEachOtherAreSolvedToo) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> draw(-1, 1);
  MatrixXd system = SystemOf({-1, 0, 1, 1, 2, 3, 3, -1}, &random);
  const VectorXd contact = VectorXd::NullaryExpr(8, [&] { return draw(random); });
  for (const std::vector<int>& touching : {std::vector{4, 6}, std::vector{2, 5, 7}}) {
    for (const int i : touching) {
      for (const int k : touching) system(i, k) += contact[i] * contact[k];
    }
    ExpectSolved(system, &random);
  }
  ExpectSolved(MatrixXd::Identity(5, 5) + MatrixXd::Constant(5, 5, 2), &random);
}

}  // namespace
}  // namespace tcs
