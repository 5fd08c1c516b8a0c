// The definitions that recordings have are those of the messages that are sent.
#include "coordinator/record/message_definitions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "coordinator/dds/message_fields.h"

namespace tcs::record {
namespace {

using dds::RosRelease;
using Fields = std::vector<std::string>;  // "TYPE NAME"

// The fields of a .msg file: what is no constant.
Fields FieldsOf(std::string_view text) {
  Fields fields;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (line.find('=') == std::string::npos) fields.push_back(line);
  }
  return fields;
}

// A type of OMG's IDL as ROS 2's .msg files have it.
std::string RosType(std::string type, const std::string& package) {
  static const std::map<std::string, std::string> kPlain = {
      {"boolean", "bool"},   {"octet", "uint8"},           {"int8", "int8"},
      {"long", "int32"},     {"unsigned short", "uint16"}, {"unsigned long", "uint32"},
      {"double", "float64"}, {"float", "float32"},         {"string", "string"}};
  std::smatch parts;
  if (std::regex_match(type, parts, std::regex("sequence<(.*)>"))) {
    return RosType(parts[1], package) + "[]";
  }
  if (const auto plain = kPlain.find(type); plain != kPlain.end()) return plain->second;
  const std::string name = type.substr(0, type.size() - 1);  // "Pose_"
  if (!std::regex_match(name, parts, std::regex("(\\w+)::msg::dds_::(\\w+)"))) return name;
  const std::string of = parts[1], last = parts[2];
  return of == package ? last : of + '/' + last;
}

// Of each structure of the IDL that messages are serialised by.
std::map<std::string, Fields> SentFields() {
  std::map<std::string, Fields> sent;
  for (const auto& file : std::filesystem::directory_iterator(TCS_MESSAGE_IDL)) {
    if (file.path().extension() != ".idl") continue;
    const std::string package = file.path().stem();
    std::ifstream lines(file.path());
    Fields* fields = nullptr;
    std::smatch parts;
    for (std::string line; std::getline(lines, line);) {
      if (std::regex_match(line, parts, std::regex(" *struct (\\w+)_ \\{"))) {
        fields = &sent[package + '/' + parts[1].str()];
      } else if (std::regex_match(line, parts, std::regex(" *(.*) (\\w+)(\\[\\d+\\])?;"))) {
        fields->push_back(RosType(parts[1], package) + parts[3].str() + ' ' + parts[2].str());
      }
    }
  }
  return sent;
}

TEST(MessageDefinitions, AreThoseOfWhatIsSent) {
  std::map<std::string, Fields> sent = SentFields();
  EXPECT_GT(sent.size(), 30u);
  // What ros_discovery_info is of is not recorded.
  std::erase_if(sent, [](const auto& message) { return message.first.starts_with("rmw_"); });
  std::map<std::string, Fields> defined;
  for (const dds::MessageFields& message : dds::KnownMessages()) {
    EXPECT_TRUE(defined.emplace(message.type, FieldsOf(message.text)).second) << message.type;
  }
  EXPECT_EQ(defined, sent);
}

TEST(MessageDefinitions, HaveTheirPartsBelowEachOnce) {
  const std::string line(80, '=');
  EXPECT_EQ(DefinitionOf("geometry_msgs/msg/Twist", RosRelease::kIron),
            "Vector3 linear\nVector3 angular\n"
            "\n" +
                line + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n");
  EXPECT_EQ(DefinitionOf("rosgraph_msgs/msg/Clock", RosRelease::kIron),
            "builtin_interfaces/Time clock\n"
            "\n" +
                line + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
  const std::string odometry = DefinitionOf("nav_msgs/msg/Odometry", RosRelease::kIron);
  for (const char* part :
       {"Pose", "Point", "Quaternion", "PoseWithCovariance", "Twist", "Vector3"}) {
    const std::string heading = line + "\nMSG: geometry_msgs/" + part + "\n";
    const std::size_t at = odometry.find(heading);
    ASSERT_NE(at, std::string::npos) << part;
    EXPECT_EQ(odometry.find(heading, at + 1), std::string::npos) << part;
  }
}

TEST(MessageDefinitions, AreNotMadeUp) {
  for (const char* type : {"", "/msg/", "std_msgs/Bool", "std_msgs/msg/Int32", "std_msgs/msg/"}) {
    EXPECT_EQ(DefinitionOf(type, RosRelease::kIron), "") << type;
  }
}

TEST(MessageDefinitions, OfARangeHaveAVarianceSinceIron) {
  const std::string humble = DefinitionOf("sensor_msgs/msg/Range", RosRelease::kHumble);
  const std::string iron = DefinitionOf("sensor_msgs/msg/Range", RosRelease::kIron);
  EXPECT_EQ(humble.find("variance"), std::string::npos);
  EXPECT_NE(iron.find("float32 range\nfloat32 variance\n"), std::string::npos);
}

}  // namespace
}  // namespace tcs::record
