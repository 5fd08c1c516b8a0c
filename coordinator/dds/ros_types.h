// The generated message types under names that can be read, and how to fill what they point to.
//
// Strings and sequences are Cyclone's memory: Owned frees them with its functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "coordinator/dds/cdr.h"
#include "dds/ddsc/dds_public_alloc.h"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "rmw_dds_common.h"
#include "rmw_dds_common_iron.h"
#include "rosgraph_msgs.h"
#include "sensor_msgs.h"
#include "shm/check.h"
#include "std_msgs.h"
#include "tf2_msgs.h"
#include "trajectory_msgs.h"

namespace tcs::dds {

using TimeMessage = builtin_interfaces_msg_dds__Time_;
using HeaderMessage = std_msgs_msg_dds__Header_;
using Vector3Message = geometry_msgs_msg_dds__Vector3_;
using QuaternionMessage = geometry_msgs_msg_dds__Quaternion_;
using TwistMessage = geometry_msgs_msg_dds__Twist_;
using WrenchMessage = geometry_msgs_msg_dds__Wrench_;
using OdometryMessage = nav_msgs_msg_dds__Odometry_;
using ImuMessage = sensor_msgs_msg_dds__Imu_;
using JointStateMessage = sensor_msgs_msg_dds__JointState_;
using Float64MultiArrayMessage = std_msgs_msg_dds__Float64MultiArray_;
using LaserScanMessage = sensor_msgs_msg_dds__LaserScan_;
using RangeMessage = sensor_msgs_msg_dds__Range_;
using PointCloudMessage = sensor_msgs_msg_dds__PointCloud2_;
using NavSatFixMessage = sensor_msgs_msg_dds__NavSatFix_;
using MagneticFieldMessage = sensor_msgs_msg_dds__MagneticField_;
using FluidPressureMessage = sensor_msgs_msg_dds__FluidPressure_;
using ImageMessage = sensor_msgs_msg_dds__Image_;
using TransformsMessage = tf2_msgs_msg_dds__TFMessage_;
using BoolMessage = std_msgs_msg_dds__Bool_;
using StringMessage = std_msgs_msg_dds__String_;
using JointTrajectoryMessage = trajectory_msgs_msg_dds__JointTrajectory_;
using ClockMessage = rosgraph_msgs_msg_dds__Clock_;
using HumbleParticipantMessage = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
using IronParticipantMessage = rmw_dds_common_iron_msg_dds__ParticipantEntitiesInfo_;

// idlc calls the table of the type X X_desc.
#define TCS_DESCRIBED_BY(Message, Type)                          \
  template <>                                                    \
  inline const dds_topic_descriptor_t& DescriptorOf<Message>() { \
    return Type##_desc;                                          \
  }
TCS_DESCRIBED_BY(HeaderMessage, std_msgs_msg_dds__Header_)
TCS_DESCRIBED_BY(TwistMessage, geometry_msgs_msg_dds__Twist_)
TCS_DESCRIBED_BY(WrenchMessage, geometry_msgs_msg_dds__Wrench_)
TCS_DESCRIBED_BY(OdometryMessage, nav_msgs_msg_dds__Odometry_)
TCS_DESCRIBED_BY(ImuMessage, sensor_msgs_msg_dds__Imu_)
TCS_DESCRIBED_BY(JointStateMessage, sensor_msgs_msg_dds__JointState_)
TCS_DESCRIBED_BY(Float64MultiArrayMessage, std_msgs_msg_dds__Float64MultiArray_)
TCS_DESCRIBED_BY(LaserScanMessage, sensor_msgs_msg_dds__LaserScan_)
TCS_DESCRIBED_BY(RangeMessage, sensor_msgs_msg_dds__Range_)
TCS_DESCRIBED_BY(PointCloudMessage, sensor_msgs_msg_dds__PointCloud2_)
TCS_DESCRIBED_BY(NavSatFixMessage, sensor_msgs_msg_dds__NavSatFix_)
TCS_DESCRIBED_BY(MagneticFieldMessage, sensor_msgs_msg_dds__MagneticField_)
TCS_DESCRIBED_BY(FluidPressureMessage, sensor_msgs_msg_dds__FluidPressure_)
TCS_DESCRIBED_BY(ImageMessage, sensor_msgs_msg_dds__Image_)
TCS_DESCRIBED_BY(TransformsMessage, tf2_msgs_msg_dds__TFMessage_)
TCS_DESCRIBED_BY(BoolMessage, std_msgs_msg_dds__Bool_)
TCS_DESCRIBED_BY(StringMessage, std_msgs_msg_dds__String_)
TCS_DESCRIBED_BY(JointTrajectoryMessage, trajectory_msgs_msg_dds__JointTrajectory_)
TCS_DESCRIBED_BY(ClockMessage, rosgraph_msgs_msg_dds__Clock_)
TCS_DESCRIBED_BY(HumbleParticipantMessage, rmw_dds_common_msg_dds__ParticipantEntitiesInfo_)
TCS_DESCRIBED_BY(IronParticipantMessage, rmw_dds_common_iron_msg_dds__ParticipantEntitiesInfo_)
#undef TCS_DESCRIBED_BY

// A string field's new value; the field must be null.
void SetText(char** field, std::string_view text);

// Makes the null sequence `size` zeroed elements long.
template <class Sequence>
void Resize(Sequence* sequence, std::size_t size) {
  using Element = std::remove_pointer_t<decltype(sequence->_buffer)>;
  TCS_CHECK(sequence->_buffer == nullptr);
  if (size == 0) return;
  sequence->_buffer = static_cast<Element*>(dds_alloc(size * sizeof(Element)));
  std::memset(sequence->_buffer, 0, size * sizeof(Element));
  sequence->_length = sequence->_maximum = static_cast<std::uint32_t>(size);
  sequence->_release = true;
}

}  // namespace tcs::dds
