#include "simbody_bridge/joints/linear_response.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace tcs {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The series begin where stiffness and damping are no more than this, and have so many terms: the
// next one is below 1e-15.
constexpr double kSmall = 0.25;
constexpr int kTerms = 10;

// The greatest sum of a row.
double NormOf(const MatrixXd& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

constexpr std::array<double, 6> kFactorials = {1, 1, 2, 6, 24, 120};

// phi_2 to phi_5 of `z`, which is not positive.
std::array<double, 4> PhiFrom2(double z) {
  std::array<double, 6> phi{};
  if (z > -1) {
    // The series of phi_5: the next term is below 1e-17.
    double term = 1 / kFactorials[5];
    for (int k = 6; k < 22; ++k) {
      phi[5] += term;
      term *= z / k;
    }
    for (std::size_t k = 5; k > 2; --k) phi[k - 1] = 1 / kFactorials[k - 1] + z * phi[k];
  } else {
    phi[0] = std::exp(z);
    for (std::size_t k = 0; k < 5; ++k) phi[k + 1] = (phi[k] - 1 / kFactorials[k]) / z;
  }
  return {phi[2], phi[3], phi[4], phi[5]};
}

// The sum of shares[i] * B_{first + i} * pushes[i].
VectorXd Answer(const LinearResponse& response, std::size_t first,
                const std::array<const VectorXd*, 3>& pushes) {
  constexpr std::array<double, 3> kShares = {1, 1, 2};
  const DampedModes& modes = *response.modes;
  VectorXd answer = VectorXd::Zero(pushes[0]->size());
  VectorXd by_mode = VectorXd::Zero(modes.rates.size());
  for (std::size_t i = 0; i < 3; ++i) {
    answer += kShares[i] / kFactorials[first + i + 1] * *pushes[i];
    by_mode.array() +=
        kShares[i] * response.of_mode[first + i].array() * (modes.from * *pushes[i]).array();
  }
  answer.noalias() += modes.onto * by_mode;
  return answer;
}

}  // namespace

void FindModes(const MatrixXd& by_mass, const VectorXd& dampers, DampedModes* modes) {
  std::vector<Eigen::Index> damped;
  for (Eigen::Index i = 0; i < dampers.size(); ++i) {
    if (dampers[i] > 0) damped.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(damped.size());
  modes->rates.resize(count);
  modes->onto.resize(dampers.size(), count);
  modes->from.setZero(count, dampers.size());
  if (damped.empty()) return;
  const VectorXd roots = dampers(damped).cwiseSqrt();
  MatrixXd onto = by_mass(Eigen::all, damped);
  onto *= roots.asDiagonal();
  MatrixXd each = onto(damped, Eigen::all);
  each = roots.asDiagonal() * each;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solved(each);
  modes->rates = solved.eigenvalues().cwiseMax(0);
  modes->onto = onto * solved.eigenvectors();
  for (Eigen::Index i = 0; i < count; ++i) {
    modes->from.col(damped[static_cast<std::size_t>(i)]) =
        roots[i] * solved.eigenvectors().row(i).transpose();
  }
}

// As phi_{k+1}(z) - 1 / (k+1)! = z phi_{k+2}(z).
void FindResponse(const DampedModes& modes, double seconds, LinearResponse* response) {
  response->seconds = seconds;
  response->modes = &modes;
  for (VectorXd& of_mode : response->of_mode) of_mode.resize(modes.rates.size());
  for (Eigen::Index i = 0; i < modes.rates.size(); ++i) {
    const std::array<double, 4> phi = PhiFrom2(-seconds * modes.rates[i]);
    for (std::size_t k = 0; k < 4; ++k) response->of_mode[k][i] = -seconds * phi[k];
  }
}

VectorXd LinearResponse::Way(const VectorXd& f0, const VectorXd& f1, const VectorXd& f2) const {
  if (modes != nullptr) return seconds * seconds * Answer(*this, 1, {&f0, &f1, &f2});
  return seconds * seconds * (b[1] * f0 + b[2] * f1 + 2 * (b[3] * f2));
}

VectorXd LinearResponse::Speed(const VectorXd& f0, const VectorXd& f1, const VectorXd& f2) const {
  if (modes != nullptr) return seconds * Answer(*this, 0, {&f0, &f1, &f2});
  return seconds * (b[0] * f0 + b[1] * f1 + 2 * (b[2] * f2));
}

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
  whole->modes = nullptr;
  if (half != nullptr) {
    half->seconds = seconds / 2;
    half->modes = nullptr;
  }
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
