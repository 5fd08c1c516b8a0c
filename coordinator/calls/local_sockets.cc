#include "coordinator/calls/local_sockets.h"

#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>

#include <algorithm>

namespace tcs {

namespace {

constexpr std::uint64_t kMostMessages = 1024;  // of one sendmmsg: the kernel sends no more

}  // namespace

// False where there is no room, and where the number is another robot's, to which nothing is local
// then.
bool LocalSockets::Claim(shm::RobotByNumber& table, std::size_t* count, std::uint64_t number,
                         const Robot& robot) {
  shm::RobotByNumber::Place* place = shm::PlaceOf(table, number);
  if (place == nullptr) return false;
  if (place->number.load() == 0) {
    if (*count == shm::RobotByNumber::kMost) return false;
    ++*count;
    place->robot.store(robot.number, std::memory_order_relaxed);
    place->number.store(number, std::memory_order_release);
    return true;
  }
  const std::uint32_t owner = place->robot.load();
  if (owner == robot.number) return true;
  if (owner == shm::kNoRobot) {
    place->robot.store(robot.number);
    return true;
  }
  TakeOut(owner);
  return false;
}

void LocalSockets::Binds(const Robot& robot, std::uint64_t cookie, std::uint64_t name) {
  if (robot.is_reached || cookie == 0 || name == 0) return;
  // The name comes first: a receiver that looks without waiting must be found by the threads that
  // send.
  if (Claim(sockets_->by_name, &names_, name, robot)) {
    Claim(sockets_->by_cookie, &cookies_, cookie, robot);
  } else {
    TakeOut(robot.number);
  }
}

void LocalSockets::BindsUnseen(const Robot* robot, const TrappedCall& call) {
  for (const Robot& each : run_.robots) {
    if (robot != nullptr && robot != &each) continue;
    const std::uint32_t owner =
        OwnerOf(each, call.tid, call.args[1], static_cast<std::uint32_t>(call.args[2]));
    if (owner != shm::kNoRobot) TakeOut(owner);
  }
}

void LocalSockets::TakeOut(std::uint32_t number) {
  run_.robots[number - shm::kFirstRobot].is_reached = true;
  for (shm::RobotByNumber* table : {&sockets_->by_cookie, &sockets_->by_name}) {
    for (shm::RobotByNumber::Place& place : table->places) {
      if (place.robot.load(std::memory_order_relaxed) == number) place.robot.store(shm::kNoRobot);
    }
  }
}

void LocalSockets::Reaches(Task& task, std::uint32_t number) {
  if (run_.IsCallback() || number < shm::kFirstRobot || number > run_.robots.size()) return;
  const Robot& robot = run_.robots[number - shm::kFirstRobot];
  if (robot.is_reached) return;
  TakeOut(number);
  task.ComeTo(std::max(task.reached, robot.Furthest()));
}

// Whose descriptor the thread takes is not looked at.
void LocalSockets::ReachesAll(Task& task) {
  for (const Robot& robot : run_.robots) Reaches(task, robot.number);
}

// The owner of the name at that address of the memory of a process of the robot.
std::uint32_t LocalSockets::OwnerOf(const Robot& robot, pid_t pid, std::uint64_t address,
                                    std::uint64_t size) const {
  sockaddr_un name{};
  if (address == 0 || size > sizeof name ||
      !ReadMemory(pid, address, &name, static_cast<std::size_t>(size))) {
    return shm::kNoRobot;
  }
  const std::uint64_t number =
      shm::NumberOfName(shm::HashOfName(&name, static_cast<std::size_t>(size)), robot.number,
                        run_.header->names_by_robot != 0);
  return number == 0 ? shm::kNoRobot : shm::RobotOf(sockets_->by_name, number);
}

void LocalSockets::ReachesByAddress(Task& task, std::uint64_t address, std::uint64_t size) {
  const std::uint32_t owner = OwnerOf(*task.process->robot, task.process->pid, address, size);
  if (owner != task.process->robot->number) Reaches(task, owner);
}

void LocalSockets::ReachesByMessage(Task& task, std::uint64_t message) {
  msghdr header{};
  if (!ReadMemory(task.process->pid, message, &header, sizeof header)) return;
  ReachesByAddress(task, reinterpret_cast<std::uint64_t>(header.msg_name), header.msg_namelen);
  // The message may have descriptors in it.
  if (header.msg_controllen > 0) Reaches(task, task.process->robot->number);
}

void LocalSockets::ReachesBy(Task& task, const TrappedCall& call) {
  if (names_ == 0) return;
  switch (call.number) {
    case SYS_connect:
      return ReachesByAddress(task, call.args[1], static_cast<std::uint32_t>(call.args[2]));
    case SYS_sendto:
      return ReachesByAddress(task, call.args[4], static_cast<std::uint32_t>(call.args[5]));
    case SYS_sendmsg:
      return ReachesByMessage(task, call.args[1]);
    case SYS_sendmmsg:
      for (std::uint64_t i = 0; i < std::min<std::uint64_t>(call.args[2], kMostMessages); ++i) {
        ReachesByMessage(task, call.args[1] + i * sizeof(mmsghdr));
      }
      return;
    case SYS_pidfd_getfd:
      return ReachesAll(task);
    default:
      return;
  }
}

}  // namespace tcs
