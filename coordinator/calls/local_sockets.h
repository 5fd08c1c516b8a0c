// Which sockets only programs of one robot send to, for as long as that is so
// (shm/local_sockets.h).
//
// For the coordinator's thread only. The coordinator does not check what clients say of their
// sockets: a name that two robots claim belongs to neither, a socket is looked up by its own robot
// only, and a client that lies about its own sockets harms itself only.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"
#include "shm/local_sockets.h"

namespace tcs {

class LocalSockets {
 public:
  explicit LocalSockets(RunState& run) : run_(run) {}
  LocalSockets(const LocalSockets&) = delete;
  LocalSockets& operator=(const LocalSockets&) = delete;

  // Publishes the sockets in memory that all clients see, and that outlives this.
  void PublishIn(shm::LocalSockets& sockets) { sockets_ = &sockets; }

  // A program of the robot is about to bind that socket to a name.
  void Binds(const Robot& robot, std::uint64_t cookie, std::uint64_t name);
  // A thread of the robot (null: the robot is not known) is about to bind a socket in a call that
  // the shim does not see. What the thread does with the socket is not known, and if the name was
  // some robot's nothing is local to that robot any more.
  void BindsUnseen(const Robot* robot, const TrappedCall& call);
  // The thread is about to reach the robot of that number: nothing is local to that robot any more,
  // and the thread has come no less far than that robot has looked by now. A number that no robot
  // has is ignored.
  void Reaches(Task& task, std::uint32_t number);
  // The same for a call that the kernel is to carry out, if the call reaches a robot.
  void ReachesBy(Task& task, const TrappedCall& call);

 private:
  bool Claim(shm::RobotByNumber& table, std::size_t* count, std::uint64_t number,
             const Robot& robot);
  void TakeOut(std::uint32_t number);
  void ReachesAll(Task& task);
  std::uint32_t OwnerOf(const Robot& robot, pid_t pid, std::uint64_t address,
                        std::uint64_t size) const;
  void ReachesByAddress(Task& task, std::uint64_t address, std::uint64_t size);
  void ReachesByMessage(Task& task, std::uint64_t message);

  RunState& run_;
  shm::LocalSockets* sockets_ = nullptr;
  std::size_t cookies_ = 0, names_ = 0;  // entries that have a place
};

}  // namespace tcs
