// The measurements of the sensors in a run that is recorded: sensors.csv, a line for each quantity
// of a sample, with its components. Measurements of hundreds of numbers are left out: scans,
// clouds, images.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/trace/csv_file.h"

namespace tcs {

class MeasurementLog {
 public:
  // Before Open nothing is written. Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& path);
  void Flush() { file_.Flush(); }
  [[nodiscard]] std::string Close() { return file_.Close(); }

  // An outlet whose readings are written here, too. The sensor and the log outlive the outlet.
  std::unique_ptr<Outlet> Wrap(const SensorChannelSpec& sensor, std::unique_ptr<Outlet> outlet);

  // `fields` are the quantities that a sensor of bodies tells of them.
  void Write(const std::string& channel, const std::vector<SensorField>& fields,
             const Reading& reading);

 private:
  class LoggedOutlet;

  CsvFile file_;
};

}  // namespace tcs
