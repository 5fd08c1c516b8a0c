// Finds how springs and dampers answer a push (linear_response.h), by the series for a fraction of
// the time and by doubling that (Skaflestad and Wright, The scaling and modified squaring method
// for matrix functions related to the exponential, Applied Numerical Mathematics 59, 2009).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "simbody_bridge/joints/linear_response.h"

namespace tcs {

// Of up to `kSize` speeds, an even number, or of any number if that is Eigen::Dynamic: products of
// small matrices whose size is known take a third of the time. Speeds that are not there have
// neither springs nor dampers.
template <int kSize>
class SpringResponse {
 public:
  static_assert(kSize == Eigen::Dynamic || kSize % 2 == 0);

  SpringResponse(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& damping, double seconds)
      : used_(stiffness.rows()), size_(kSize == Eigen::Dynamic ? used_ : kSize) {
    minus_stiffness_.setZero(size_, size_);
    minus_stiffness_.topLeftCorner(used_, used_) = -seconds * seconds * stiffness;
    minus_damping_.setZero(size_, size_);
    minus_damping_.topLeftCorner(used_, used_) = -seconds * damping;
  }

  // Writes the response over the time, and over half of it unless `half` is null: NaN where numbers
  // are too large.
  void Find(LinearResponse* whole, LinearResponse* half) {
    double stiff = NormOf(minus_stiffness_), damped = NormOf(minus_damping_);
    if (!std::isfinite(stiff) || !std::isfinite(damped)) {
      for (Matrix& b : b_) b.setConstant(size_, size_, std::numeric_limits<double>::quiet_NaN());
      Write(whole);
      if (half != nullptr) Write(half);
      return;
    }
    int doublings = half != nullptr ? 1 : 0;
    stiff = std::ldexp(stiff, -2 * doublings);
    damped = std::ldexp(damped, -doublings);
    for (; stiff > kSmall || damped > kSmall; ++doublings) stiff /= 4, damped /= 2;
    minus_stiffness_ *= std::ldexp(1.0, -2 * doublings);
    minus_damping_ *= std::ldexp(1.0, -doublings);
    Begin();
    for (; doublings > 0; --doublings) {
      if (doublings == 1 && half != nullptr) Write(half);
      Double();
    }
    Write(whole);
  }

 private:
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  // The series begin where stiffness and damping are no more than this, and have so many terms: the
  // next one is below 1e-13.
  static constexpr double kSmall = 1;
  static constexpr int kTerms = 16;

  // The greatest sum of a row.
  static double NormOf(const Matrix& matrix) {
    return matrix.cwiseAbs().rowwise().sum().maxCoeff();
  }

  // Adds `a` times `b`.
  static void AddProduct(const Matrix& a, const Matrix& b, Matrix* sum) {
    if constexpr (kSize == Eigen::Dynamic) {
      sum->noalias() += a * b;
    } else {
      // Two columns at a time stay in registers.
      for (int column = 0; column < kSize; column += 2) {
        Eigen::Matrix<double, kSize, 1> first = sum->col(column), second = sum->col(column + 1);
        for (int k = 0; k < kSize; ++k) {
          first += a.col(k) * b(k, column);
          second += a.col(k) * b(k, column + 1);
        }
        sum->col(column) = first;
        sum->col(column + 1) = second;
      }
    }
  }

  // phi_k(z) = 1 / k! + z phi_{k+1}(z), whose upper right block is, as z's upper half is (0 1) and
  // as phi_{k+1}(z) and z commute, B_k = 1 / (k+1)! - B_{k+1} D - B_{k+2} K.
  void Begin() {
    double factorial = 1;
    for (int k = 2; k <= kTerms + 2; ++k) factorial *= k;
    std::array<Matrix*, 3> terms = {&memory_[0], &memory_[1], &memory_[2]};
    const auto one = Matrix::Identity(size_, size_);
    *terms[2] = one / (factorial * (kTerms + 3));
    *terms[1] = one / factorial;
    for (int k = kTerms; k >= 0; --k) {
      factorial /= k + 2;
      Matrix& term = *terms[0];
      term = one / factorial;
      AddProduct(*terms[1], minus_damping_, &term);
      AddProduct(*terms[2], minus_stiffness_, &term);
      if (k < 4) b_[static_cast<std::size_t>(k)] = term;
      std::rotate(terms.begin(), terms.begin() + 2, terms.end());
    }
  }

  // phi_k(2 z) = (e^z phi_k(z) + sum of phi_j(z) / (k-j)! for j from 1 to k) / 2^k. The lower right
  // block of phi_k(z) is B_{k-1}. The unit of time becomes twice as long, which makes half of each
  // B_k.
  void Double() {
    // The upper left block of the exponential, as phi_0(z) = 1 + z phi_1(z), and the lower right
    // one.
    Matrix &upper = memory_[0], &lower = memory_[1];
    upper.setIdentity(size_, size_);
    AddProduct(b_[1], minus_stiffness_, &upper);
    lower = upper;
    AddProduct(b_[0], minus_damping_, &lower);
    doubled_[0].setZero(size_, size_);
    AddProduct(b_[0], lower, &doubled_[0]);
    AddProduct(upper, b_[0], &doubled_[0]);
    for (std::size_t k = 1; k < 4; ++k) {
      doubled_[k] = b_[k];
      AddProduct(upper, b_[k], &doubled_[k]);
      AddProduct(b_[0], b_[k - 1], &doubled_[k]);
    }
    doubled_[2] += b_[1];
    doubled_[3] += b_[2] + b_[1] / 2;
    for (std::size_t k = 0; k < 4; ++k) {
      b_[k] = std::ldexp(1.0, -static_cast<int>(k) - 1) * doubled_[k];
    }
    minus_stiffness_ *= 4;
    minus_damping_ *= 2;
  }

  void Write(LinearResponse* response) const {
    for (std::size_t k = 0; k < 4; ++k) response->b[k] = b_[k].topLeftCorner(used_, used_);
  }

  const Eigen::Index used_, size_;
  // In units of the time that is reached.
  Matrix minus_stiffness_, minus_damping_;
  std::array<Matrix, 4> b_, doubled_;
  std::array<Matrix, 3> memory_;
};

}  // namespace tcs
