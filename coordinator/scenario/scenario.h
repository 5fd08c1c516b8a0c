// A scenario as the coordinator runs it: plain values, already checked. The YAML form is described
// in docs/SCENARIO.md; LoadScenario (load.h) is the only way in.
#pragma once

#include <signal.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/dds/qos.h"
#include "coordinator/dds/ros_names.h"
#include "coordinator/scenario/expectation_spec.h"
#include "coordinator/scenario/instruments.h"
#include "coordinator/scenario/metric_spec.h"
#include "coordinator/scenario/network_spec.h"
#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/model/joint_goal.h"
#include "simbody_bridge/model/wheel_base.h"

namespace tcs {

enum class ClientClass {
  kPeriodic,  // a controller: activated by time or data, expected to be idle again before the next
              // activation
  kBestEffort,  // a planner: computes whenever nothing more urgent wants the processor
};

// How a client's DDS samples travel.
// What programs read by rdtsc and rdtscp.
enum class CycleCounter {
  kVirtual,  // in step with the virtual time
  kHost      // the processor's own
};

enum class DdsTransport {
  kEndpoints,  // in shared memory, from writer to reader, past the network; Cyclone's
  kSockets,    // as DDS sends them, by sockets; any vendor's
};

// What the folder that a client works in is to the run.
enum class ClientFolder {
  kThere,  // it was there before
  kMade,   // in the run's results, and made if it is not there
  kFresh,  // its own in the run's results: there is nothing in it but a copy of `copied_folder`
};

// What a client waits for that is outside of the run (calls/outside_waits.h).
struct OutsideSpec {
  std::vector<std::string> names;  // absolute paths, '@' and abstract names, HOST:PORT
  VirtualDuration takes = VirtualDuration::Milliseconds(5);  // under --accounting fixed
  HostDuration patience = HostDuration::Seconds(10);         // real time, for one answer
};

struct ClientSpec {
  std::string name;  // unique in the scenario: "ROBOT/CLIENT" as written in the YAML
  std::vector<std::string> command;  // argv; command[0] is an absolute path after loading
  std::string working_directory;     // absolute; the scenario file's folder
  ClientFolder folder = ClientFolder::kThere;
  std::string copied_folder;  // absolute; empty: none
  ClientClass client_class = ClientClass::kBestEffort;
  int priority = 0;  // higher runs first on its robot
  // After each release; kEarliestDeadlineFirst schedules by it. 0: none, or its period.
  VirtualDuration deadline{};
  std::map<std::string, std::string> environment;  // added to tcsim's own
  std::optional<int> body;                         // index into world.bodies
  // What one intercepted call costs under --accounting fixed.
  VirtualDuration fixed_call_cost = VirtualDuration::Microseconds(1);
  // The same for one memory allocation; 0: nothing; none: as shm/set_costs.h has it.
  std::optional<VirtualDuration> fixed_allocation_cost;
  bool patch_vdso = true;  // reading the clock past the C library's symbols is virtual, too
  CycleCounter cycle_counter = CycleCounter::kVirtual;
  DdsTransport dds = DdsTransport::kEndpoints;
  // It is started then, and not before the client named `after` has ended, unless that is empty.
  VirtualDuration start{};
  std::string after;
  OutsideSpec outside;
  // How it is ended at the run's end: asked by the signal, and killed so much virtual time later.
  int stop_signal = SIGTERM;
  VirtualDuration stop_grace = VirtualDuration::Milliseconds(500);
};

// What its files in the run's results begin with.
inline std::string FileNameOf(const ClientSpec& client) {
  std::string name = client.name;
  std::replace(name.begin(), name.end(), '/', '-');
  return name;
}

enum class SchedulerPolicy {
  kFixedPriority,
  kEarliestDeadlineFirst,  // among clients with deadlines, which precede all others
};

struct RobotSpec {
  std::string name;
  int cores = 1;
  double speed = 1.0;  // of one core, relative to the host's
  std::vector<ClientSpec> clients;
  SchedulerPolicy scheduler = SchedulerPolicy::kFixedPriority;
  bool is_ideal = false;       // computing takes its programs no time
  bool is_ours = false;        // tcsim's own, which no scenario names (gateway/gateway_robot.h)
  double outside_speed = 1.0;  // virtual seconds for each real one that its programs wait outside
};

struct UdpEndpoint {
  std::string host = "127.0.0.1";  // IPv4 dotted quad
  std::uint16_t port = 0;
};

// The name of a UNIX socket: a file, or a name in the abstract namespace, which has no file.
struct UnixName {
  static constexpr std::size_t kLongest = 107;  // as the kernel has it

