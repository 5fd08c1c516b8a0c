#include "simbody_bridge/simbody/tree/linear_response.h"

#include <cmath>
#include <limits>
#include <utility>

namespace tcs {
namespace {

using Eigen::MatrixXd;

// The series begin where stiffness and damping are no more than this, and have so many terms: the
// next one is below 1e-15.
constexpr double kSmall = 0.25;
constexpr int kTerms = 10;

// The greatest sum of a row.
double NormOf(const MatrixXd& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

}  // namespace

// phi_k(z) = 1 / k! + z phi_{k+1}(z), whose upper right block is, as z's upper half is (0 1) and as
// phi_{k+1}(z) and z commute, B_k = 1 / (k+1)! - B_{k+1} D - B_{k+2} K.
void ResponseFinder::Begin(int size) {
  double factorial = 1;
  for (int k = 2; k <= kTerms + 2; ++k) factorial *= k;
  const auto one = [size] { return MatrixXd::Identity(size, size); };
  over_next_ = one() / (factorial * (kTerms + 3));
  next_ = one() / factorial;
  for (int k = kTerms; k >= 0; --k) {
    factorial /= k + 2;
    term_.noalias() = next_ * damping_;
    term_.noalias() += over_next_ * stiffness_;
    term_ = -term_;
    term_.diagonal().array() += 1 / factorial;
    if (k < 4) b_[static_cast<std::size_t>(k)] = term_;
    std::swap(over_next_, next_);
    std::swap(next_, term_);
  }
}

// phi_k(2 z) = (e^z phi_k(z) + sum of phi_j(z) / (k-j)! for j from 1 to k) / 2^k. The lower right
// block of phi_k(z) is B_{k-1}. The unit of time becomes twice as long, which makes half of each
// B_k.
void ResponseFinder::Double() {
  term_.noalias() = b_[0] * damping_;
  next_ = a_ - term_;  // the lower right block of the exponential
  doubled_[0].noalias() = a_ * b_[0];
  doubled_[0].noalias() += b_[0] * next_;
  for (std::size_t k = 1; k < 4; ++k) {
    doubled_[k].noalias() = a_ * b_[k];
    doubled_[k].noalias() += b_[0] * b_[k - 1];
    doubled_[k] += b_[k];
  }
  doubled_[2] += b_[1];
  doubled_[3] += b_[2] + b_[1] / 2;
  for (std::size_t k = 0; k < 4; ++k) {
    doubled_[k] *= std::ldexp(1.0, -static_cast<int>(k) - 1);
    std::swap(b_[k], doubled_[k]);
  }
  stiffness_ *= 4;
  damping_ *= 2;
}

void ResponseFinder::Find(const MatrixXd& stiffness, const MatrixXd& damping, double seconds,
                          LinearResponse* whole, LinearResponse* half) {
  const int size = static_cast<int>(stiffness.rows());
  stiffness_ = seconds * seconds * stiffness;
  damping_ = seconds * damping;
  whole->seconds = seconds;
  if (half != nullptr) half->seconds = seconds / 2;
  double stiff = NormOf(stiffness_), damped = NormOf(damping_);
  if (!std::isfinite(stiff) || !std::isfinite(damped)) {
    for (LinearResponse* response : {whole, half}) {
      if (response == nullptr) continue;
      for (MatrixXd& b : response->b) {
        b.setConstant(size, size, std::numeric_limits<double>::quiet_NaN());
      }
    }
    return;
  }
  int doublings = half != nullptr ? 1 : 0;
  stiff = std::ldexp(stiff, -2 * doublings);
  damped = std::ldexp(damped, -doublings);
  for (; stiff > kSmall || damped > kSmall; ++doublings) stiff /= 4, damped /= 2;
  stiffness_ *= std::ldexp(1.0, -2 * doublings);
  damping_ *= std::ldexp(1.0, -doublings);
  Begin(size);
  for (; doublings > 0; --doublings) {
    if (doublings == 1 && half != nullptr) half->b = b_;
    // As phi_0(z) = 1 + z phi_1(z).
    a_.noalias() = b_[1] * stiffness_;
    a_ = -a_;
    a_.diagonal().array() += 1;
    Double();
  }
  whole->b = b_;
}

}  // namespace tcs
