// Which things touch each other, and with which force, as lines of contacts.csv.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coordinator/trace/csv_file.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

class ContactLines {
 public:
  ContactLines() = default;
  explicit ContactLines(const WorldSpec& world);

  // A line for each contact that pushes at dynamics.Now() (Dynamics::ReadContacts).
  void Write(Dynamics& dynamics, CsvFile* file);

 private:
  std::vector<std::string> links_, fixtures_;  // names
  std::vector<ContactForce> contacts_;         // memory of Write
};

// The force that `first` feels from `second`, at x y z: the normal points towards `first`.
inline constexpr std::string_view kContactsCsvHead =
    "time_s,first,second,x_m,y_m,z_m,normal_x,normal_y,normal_z,force_x_n,force_y_n,force_z_n";

}  // namespace tcs
