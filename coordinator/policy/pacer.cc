#include "coordinator/policy/pacer.h"

#include <algorithm>

namespace tcs {

Pacer::Pacer(double pace, bool stands) : pace_(pace), limit_ns_(stands ? -1 : kForEver) {}

void Pacer::StartFrom(std::int64_t real_ns) {
  has_origin_ = true;
  origin_real_ns_ = real_ns;
  origin_ns_ = now_ns_;
  behind_ns_ = 0;
}

void Pacer::SetPace(double pace, std::int64_t real_ns) {
  pace_ = pace;
  StartFrom(real_ns);
}

void Pacer::Stand(std::int64_t real_ns) {
  limit_ns_ = std::min(limit_ns_, now_ns_);
  StartFrom(real_ns);
}

void Pacer::GoOn(std::int64_t real_ns) {
  limit_ns_ = kForEver;
  StartFrom(real_ns);
}

void Pacer::StepBy(std::int64_t ns, std::int64_t real_ns) {
  const std::int64_t from_ns = limit_ns_ == kForEver ? now_ns_ : std::max(limit_ns_, now_ns_);
  limit_ns_ = from_ns > kForEver - ns ? kForEver - 1 : from_ns + ns;
  StartFrom(real_ns);
}

// Since the run asked last it was behind, or stood, as it was then.
void Pacer::TakeAccount(std::int64_t behind_ns, std::int64_t real_ns) {
  const std::int64_t passed_ns = real_ns - asked_real_ns_;
  if (stands_) account_.stood_ns += passed_ns;
  if (!stands_ && behind_ns_ > kToleranceNs) account_.behind_ns += passed_ns;
  asked_real_ns_ = real_ns;
  behind_ns_ = behind_ns;
  account_.most_ns = std::max(account_.most_ns, behind_ns);
}

std::int64_t Pacer::ToWait(std::int64_t next_ns, std::int64_t real_ns) {
  if (!has_origin_) {
    asked_real_ns_ = real_ns;
    StartFrom(real_ns);
  }
  // What would be due later than where it stands waits for the wall clock, too, before it stands.
  const std::int64_t until_ns = std::min(next_ns, std::max<std::int64_t>(limit_ns_, 0));
  const double ahead_ns = static_cast<double>(until_ns - origin_ns_);
  const auto due_real_ns =
      pace_ > 0 ? origin_real_ns_ + static_cast<std::int64_t>(ahead_ns / pace_) : real_ns;
  if (real_ns < due_real_ns) {
    TakeAccount(0, real_ns);
    stands_ = false;
    const double passed = static_cast<double>(real_ns - origin_real_ns_) * pace_;
    now_ns_ = std::max(now_ns_, std::min(until_ns, origin_ns_ + static_cast<std::int64_t>(passed)));
    return due_real_ns - real_ns;
  }
  now_ns_ = std::max(now_ns_, until_ns);
  if (next_ns > limit_ns_) {
    TakeAccount(0, real_ns);
    stands_ = true;
    return kForEver;
  }
  TakeAccount(real_ns - due_real_ns, real_ns);
  stands_ = false;
  if (const std::int64_t too_much_ns = behind_ns_ - kMostMadeUpNs; too_much_ns > 0) {
    account_.given_up_ns += too_much_ns;
    origin_real_ns_ += too_much_ns;
    behind_ns_ -= too_much_ns;
  }
  return 0;
}

}  // namespace tcs
