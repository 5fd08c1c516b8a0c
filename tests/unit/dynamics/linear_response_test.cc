// Springs and dampers that are pushed: closed forms, and many small steps.
#include "simbody_bridge/joints/linear_response.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "simbody_bridge/joints/spring_response.h"

namespace tcs {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd One(double x) { return MatrixXd::Constant(1, 1, x); }

LinearResponse Respond(const MatrixXd& stiffness, const MatrixXd& damping, double seconds) {
  LinearResponse response;
  FindResponse(stiffness, damping, seconds, &response, nullptr);
  return response;
}

TEST(LinearResponse, IsThatOfABodyInTheOpenWithoutSpringsAndDampers) {
  const LinearResponse response = Respond(One(0), One(0), 0.5);
  const VectorXd f0 = One(2), f1 = One(3), f2 = One(5);
  EXPECT_NEAR(response.Way(f0, f1, f2)[0], 0.25 * (2 / 2.0 + 3 / 6.0 + 5 / 12.0), 1e-15);
  EXPECT_NEAR(response.Speed(f0, f1, f2)[0], 0.5 * (2 + 3 / 2.0 + 5 / 3.0), 1e-15);
}

TEST(LinearResponse, OfADamperIsItsApproachToTheFinalSpeed) {
  const VectorXd f = One(7), none = One(0);
  for (const double rate : {0.1, 3.0, 500.0, 1e6}) {
    const LinearResponse response = Respond(One(0), One(rate), 0.02);
    const double speed = -7 / rate * std::expm1(-0.02 * rate);
    EXPECT_NEAR(response.Speed(f, none, none)[0] / speed, 1, 1e-12) << rate;
    EXPECT_NEAR(response.Way(f, none, none)[0], (7 * 0.02 - speed) / rate, 1e-12 / rate) << rate;
  }
}

// Below, at and above critical damping.
TEST(LinearResponse, OfASpringIsItsClosedForm) {
  constexpr double kRadps = 40, kSeconds = 0.2;
  const VectorXd f = One(kRadps * kRadps), none = One(0);
  for (const double ratio : {0.0, 0.3, 1.0, 4.0, 100.0}) {
    const LinearResponse response =
        Respond(One(kRadps * kRadps), One(2 * ratio * kRadps), kSeconds);
    const double decay = std::exp(-ratio * kRadps * kSeconds);
    double way = 0, speed = 0;
    if (ratio < 1) {
      const double swing = kRadps * std::sqrt(1 - ratio * ratio), turned = swing * kSeconds;
      way = 1 - decay * (std::cos(turned) + ratio * kRadps / swing * std::sin(turned));
      speed = kRadps * kRadps / swing * decay * std::sin(turned);
    } else if (ratio == 1) {
      way = 1 - decay * (1 + kRadps * kSeconds);
      speed = kRadps * kRadps * kSeconds * decay;
    } else {
      const double apart = kRadps * std::sqrt(ratio * ratio - 1);
      const double fast = -ratio * kRadps - apart, slow = kRadps * kRadps / fast;
      way = 1 + (fast * std::exp(slow * kSeconds) - slow * std::exp(fast * kSeconds)) / (2 * apart);
      speed = slow * fast * (std::exp(slow * kSeconds) - std::exp(fast * kSeconds)) / (2 * apart);
    }
    EXPECT_NEAR(response.Way(f, none, none)[0], way, 1e-12) << ratio;
    EXPECT_NEAR(response.Speed(f, none, none)[0], speed, 1e-10) << ratio;
  }
}

// As a light wrist hangs on a heavy shoulder: by masses of which one is a thousandth of the other.
struct Coupled {
  MatrixXd stiffness, damping;
};
Coupled MakeCoupled() {
  MatrixXd mass(3, 3);
  mass << 3, 0.2, 0.01, 0.2, 0.05, 0.004, 0.01, 0.004, 0.002;
  const MatrixXd by_mass = mass.inverse();
  return {by_mass * Eigen::Vector3d(300, 60, 5).asDiagonal(),
          by_mass * Eigen::Vector3d(20, 0, 0.7).asDiagonal()};
}

TEST(LinearResponse, OfCoupledJointsIsThatOfManySmallSteps) {
  const auto [stiffness, damping] = MakeCoupled();
  const VectorXd f0 = Eigen::Vector3d(1, -2, 3), f1 = Eigen::Vector3d(10, 5, -40),
                 f2 = Eigen::Vector3d(-3, 8, 20);
  constexpr double kSeconds = 0.03;
  const LinearResponse response = Respond(stiffness, damping, kSeconds);
  VectorXd x = VectorXd::Zero(3), v = VectorXd::Zero(3);
  constexpr int kSteps = 20000;
  const double h = kSeconds / kSteps;
  const auto rate = [&](double s, const VectorXd& at, const VectorXd& speed) -> VectorXd {
    return f0 + s * f1 + s * s * f2 - stiffness * at - damping * speed;
  };
  for (int i = 0; i < kSteps; ++i) {  // Runge-Kutta 4
    const double s = 1.0 * i / kSteps, half = 0.5 / kSteps;
    const VectorXd a = rate(s, x, v), va = v;
    const VectorXd vb = v + h / 2 * a, b = rate(s + half, x + h / 2 * va, vb);
    const VectorXd vc = v + h / 2 * b, c = rate(s + half, x + h / 2 * vb, vc);
    const VectorXd vd = v + h * c, d = rate(s + 2 * half, x + h * vc, vd);
    x += h / 6 * (va + 2 * vb + 2 * vc + vd);
    v += h / 6 * (a + 2 * b + 2 * c + d);
  }
  EXPECT_LT((response.Way(f0, f1, f2) - x).norm(), 1e-11 * x.norm());
  EXPECT_LT((response.Speed(f0, f1, f2) - v).norm(), 1e-11 * v.norm());
}

// By the mass of a chain whose links are lighter the further out they are.
Coupled MakeChain(int size) {
  MatrixXd lower = MatrixXd::Identity(size, size);
  VectorXd springs(size), dampers(size);
  for (int i = 0; i < size; ++i) {
    for (int k = 0; k < i; ++k) lower(i, k) = 0.3 + 0.1 * ((3 * i + 5 * k) % 7);
    lower.row(i) /= 1 + i;
    springs[i] = 100 * (i % 3);
    dampers[i] = 0.4 * (i % 4);
  }
  const MatrixXd by_mass = (lower.transpose() * lower).inverse();
  return {by_mass * springs.asDiagonal(), by_mass * dampers.asDiagonal()};
}

// Sizes have code of their own: it finds what that for any size does.
TEST(LinearResponse, OfAnyNumberOfJointsIsFoundInTheSameWay) {
  for (int size = 1; size <= 12; ++size) {
    const auto [stiffness, damping] = MakeChain(size);
    for (const double seconds : {1e-5, 1e-2, 0.3}) {
      LinearResponse whole, half, expected, expected_half;
      FindResponse(stiffness, damping, seconds, &whole, &half);
      SpringResponse<Eigen::Dynamic>(stiffness, damping, seconds).Find(&expected, &expected_half);
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_EQ(whole.b[k].rows(), size);
        EXPECT_LT((whole.b[k] - expected.b[k]).norm(), 1e-10 * expected.b[k].norm()) << size;
        EXPECT_LT((half.b[k] - expected_half.b[k]).norm(), 1e-10 * expected_half.b[k].norm());
      }
    }
  }
}