  std::string name;  // an absolute path; without the '@' of an abstract one
  bool is_abstract = false;

  std::string Text() const { return is_abstract ? "@" + name : name; }
};

// A serial device of a robot's, on a line that takes time.
struct SerialPort {
  std::string robot;
  std::string path;  // that its programs open, absolute: "/dev/ttyUSB0"
  int baud = 115'200;
  int frame_bits = 10;  // of a byte, with start, parity and stop: 8N1
  int fifo = 1;         // bytes of a line that the program gets at a time
};

// The coordinator's end of a DDS topic.
struct DdsTopicSpec {
  std::string topic;  // ROS 2's name: "/odom"
  int domain = 0;
  dds::Qos qos;
};

struct DdsSensorEnd {
  DdsTopicSpec end;
  dds::SensorMessage message = dds::SensorMessage::kOdometry;
};

struct DdsCommandEnd {
  DdsTopicSpec end;
  dds::CommandMessage message = dds::CommandMessage::kWrench;
};

// What carries a channel: an alternative for each transport (coordinator/channel/).
using SensorEnd =
    std::variant<UdpEndpoint, UnixName, SerialPort, DdsSensorEnd>;  // where readings are sent
using CommandEnd =
    std::variant<UdpEndpoint, UnixName, SerialPort, DdsCommandEnd>;  // where commands come in

// What a sensor can tell of a body. The first four are in the world's frame, the others in the
// body's, as a gyroscope and an accelerometer feel them.
enum class SensorField {
  kPosition,
  kOrientation,
  kLinearVelocity,
  kAngularVelocity,
  kAngularRate,
  kProperAcceleration,
  kCount
};
inline constexpr std::size_t kSensorFields = static_cast<std::size_t>(SensorField::kCount);
// As in scenarios and in JSON: "position".
const char* NameOf(SensorField field);

// What is wrong with the readings of a sensor, drawn from the scenario's seed. Units are the
// field's; for the orientation, radians about the body's axes.
struct FieldError {
  double noise = 0;              // standard deviation, of each reading anew
  double bias_deviation = 0;     // standard deviation of a bias that is drawn once a run
  std::array<double, 3> bias{};  // beside that one

  // A bias that is drawn once is as unknown as the noise.
  double Variance() const { return noise * noise + bias_deviation * bias_deviation; }
  // Nothing is wrong.
  bool IsExact() const {
    return noise == 0 && bias_deviation == 0 && bias == std::array<double, 3>{};
  }
};
struct SensorErrors {
  std::array<FieldError, kSensorFields> fields{};
  std::array<FieldError, kJointQuantities.size()> joints{};  // of each joint, by JointQuantity
  double dropout = 0;        // the share of the samples that never arrive
  VirtualDuration jitter{};  // the most that a reading comes later than its latency says
  std::uint64_t seed = 0;    // of this sensor
};

using MeasurementErrors = std::array<FieldError, kMeasuredFields>;

// Joints of a model that have one coordinate.
struct JointGroup {
  std::string model;
  std::vector<int> joints;         // as Dynamics numbers them
  std::vector<std::string> names;  // of each
  // Of the model's joints that follow others, which nobody drives, but which commands may name.
  std::vector<std::string> followers{};
};

// The firmware of a robot with driven wheels: what comes in is how fast it is to go.
struct WheelDriveSpec {
  WheelBase base;
  std::size_t left = 1;       // of the joints, so many are wheels on the left; they come first
  double most_radps = 0;      // of any wheel
  VirtualDuration timeout{};  // after which without a command it stops; 0: never
};

// Joints that a channel drives, and with what.
struct JointDriveSpec {
  JointGroup group;
  JointQuantity quantity = JointQuantity::kEffort;  // what a number without a name is
  std::vector<JointGains> gains;                    // of each joint
  std::vector<JointLimits> limits{};                // likewise: what is wanted is kept within them
  VirtualDuration lag{};                            // Joint::drive_lag of all of them
  std::optional<WheelDriveSpec> wheels;             // which they are, or
  // Trajectories come in, and the servos have new setpoints so often.
  std::optional<VirtualDuration> setpoint_period;
};

// Rotors of a model that a channel drives.
struct RotorDriveSpec {
  std::string model;
  std::vector<int> rotors;         // as Dynamics numbers them
  std::vector<std::string> names;  // of each
  std::vector<double> most_radps;  // likewise
  bool is_normalised = false;      // a command is a share of the most that the rotor can do
};

// A link of a model that a channel pushes.
struct LinkTarget {
  std::string name;  // "drone/base_link"
  int link = 0;      // as Dynamics numbers it
};

// The state of `bodies`, sampled every `period` from time 0 on and sent so that it arrives
// `latency` later.
struct SensorChannelSpec {
  std::string name;
  std::vector<int> bodies;           // indices into world.bodies; at least one, or
  std::optional<JointGroup> joints;  // or
  std::optional<InstrumentSpec> instrument;
  MeasurementErrors measurement_errors{};  // of that; seed, losses and lateness are in `errors`
  VirtualDuration period = VirtualDuration::Milliseconds(10);
  VirtualDuration latency{};
  SensorErrors errors;
  SensorEnd to;
  // For channels on JSON.
  std::vector<SensorField> fields = {SensorField::kPosition, SensorField::kOrientation,
                                     SensorField::kLinearVelocity, SensorField::kAngularVelocity};
};

inline constexpr std::array<double, 3> kNoWrenchLimit = {std::numeric_limits<double>::infinity(),
                                                         std::numeric_limits<double>::infinity(),
                                                         std::numeric_limits<double>::infinity()};

// What comes in are wrenches for `body`, applied at the virtual time of the send plus `latency`.
struct CommandChannelSpec {
  std::string name;
  int body = 0;                          // or one of these, of a model:
  std::optional<LinkTarget> link;        // which they push
  std::optional<JointDriveSpec> joints;  // which they drive
  std::optional<RotorDriveSpec> rotors;
  VirtualDuration latency{};
  // The most of each component, either way.
  std::array<double, 3> most_force_n = kNoWrenchLimit, most_torque_nm = kNoWrenchLimit;
  bool in_body_frame = false;  // the components are along the axes of the body, or of the link
  VirtualDuration lag{};       // Wrench's
  CommandEnd from;

