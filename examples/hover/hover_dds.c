// Holds the drone at a point, as hover.py does, with ROS 2's messages over DDS: reads Odometry,
// writes Wrench. An ordinary Cyclone DDS program.
#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>

#include "geometry_msgs.h"
#include "nav_msgs.h"

typedef nav_msgs_msg_dds__Odometry_ Odometry;
typedef geometry_msgs_msg_dds__Wrench_ Wrench;

static const double kGoal[3] = {1.0, 2.0, 3.0};        // m
static const double kStiffness = 4.0, kDamping = 4.0;  // N/m, N*s/m

static dds_entity_t Checked(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  fprintf(stderr, "%s cannot be made: %s\n", what, dds_strretcode(entity));
  exit(1);
}

// The drone does not turn, so that its own frame, which the twist is in, is the world's.
static Wrench Hold(const Odometry* odometry) {
  const geometry_msgs_msg_dds__Point_* at = &odometry->pose.pose.position;
  const geometry_msgs_msg_dds__Vector3_* v = &odometry->twist.twist.linear;
  const Wrench wrench = {.force = {kStiffness * (kGoal[0] - at->x) - kDamping * v->x,
                                   kStiffness * (kGoal[1] - at->y) - kDamping * v->y,
                                   kStiffness * (kGoal[2] - at->z) - kDamping * v->z}};
  return wrench;
}

int main(void) {
  const dds_entity_t domain = Checked(dds_create_participant(0, NULL, NULL), "the participant");
  // ROS 2's /odom is DDS's rt/odom.
  const dds_entity_t odom = Checked(
      dds_create_topic(domain, &nav_msgs_msg_dds__Odometry__desc, "rt/odom", NULL, NULL), "/odom");
  const dds_entity_t wrench_topic = Checked(
      dds_create_topic(domain, &geometry_msgs_msg_dds__Wrench__desc, "rt/wrench", NULL, NULL),
      "/wrench");
  const dds_entity_t reader = Checked(dds_create_reader(domain, odom, NULL, NULL), "the reader");
  const dds_entity_t writer =
      Checked(dds_create_writer(domain, wrench_topic, NULL, NULL), "the writer");
  const dds_entity_t waitset = Checked(dds_create_waitset(domain), "the waitset");
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waitset, reader, 0);
  for (;;) {
    dds_waitset_wait(waitset, NULL, 0, DDS_INFINITY);
    void* sample = NULL;
    dds_sample_info_t info;
    while (dds_take(reader, &sample, &info, 1, 1) == 1) {
      if (info.valid_data) {
        const Wrench wrench = Hold(sample);
        dds_write(writer, &wrench);
      }
      dds_return_loan(reader, &sample, 1);
      sample = NULL;
    }
  }
}