TEST(LinearResponse, ToHalfAPushIsFoundOnTheWay) {
  const auto [stiffness, damping] = MakeCoupled();
  for (const double seconds : {1e-6, 1e-3, 0.5}) {
    LinearResponse whole, half;
    FindResponse(stiffness, damping, seconds, &whole, &half);
    const LinearResponse alone = Respond(stiffness, damping, seconds / 2);
    EXPECT_EQ(half.seconds, seconds / 2);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT((half.b[k] - alone.b[k]).norm(), 1e-13 * alone.b[k].norm()) << seconds;
    }
  }
}

TEST(LinearResponse, AfterALongTimeIsWhereTheSpringsHoldThePush) {
  const auto [stiffness, damping] = MakeCoupled();
  const VectorXd f = Eigen::Vector3d(1, -2, 3), none = VectorXd::Zero(3);
  const LinearResponse response = Respond(stiffness, damping, 100);
  EXPECT_LT((response.Way(f, none, none) - stiffness.inverse() * f).norm(), 1e-10);
  EXPECT_LT(response.Speed(f, none, none).norm(), 1e-9);
}

TEST(LinearResponse, SaysThatNumbersAreTooLarge) {
  const LinearResponse response = Respond(One(1e300), One(1), 1e30);
  EXPECT_TRUE(std::isnan(response.b[1](0, 0)));
}

}  // namespace
}  // namespace tcs
