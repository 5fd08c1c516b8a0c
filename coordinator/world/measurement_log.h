// What sensors measured, of a run that is recorded: sensors.csv, a line for each quantity of a
// sample, with its components. Not what is of hundreds of numbers: scans, clouds, images.
#pragma once

#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
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
  struct Of {
    VirtualTime at;
    const std::string& channel;
    std::string_view name;  // of the body, the joint or the frame
  };
  void Line(const Of& of, std::string_view quantity, std::initializer_list<double> values);
  template <std::size_t n>
  void Line(const Of& of, std::string_view quantity, const std::array<double, n>& values);
  void WriteBody(const Of& of, const std::vector<SensorField>& fields, const BodyReading& body);
  void WriteMeasured(VirtualTime at, const std::string& channel, const Measurement& measured);

  CsvFile file_;
};

}  // namespace tcs
