// What sensors measured, of a run that is recorded: sensors.csv, a line for each quantity of a
// sample, with its components. Not what is of hundreds of numbers: scans, clouds, images.
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
  // Until then nothing is written. Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& path);
  void Flush() { file_.Flush(); }
  [[nodiscard]] std::string Close() { return file_.Close(); }

  // Whatever is sent there is written here, too. The sensor and this outlive it.
  std::unique_ptr<Outlet> Wrap(const SensorChannelSpec& sensor, std::unique_ptr<Outlet> outlet);

  // What a sensor of bodies tells of them is in `fields`.
  void Write(const std::string& channel, const std::vector<SensorField>& fields,
             const Reading& reading);

 private:
  class LoggedOutlet;

  CsvFile file_;
};

}  // namespace tcs
