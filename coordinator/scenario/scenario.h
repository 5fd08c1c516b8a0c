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
#include "coordinator/prices/price_list.h"
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

// The counter that programs read by rdtsc and rdtscp.
enum class CycleCounter {
  kVirtual,  // in step with the virtual time
  kHost      // the processor's own
};

// How a client's DDS samples travel.
enum class DdsTransport {
  kEndpoints,  // in shared memory, from writer to reader, past the network; Cyclone's
  kSockets,    // as DDS sends them, by sockets; any vendor's
};

// The folder that a client works in, as the run sees it.
enum class ClientFolder {
  kThere,  // the folder was there before
  kMade,   // in the run's results, and made if it is not there
  kFresh,  // the client's own in the run's results: only a copy of `copied_folder` is in it
};

// The things outside of the run that a client waits for (calls/outside_waits.h).
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
  // The deadline after each release; kEarliestDeadlineFirst schedules by it. 0: none, or the
  // client's period.
  VirtualDuration deadline{};
  std::map<std::string, std::string> environment;  // added to tcsim's own
  std::optional<int> body;                         // index into world.bodies
  // The cost of one intercepted call under --accounting fixed.
  VirtualDuration fixed_call_cost = VirtualDuration::Microseconds(1);
  // The cost of one memory allocation; 0: nothing; none: as shm/set_costs.h has it.
  std::optional<VirtualDuration> fixed_allocation_cost;
  bool patch_vdso = true;  // reading the clock past the C library's symbols is virtual, too
  CycleCounter cycle_counter = CycleCounter::kVirtual;
  DdsTransport dds = DdsTransport::kEndpoints;
  // The client is started at `start`, and not before the client named `after` has ended, unless
  // `after` is empty.
  VirtualDuration start{};
  std::string after;
  OutsideSpec outside;
  // How the client is ended at the run's end: asked by the signal, and killed so much virtual time
  // later.
  int stop_signal = SIGTERM;
  VirtualDuration stop_grace = VirtualDuration::Milliseconds(500);
};

// The beginning of the names of the client's files in the run's results.
inline std::string FileNameOf(const ClientSpec& client) {
  std::string name = client.name;
  std::replace(name.begin(), name.end(), '/', '-');
  return name;
}

enum class SchedulerPolicy {
  kFixedPriority,
  kEarliestDeadlineFirst,  // among clients with deadlines, which precede all others
};

// How long after an event a thread that has waited for it is ready, as on a real kernel: at random,
// half of the times up to `median` and 99 of 100 up to `p99`.
struct WakeupSpec {
  static constexpr VirtualDuration kLongest = VirtualDuration::Seconds(1);

  VirtualDuration median, p99;  // 0: none; p99 is not below the median
};

struct RobotSpec {
  std::string name;
  int cores = 1;
  double speed = 1.0;  // of one core, relative to the host's
  WakeupSpec wakeup;
  PriceList prices = ShippedPrices();  // of work of which tcs spares its programs
  bool prices_are_hosts = true;        // of a computer like the host, rather than the robot's own
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
  std::string path;  // absolute, as the robot's programs open it: "/dev/ttyUSB0"
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

// The transport that carries a channel: an alternative for each (coordinator/channel/).
using SensorEnd =
    std::variant<UdpEndpoint, UnixName, SerialPort, DdsSensorEnd>;  // where readings are sent
using CommandEnd =
    std::variant<UdpEndpoint, UnixName, SerialPort, DdsCommandEnd>;  // where commands come in

// A quantity that a sensor can tell of a body. The first four quantities are in the world's frame,
// the others in the body's, as a gyroscope and an accelerometer feel them.
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

// The error of the readings of a sensor, drawn from the scenario's seed. Units are the field's; for
// the orientation, radians about the body's axes.
struct FieldError {
  double noise = 0;              // standard deviation, of each reading anew
  double bias_deviation = 0;     // standard deviation of a bias that is drawn once a run
  std::array<double, 3> bias{};  // beside the drawn bias

  // A bias that is drawn once is as unknown as the noise.
  double Variance() const { return noise * noise + bias_deviation * bias_deviation; }
  // True if nothing is wrong with the readings.
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
  // The model's joints that follow others, which nobody drives, but which commands may name.
  std::vector<std::string> followers{};
};

// The firmware of a robot with driven wheels: commands say how fast the robot is to go.
struct WheelDriveSpec {
  WheelBase base;
  std::size_t left = 1;       // of the joints, so many, the first, are wheels on the left
  double most_radps = 0;      // of any wheel
  VirtualDuration timeout{};  // the robot stops after so long without a command; 0: never
};

// Joints that a channel drives, and with what.
struct JointDriveSpec {
  JointGroup group;
  JointQuantity quantity = JointQuantity::kEffort;  // the quantity of a number without a name
  std::vector<JointGains> gains;                    // of each joint
  std::vector<JointLimits> limits{};                // likewise: wanted values are kept within them
  VirtualDuration lag{};                            // Joint::drive_lag of all of them
  std::optional<WheelDriveSpec> wheels;             // which the joints are, or
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
  MeasurementErrors measurement_errors{};  // of the instrument; the rest is in `errors`
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

// A channel of wrenches for `body`, applied at the virtual time of the send plus `latency`.
struct CommandChannelSpec {
  std::string name;
  int body = 0;                          // or one of these, of a model:
  std::optional<LinkTarget> link;        // which the commands push
  std::optional<JointDriveSpec> joints;  // which the commands drive
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
  std::optional<HostDuration> patience;  // none: by why the run has to be patient (patience.h)
  std::uint64_t seed = 1;
  std::optional<WorldSpec> world;                 // none: no dynamics
  std::map<std::string, std::string> urdf_files;  // of the models that come from such files
  // For these models, what xacro has made of the file, where it has.
  std::map<std::string, std::string> urdf_expanded;
  // For these models, the folders in `packages` that their meshes' packages may be in.
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
  std::vector<MetricSpec> metrics;        // the metrics that measure the run
  std::vector<ExpectationSpec> expectations;
  std::size_t not_judged = 0;            // how many more expectations begin after the end asked for
  std::vector<MetricSpec> kept;          // what some expectations are of, by their number
  std::vector<QuantitySpec> quantities;  // that `metrics` and `kept` are of
  // Things that can be run and are hardly what was meant: a sentence each, with its place.
  std::vector<std::string> warnings;
  // What a warning says of one thing, said of each such thing: for `tcsim check -v`.
  std::vector<std::string> details;
};

}  // namespace tcs
