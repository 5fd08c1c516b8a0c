#include "coordinator/world/measurement_log.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "coordinator/channel/forwarding_outlet.h"
#include "coordinator/world/reading_quantities.h"

namespace tcs {

class MeasurementLog::LoggedOutlet final : public ForwardingOutlet {
 public:
  LoggedOutlet(MeasurementLog& log, const SensorChannelSpec& sensor, std::unique_ptr<Outlet> outlet)
      : ForwardingOutlet(std::move(outlet)), log_(log), sensor_(sensor) {}

  bool Send(const Reading& reading, VirtualTime arrives) override {
    log_.Write(sensor_.name, sensor_.fields, reading);
    return ForwardingOutlet::Send(reading, arrives);
  }

 private:
  MeasurementLog& log_;
  const SensorChannelSpec& sensor_;
  std::unique_ptr<Outlet> outlet_;
};

std::string MeasurementLog::Open(const std::string& path) {
  return file_.Open(path, "time_ns,channel,of,quantity,x,y,z,w");
}

std::unique_ptr<Outlet> MeasurementLog::Wrap(const SensorChannelSpec& sensor,
                                             std::unique_ptr<Outlet> outlet) {
  return std::make_unique<LoggedOutlet>(*this, sensor, std::move(outlet));
}

// A value that is not finite (nothing within reach) is left out: it is no number for programs that
// draw the file.
void MeasurementLog::Write(const std::string& channel, const std::vector<SensorField>& fields,
                           const Reading& reading) {
  if (!file_.is_open()) return;
  const std::int64_t at_ns = reading.at.ns();
  ForEachQuantity(reading, fields, [&](const ReadingQuantity& q) {
    const std::span<const double> v = q.values;
    if (!std::ranges::all_of(v, [](double value) { return std::isfinite(value); })) return;
    switch (v.size()) {
      case 1:
        file_.Line(at_ns, channel, q.of, q.title, v[0], "", "", "");
        break;
      case 3:
        file_.Line(at_ns, channel, q.of, q.title, v[0], v[1], v[2], "");
        break;
      default:
        file_.Line(at_ns, channel, q.of, q.title, v[0], v[1], v[2], v[3]);
    }
  });
}

}  // namespace tcs
