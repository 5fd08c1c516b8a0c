// The commands of a run, as they were given to the physics: commands.csv, a line for each quantity.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "coordinator/trace/csv_file.h"
#include "shm/virtual_time.h"

namespace tcs {

class CommandLog {
 public:
  // The times of one channel's command.
  struct Moment {
    VirtualTime sent;
    VirtualDuration latency;
  };

  // The listener gets every quantity that is written, also while there is no file.
  using Listener =
      std::function<void(Moment moment, std::string_view channel, std::string_view target,
                         std::string_view quantity, double value)>;
  void Tell(Listener listener) { listener_ = std::move(listener); }

  // Empty on success, else one sentence. Before Open nothing is written.
  [[nodiscard]] std::string Open(const std::string& path);
  void Write(Moment moment, std::string_view channel, std::string_view target,
             std::string_view quantity, double value) {
    file_.Line(moment.sent.ns(), (moment.sent + moment.latency).ns(), channel, target, quantity,
               value);
    if (listener_) listener_(moment, channel, target, quantity, value);
  }
  void Flush() { file_.Flush(); }
  [[nodiscard]] std::string Close() { return file_.Close(); }

 private:
  CsvFile file_;
  Listener listener_;
};

}  // namespace tcs
