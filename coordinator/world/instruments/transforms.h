// The reports of a robot's state publisher: where the robot's links are, and of which file it is.
#pragma once

#include <utility>
#include <vector>

#include "coordinator/world/instruments/instrument.h"

namespace tcs {

class Transforms final : public Instrument {
 public:
  explicit Transforms(const TransformsSpec& spec);
  std::span<const int> links() const override { return links_; }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // of places in `links_`
  std::vector<int> links_;                                  // each link once
  std::vector<LinkState> states_;                           // and the world's
  TransformsMeasurement measured_;
};

class Description final : public Instrument {
 public:
  explicit Description(const DescriptionSpec& spec) : measured_{spec.text} {}
  void Look(int, VirtualTime, const Eyes&) override {}
  Measurement Finish() override { return measured_; }

 private:
  DescriptionMeasurement measured_;
};

}  // namespace tcs