  bool IsOfModel() const { return link || joints || rotors; }
};

// The virtual time as a topic, every `period` from time 0 on.
struct ClockSpec {
  DdsTopicSpec end;
  VirtualDuration period = VirtualDuration::Milliseconds(10);
};

// How old a sensor's samples may be when a command that knows of them acts.
struct ChainSpec {
  std::string name;
  std::size_t sensor = 0, command = 0;  // places in `sensors` and `commands`
  std::vector<std::string> through;     // ROBOT/CLIENT; none: by whatever way
  VirtualDuration deadline{};           // 0: none
};

struct Scenario {
  std::string name;
  std::string path;              // of the YAML file; empty for `tcsim exec`
  std::vector<std::string> set;  // what --overlay and --set have put in the file's stead
  VirtualDuration duration = VirtualDuration::Seconds(10);
  VirtualDuration drift_bound = VirtualDuration::Milliseconds(1);
  std::optional<HostDuration> patience;  // none: by why it has to be patient (patience.h)
  std::uint64_t seed = 1;
  std::optional<WorldSpec> world;                 // none: no dynamics
  std::map<std::string, std::string> urdf_files;  // of the models that come from such
  // Of these what xacro has made of the file, where it has.
  std::map<std::string, std::string> urdf_expanded;
  // Of these the folders, in `packages`, that their meshes' packages may be in.
  std::map<std::string, std::vector<std::string>> urdf_packages;
  std::vector<RobotSpec> robots;
  std::optional<NetworkSpec> network;  // none: all robots share the host's
  std::vector<SensorChannelSpec> sensors;
  std::vector<CommandChannelSpec> commands;
  std::vector<ChainSpec> chains;
  std::optional<ClockSpec> clock;
  dds::RosRelease ros = dds::RosRelease::kIron;  // in whose form graph tools are told of nodes
  VirtualDuration csv_period =
      VirtualDuration::Milliseconds(10);  // of the body states written to DIR
  bool csv_contacts = false;              // contact forces are written, too
  std::vector<MetricSpec> metrics;        // what the run is to be measured by
  std::vector<ExpectationSpec> expectations;
  std::size_t not_judged = 0;            // how many more begin after the end that was asked for
  std::vector<MetricSpec> kept;          // what some of these are of, in the order of their numbers
  std::vector<QuantitySpec> quantities;  // that metrics and these are of
  // What can be run and is hardly what was meant: a sentence each, with its place.
  std::vector<std::string> warnings;
  // What a warning says of one thing, of each: for `tcsim check -v`.
  std::vector<std::string> details;
};

}  // namespace tcs
