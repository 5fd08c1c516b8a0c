// The functions of Cyclone DDS (libddsc) that the shim stands before.
//
// The shim (entry.cc) exports them all. A process whose DDS goes by endpoints has hooks for them in
// libtcs_dds.so; all other processes are led straight to libddsc. A hook that libtcs_dds.so does
// not have is libddsc's own function as well.
#pragma once

// The calls that may be a program's first: DDS by endpoints starts at them. ROS 2's middleware
// makes guard conditions and waitsets before any domain, and Cyclone seeds its instance numbers
// there.
#define TCS_DDS_STARTING_CALLS(X) \
  X(dds_create_guardcondition)    \
  X(dds_create_waitset)           \
  X(dds_create_participant)       \
  X(dds_create_domain)            \
  X(dds_create_domain_with_rawconfig)

// The calls that make, change and end what other processes see. The ones that begin with ddsi_ and
// rtps_ are libddsc's own inner seams: libddsc calls them through its PLT.
#define TCS_DDS_CHANGING_CALLS(X)          \
  X(dds_create_topic_impl)                 \
  X(dds_create_writer)                     \
  X(dds_delete)                            \
  X(dds_assert_liveliness)                 \
  X(dds_lookup_participant)                \
  X(dds_get_children)                      \
  X(dds_find_topic)                        \
  X(dds_find_topic_scoped)                 \
  X(dds_create_topic_descriptor)           \
  X(dds_get_typeobj)                       \
  X(dds_entity_pin)                        \
  X(dds_reader_data_available_cb)          \
  X(ddsi_new_participant)                  \
  X(ddsi_delete_participant)               \
  X(ddsi_update_participant_plist)         \
  X(ddsi_new_writer)                       \
  X(ddsi_delete_writer)                    \
  X(ddsi_update_writer_qos)                \
  X(ddsi_new_reader)                       \
  X(ddsi_delete_reader)                    \
  X(ddsi_update_reader_qos)                \
  X(ddsi_new_topic)                        \
  X(ddsi_update_topic_qos)                 \
  X(ddsi_delete_topic)                     \
  X(ddsi_set_deafmute)                     \
  X(ddsi_delete_proxy_participant_by_guid) \
  X(ddsi_iid_gen)                          \
  X(ddsrt_prng_makeseed)                   \
  X(rtps_config_prep)

// The calls that look at what has come.
#define TCS_DDS_READING_CALLS(X)               \
  X(dds_read)                                  \
  X(dds_read_wl)                               \
  X(dds_read_mask)                             \
  X(dds_read_mask_wl)                          \
  X(dds_read_instance)                         \
  X(dds_read_instance_wl)                      \
  X(dds_read_instance_mask)                    \
  X(dds_read_instance_mask_wl)                 \
  X(dds_read_next)                             \
  X(dds_read_next_wl)                          \
  X(dds_readcdr)                               \
  X(dds_readcdr_instance)                      \
  X(dds_take)                                  \
  X(dds_take_wl)                               \
  X(dds_take_mask)                             \
  X(dds_take_mask_wl)                          \
  X(dds_take_instance)                         \
  X(dds_take_instance_wl)                      \
  X(dds_take_instance_mask)                    \
  X(dds_take_instance_mask_wl)                 \
  X(dds_take_next)                             \
  X(dds_take_next_wl)                          \
  X(dds_takecdr)                               \
  X(dds_takecdr_instance)                      \
  X(dds_waitset_wait)                          \
  X(dds_waitset_wait_until)                    \
  X(dds_triggered)                             \
  X(dds_read_status)                           \
  X(dds_take_status)                           \
  X(dds_get_status_changes)                    \
  X(dds_get_inconsistent_topic_status)         \
  X(dds_get_publication_matched_status)        \
  X(dds_get_liveliness_lost_status)            \
  X(dds_get_offered_deadline_missed_status)    \
  X(dds_get_offered_incompatible_qos_status)   \
  X(dds_get_subscription_matched_status)       \
  X(dds_get_liveliness_changed_status)         \
  X(dds_get_sample_rejected_status)            \
  X(dds_get_sample_lost_status)                \
  X(dds_get_requested_deadline_missed_status)  \
  X(dds_get_requested_incompatible_qos_status) \
  X(dds_lookup_instance)                       \
  X(dds_instance_lookup)                       \
  X(dds_get_matched_subscriptions)             \
  X(dds_get_matched_subscription_data)         \
  X(dds_get_matched_publications)              \
  X(dds_get_matched_publication_data)          \
  X(dds_wait_for_acks)                         \
  X(dds_reader_wait_for_historical_data)

// The calls that write, by the entity that is their first argument.
#define TCS_DDS_WRITING_CALLS(X) \
  X(dds_write)                   \
  X(dds_write_ts)                \
  X(dds_writecdr)                \
  X(dds_forwardcdr)              \
  X(dds_writedispose)            \
  X(dds_writedispose_ts)         \
  X(dds_dispose)                 \
  X(dds_dispose_ts)              \
  X(dds_dispose_ih)              \
  X(dds_dispose_ih_ts)           \
  X(dds_unregister_instance)     \
  X(dds_unregister_instance_ts)  \
  X(dds_unregister_instance_ih)  \
  X(dds_unregister_instance_ih_ts)

#define TCS_DDS_CALLS(X)    \
  TCS_DDS_STARTING_CALLS(X) \
  TCS_DDS_CHANGING_CALLS(X) \
  TCS_DDS_READING_CALLS(X)  \
  TCS_DDS_WRITING_CALLS(X)

namespace tcs::dds {

enum Call : unsigned {
#define TCS_DDS_INDEX(name) kCall_##name,
  TCS_DDS_CALLS(TCS_DDS_INDEX)
#undef TCS_DDS_INDEX
      kCalls
};

}  // namespace tcs::dds
