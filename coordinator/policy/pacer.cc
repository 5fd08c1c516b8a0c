#include "coordinator/policy/pacer.h"

#include <algorithm>

namespace tcs {

Pacer::Pacer(double pace, bool stands)
    : pace_(pace), limit_(stands ? RobotTime(-1) : VirtualTime::Never()) {}

void Pacer::StartFrom(HostTime real) {
  has_origin_ = true;
  origin_real_ = real;
  origin_ = now_;
  behind_ = {};
  if (is_loading_) began_loading_ = real;
}

void Pacer::SetPace(double pace, HostTime real) {
  pace_ = pace;
  StartFrom(real);
}

void Pacer::Stand(HostTime real) {
  limit_ = std::min(limit_, now_);
  StartFrom(real);
}

void Pacer::GoOn(HostTime real) {
  limit_ = VirtualTime::Never();
  StartFrom(real);
}

void Pacer::StepBy(VirtualDuration step, HostTime real) {
  const VirtualTime from = limit_.IsNever() ? now_ : std::max(limit_, now_);
  // However long a step is it has an end.
  limit_ = std::min(AtMostNever(from, step), RobotTime(VirtualTime::Never().ns() - 1));
  StartFrom(real);
}

// Since the run asked last it was behind, or stood, as it was then.
void Pacer::TakeAccount(HostDuration behind, HostTime real) {
  const HostDuration passed = real - asked_real_;
  if (stands_) account_.stood += passed;
  if (!stands_ && behind_ > kTolerance) account_.behind += passed;
  asked_real_ = real;
  behind_ = behind;
  account_.most = std::max(account_.most, behind);
}

HostDuration Pacer::ToWait(VirtualTime next, HostTime real) {
  if (!has_origin_) {
    asked_real_ = real;
    StartFrom(real);
  }
  // A run whose next act is later than `limit_` also waits for the wall clock to reach `limit_`
  // before it stands.
  const VirtualTime until = std::min(next, std::max(limit_, VirtualTime()));
  const auto ahead_ns = static_cast<double>((until - origin_).ns());
  HostTime due = real;
  HostTime may_act = real;
  if (pace_ > 0) {
    due = origin_real_ + HostNs(static_cast<std::int64_t>(ahead_ns / pace_));
    may_act = due - kHeadStart;
  }
  if (real < may_act) {
    is_loading_ = false;
    TakeAccount({}, real);
    stands_ = false;
    const double passed = static_cast<double>((real - origin_real_).ns()) * pace_;
    now_ = std::max(now_, std::min(until, origin_ + VirtualNs(static_cast<std::int64_t>(passed))));
    return may_act - real;
  }
  if (is_loading_ && real - began_loading_ <= kMostMadeUp) {
    origin_real_ += real - may_act;
    due += real - may_act;
  }
  now_ = std::max(now_, until);
  if (next > limit_) {
    TakeAccount({}, real);
    stands_ = true;
    return kForEver;
  }
  TakeAccount(std::max(HostDuration(), real - due), real);
  stands_ = false;
  if (const HostDuration too_much = behind_ - kMostMadeUp; too_much > HostDuration()) {
    account_.given_up += too_much;
    origin_real_ += too_much;
    behind_ -= too_much;
  }
  return {};
}

}  // namespace tcs
