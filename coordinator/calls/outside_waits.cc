#include "coordinator/calls/outside_waits.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "coordinator/os/open_files.h"
#include "coordinator/os/socket_tables.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/remote_descriptor.h"

namespace tcs {

namespace {

// Other leaves may pass by so much the time that real time stands for: their turns would be as
// short as the real time between two looks otherwise.
constexpr VirtualDuration kGrain = VirtualDuration::Microseconds(100);

// From when something has been found to when its time is taken.
constexpr VirtualDuration kFound = VirtualDuration::Microseconds(20);

// Drivers have many calls that wait for a moment: for each other, or for a lock.
constexpr HostDuration kShortCall = HostDuration::Microseconds(100);

// Of raw connections that are never found.
constexpr std::size_t kMostRawConnects = 64;

// How long ago a program may say that something happened. A longer time is not believed.
constexpr HostDuration kLongestNews = HostDuration::Seconds(1);

VirtualDuration Passed(HostDuration real, double speed) {
  return VirtualNs(std::llround(static_cast<double>(real.ns()) * speed));
}

bool HasInput(int fd) {
  pollfd probe{fd, POLLIN, 0};
  return poll(&probe, 1, 0) > 0;
}

bool IsBeingConnected(int fd) {
  std::uint8_t state = TCP_CLOSE;
  socklen_t size = sizeof state;
  return getsockopt(fd, IPPROTO_TCP, TCP_INFO, &state, &size) == 0 && state == TCP_SYN_SENT;
}

double SpeedOf(const Process& process) { return process.robot->outside_speed; }

const ClientSpec& SpecOf(const Process& process) {
  static const ClientSpec kOrdinary;
  const Process* client = process.client;
  return client != nullptr && client->spec != nullptr ? *client->spec : kOrdinary;
}

bool IsNamed(const Process& process, const std::string& name) {
  const std::vector<std::string>& names = SpecOf(process).outside.names;
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void OutsideWaits::PublishIn(shm::OutsideFiles& files) {
  // Under callback the world stands while a program waits.
  if (run_.IsCallback()) return;
  published_ = &files;
  for (const RobotSpec& robot : run_.scenario.robots) {
    for (const ClientSpec& client : robot.clients) {
      for (const std::string& name : client.outside.names) {
        struct stat status;
        // A socket is known by the peer that it reaches (Connects).
        if (!name.starts_with('/') || stat(name.c_str(), &status) != 0) continue;
        if (!S_ISSOCK(status.st_mode)) Publish(shm::OutsideKeyOf(status), name, true, nullptr);
      }
    }
  }
}

OutsideWaits::File* OutsideWaits::Find(std::uint64_t key) {
  const auto found = std::find_if(files_.begin(), files_.end(),
                                  [key](const File& file) { return file.key == key; });
  return found == files_.end() ? nullptr : &*found;
}

OutsideWaits::File* OutsideWaits::FileOf(int fd) {
  struct stat status;
  if (files_.empty() || fstat(fd, &status) != 0) return nullptr;
  return Find(shm::OutsideKeyOf(status));
}

bool OutsideWaits::MayMeetOutside(const Process& process) const {
  return std::any_of(files_.begin(), files_.end(), [&](const File& file) {
    if (shm::IsOutsideCall(file.key)) return false;
    const bool may_wait = file.process == nullptr || file.process->client == process.client;
    return file.state != State::kIdle || (file.is_always && may_wait);
  });
}

// A free entry: one whose file is gone, or a new one; or else the entry of a program that has
// ended, or of a socket on which nothing is asked. Null: there is none.
OutsideWaits::File* OutsideWaits::FreeFile() {
  const auto find = [this](auto is_free) {
    const auto found = std::find_if(files_.begin(), files_.end(), is_free);
    return found == files_.end() ? nullptr : &*found;
  };
  if (File* gone = find([](const File& file) { return file.key == 0; })) return gone;
  const std::uint32_t used = published_->used.load();
  if (used < shm::OutsideFiles::kPlaces) {
    files_.emplace_back().place = &published_->places[used];
    published_->used.store(used + 1);
    return &files_.back();
  }
  File* left = find([](const File& file) {
    return file.process != nullptr && file.process->dead && !file.is_awaited;
  });
  if (left != nullptr) return left;
  return find([](const File& file) {
    return (file.state == State::kIdle || file.state == State::kShown) && !file.is_always;
  });
}

// Null: there is no room, and the file is as any other.
OutsideWaits::File* OutsideWaits::Publish(std::uint64_t key, std::string name, bool is_always,
                                          const Process* process) {
  if (File* known = Find(key); known != nullptr) return known;
  File* file = FreeFile();
  if (file == nullptr) return nullptr;
  auto* const place = file->place;
  place->key.store(0);
  *file = File{};
  file->place = place;
  file->key = key;
  file->name = std::move(name);
  file->is_always = is_always;
  file->process = process;
  ShowFrom(*file, is_always ? shm::kOutsideRests : 0);
  place->key.store(key);
  return file;
}

void OutsideWaits::ShowFrom(File& file, std::int64_t ns) {
  file.place->is_connecting.store(file.is_connecting ? 1 : 0);
  file.shown_from_ns = ns;
  file.place->seen_from_ns.store(file.is_bare ? 0 : ns);
}

void OutsideWaits::SetBare(File& file, bool is_bare) {
  if (std::exchange(file.is_bare, is_bare) != is_bare) ShowFrom(file, file.shown_from_ns);
}

OutsideWaits::Next OutsideWaits::Handle(Task& task, const shm::Notification& note) {
  if (published_ == nullptr) return Next::kGoesOn;
  const auto event = static_cast<shm::OutsideEvent>(note.args[0]);
  if (event == shm::OutsideEvent::kReturns) {
    CallReturns(task, task.reached);
    return Next::kGoesOn;
  }
  const UniqueFd copy = CopyOfDescriptor(*task.process, static_cast<int>(note.args[1]));
  if (!copy) return Next::kGoesOn;
  const HostDuration ago = SinceTsc(static_cast<std::uint64_t>(note.args[2]));
  if (event == shm::OutsideEvent::kConnects) {
    if (PublishDevice(task, copy.get())) return Next::kGoesOn;
    File* file = nullptr;
    if (Connects(task, copy.get(), &file) != Reached::kOutside) return Next::kGoesOn;
    const bool is_going_on = note.args[3] != 0;
    if (!is_going_on && file->is_connecting) Rest(*file);
    return is_going_on && BeginsToConnect(*file, task, ago) ? Next::kHasAsked : Next::kGoesOn;
  }
  if (event == shm::OutsideEvent::kLooks) {
    BeginsWait(task, copy.get(), EPOLLIN);
    return Next::kHolds;
  }
  File* file = FileOf(copy.get());
  if (file == nullptr) return Next::kGoesOn;
  switch (event) {
    case shm::OutsideEvent::kAsks:
      return Asks(*file, task, {copy.get(), ago, note.args[3] != 0}) ? Next::kHasAsked
                                                                     : Next::kGoesOn;
    case shm::OutsideEvent::kTakes:
      file->has_outlasted = false;
      Rest(*file);
      if (HasInput(copy.get())) ShowRest(*file);
      break;
    case shm::OutsideEvent::kCloses:
      Closes(copy.get());
      break;
    case shm::OutsideEvent::kConnects:
    case shm::OutsideEvent::kLooks:
    case shm::OutsideEvent::kReturns:
      break;
  }
  return Next::kGoesOn;
}

bool OutsideWaits::Asks(File& file, const Task& task, const Asking& asking) {
  // No thread looked before the socket was connected.
  if (file.is_connecting && !IsBeingConnected(asking.fd)) Rest(file);
  // Input that is still to be taken is no answer to this request, and stays to be seen.
  if (file.state != State::kIdle || file.is_always || file.has_outlasted) return false;
  if (asking.has_input) return false;
  Ask(file, task, asking.ago);
  return true;
}

bool OutsideWaits::AsksRaw(const Task& task, int fd) {
  LookAtRawConnects(task);
  File* file = FileOf(fd);
  if (file == nullptr) return false;
  // No notification tells of input that was taken by a raw call.
  const bool has_input = HasInput(fd);
  if (file->state == State::kShown && !has_input) Rest(*file);
  return Asks(*file, task, {fd, HostDuration(), has_input});
}

void OutsideWaits::ConnectsRaw(const Task& task, int number, int fd) {
  struct stat status;
  if (published_ == nullptr || fstat(fd, &status) != 0 || !S_ISSOCK(status.st_mode)) return;
  if (raw_connects_.size() >= kMostRawConnects) raw_connects_.pop_front();
  raw_connects_.push_back({task.process, number, shm::OutsideKeyOf(status)});
}

// The kernel carries raw connects out meanwhile. A connect that it has refused is found when the
// socket is closed.
void OutsideWaits::LookAtRawConnects(const Task& task) {
  if (raw_connects_.empty()) return;
  std::erase_if(raw_connects_, [&](const RawConnect& connect) {
    if (connect.process->dead) return true;
    if (connect.process != task.process) return false;
    const UniqueFd copy = CopyOfDescriptor(*task.process, connect.number);
    struct stat status;
    const bool is_there =
        copy && fstat(copy.get(), &status) == 0 && shm::OutsideKeyOf(status) == connect.socket;
    if (!is_there) return true;
    File* file = nullptr;
    const Reached reached = Connects(task, copy.get(), &file);
    if (reached == Reached::kOutside && IsBeingConnected(copy.get())) {
      BeginsToConnect(*file, task, HostDuration());
    }
    return reached != Reached::kNobody;
  });
}

// Shows the rest of the input of which some has been taken.
void OutsideWaits::ShowRest(File& file) {
  file.state = State::kShown;
  ShowFrom(file, 0);
}

// False: the file is no device.
bool OutsideWaits::PublishDevice(const Task& task, int fd) {
  struct stat status;
  if (fstat(fd, &status) != 0 || !S_ISCHR(status.st_mode)) return false;
  std::error_code unreadable;
  const auto path = std::filesystem::read_symlink(fmt::format("/proc/self/fd/{}", fd), unreadable);
  Publish(shm::OutsideKeyOf(status), path.string(), true, task.process);
  return true;
}

OutsideWaits::Reached OutsideWaits::Connects(const Task& task, int fd, File** file) {
  struct stat status;
  if (fstat(fd, &status) != 0) return Reached::kNobody;
  const std::optional<Peers::Peer> peer = peers_.Of(*task.process, fd);
  if (!peer.has_value()) return Reached::kNobody;
  const bool is_named = IsNamed(*task.process, peer->name);
  if (!peer->is_outside && !is_named) return Reached::kRun;
  *file = Publish(shm::OutsideKeyOf(status), peer->name, is_named, task.process);
  return *file == nullptr ? Reached::kRun : Reached::kOutside;
}

bool OutsideWaits::BeginsToConnect(File& file, const Task& task, HostDuration ago) {
  if (file.is_connecting && file.state == State::kAsked) return false;
  Rest(file);
  file.is_connecting = true;
  file.has_outlasted = false;
  Ask(file, task, ago);
  return true;
}

// Other descriptors of the same file may be left, here and in other processes of the run.
void OutsideWaits::Closes(int fd) {
  File* file = FileOf(fd);
  struct stat status;
  if (file == nullptr || (file->key & shm::kOutsideSocket) == 0 || fstat(fd, &status) != 0) return;
  int left = 0;
  for (const Process& process : run_.table.processes()) {
    if (!process.dead) left += DescriptorsOfSocket(process.pid, status.st_ino);
  }
  if (left > 1) return;
  Rest(*file);
  ShowFrom(*file, 0);
  file->place->key.store(0);
  file->key = 0;
}

// The peer has been at work since the program began to send, however late this process hears of it.
HostDuration OutsideWaits::SinceTsc(std::uint64_t tsc) const {
  const std::uint64_t now = HostTsc();
  if (tsc > now) return {};
  const double passed_ns = static_cast<double>(now - tsc) / run_.ticks_per_ns;
  return std::min(kLongestNews, HostNs(std::llround(std::min(passed_ns, 1e18))));
}

void OutsideWaits::Ask(File& file, const Task& task, HostDuration ago) {
  file.state = State::kAsked;
  file.process = task.process;
  file.asked_at = task.reached;
  file.asked_real = clock_() - ago;
  ShowFrom(file, shm::kOutsideUnknown);
}

// Calls `take` with the file of which `fd` is a copy, or with each file in the epoll set of which
// `fd` is a copy, and with a copy of the file's descriptor.
template <class Take>
void OutsideWaits::ForEachAt(const Task& task, int fd, Take take) {
  struct stat status;
  if (files_.empty() || fstat(fd, &status) != 0) return;
  const bool may_be_set = (status.st_mode & S_IFMT) == 0;
  if (!may_be_set) {
    if (File* file = Find(shm::OutsideKeyOf(status)); file != nullptr) {
      SetBare(*file, false);
      take(*file, fd);
    }
    return;
  }
  if (!MayMeetOutside(*task.process)) return;
  for (const EpollEntry& entry : EntriesOf(fd)) {
    const UniqueFd copy = CopyOfDescriptor(*task.process, entry.fd);
    File* file = copy ? FileOf(copy.get()) : nullptr;
    if (file == nullptr) continue;
    // A thread that is told of room, too, is told of input and room at once.
    constexpr std::uint32_t kBoth = EPOLLIN | EPOLLOUT;
    const bool tells_of_both = (entry.events & kBoth) == kBoth && !file->is_connecting;
    SetBare(*file, tells_of_both);
    take(*file, copy.get());
  }
}

OutsideWaits::Hidden OutsideWaits::BeginsWait(const Task& task, int fd, std::uint32_t events) {
  if (events == 0) return Hidden::kNothing;
  LookAtRawConnects(task);
  Hidden hidden = Hidden::kNothing;
  ForEachAt(task, fd, [&](File& file, int copy) {
    if ((events & EPOLLIN) == 0 && !file.is_connecting) return;
    Await(file, task, copy);
    if (!IsHidden(file, task.reached)) return;
    hidden = std::max(hidden, file.is_connecting ? Hidden::kAll : Hidden::kInput);
  });
  return hidden;
}

bool OutsideWaits::Hides(const Task& task, int fd) {
  bool hides = false;
  ForEachAt(task, fd, [&](const File& file, int) { hides |= IsHidden(file, task.reached); });
  return hides;
}

bool OutsideWaits::IsHidden(const File& file, VirtualTime at) {
  if (file.is_bare) return false;
  return file.state == State::kAsked || (file.state == State::kCame && file.seen_from > at);
}

bool OutsideWaits::IsHidden(int fd, VirtualTime at) {
  const File* file = FileOf(fd);
  return file != nullptr && IsHidden(*file, at);
}

void OutsideWaits::Await(File& file, const Task& task, int fd) {
  if (file.has_outlasted) return;
  const bool begins = file.state == State::kIdle || file.state == State::kShown;
  if (begins && file.is_always) Ask(file, task);
  if (file.state != State::kAsked || file.is_awaited) return;
  file.copy.Reset(fcntl(fd, F_DUPFD_CLOEXEC, 0));
  file.number = ++watches_ & Subject::kNumberMask;
  const auto index = static_cast<std::uint32_t>(
      file.place - static_cast<shm::OutsideFiles::Place*>(published_->places));
  const std::uint32_t answers =
      file.is_connecting ? std::uint32_t{EPOLLOUT} : EPOLLIN | EPOLLPRI | EPOLLRDHUP;
  const bool is_watched = file.copy && reactor_.Add(file.copy.get(), answers | EPOLLONESHOT,
                                                    {Tag::kOutside, index, file.number});
  if (!is_watched) {
    // A file that cannot be polled gives nothing to wait for.
    Rest(file);
    file.has_outlasted = true;
    ShowFrom(file, 0);
    return;
  }
  file.is_awaited = true;
  ++awaited_;
}

// Each thread's call is waited for on its own, as if it were a file.
OutsideWaits::InCall OutsideWaits::LookIntoCall(const Task& task, HostDuration used) {
  if (published_ == nullptr || files_.empty()) return InCall::kNo;
  const std::optional<int> number = DescriptorOfIoctl(task.tid);
  const UniqueFd copy = number.has_value() ? CopyOfDescriptor(*task.process, *number) : UniqueFd();
  const File* device = copy ? FileOf(copy.get()) : nullptr;
  if (device == nullptr || !device->is_always) return InCall::kNo;
  File* call = Publish(shm::OutsideCallKey(task.tid), device->name, false, task.process);
  if (call == nullptr) return InCall::kNo;
  if (call->state == State::kAsked) return InCall::kWaits;
  const HostTime now = clock_();
  if (std::exchange(call->used, used) != used) call->asked_real = now;
  const HostDuration so_far = now - call->asked_real;
  if (so_far < kShortCall) return InCall::kMayWait;
  call->has_outlasted = false;
  Ask(*call, task, so_far);
  call->begins = true;
  if (!std::exchange(call->is_awaited, true)) ++awaited_;
  return InCall::kWaits;
}

void OutsideWaits::CallBegan(const Task& task) {
  if (files_.empty()) return;
  File* call = Find(shm::OutsideCallKey(task.tid));
  if (call != nullptr && std::exchange(call->begins, false)) call->asked_at = task.reached;
}

void OutsideWaits::CallReturns(const Task& task, VirtualTime at) {
  File* call = files_.empty() ? nullptr : Find(shm::OutsideCallKey(task.tid));
  if (call == nullptr || call->state != State::kAsked || !call->is_awaited) return;
  HasCome(*call, clock_(), at);
}

void OutsideWaits::Unwatch(File& file) {
  if (file.copy) reactor_.Remove(file.copy.get());
  file.copy.Reset();
}

// Nothing is waited for at the file any more.
void OutsideWaits::Rest(File& file) {
  Unwatch(file);
  has_rested_ |= file.state == State::kAsked || file.state == State::kCame;
  if (std::exchange(file.is_awaited, false)) --awaited_;
  file.state = State::kIdle;
  file.is_connecting = false;
  ShowFrom(file, file.is_always && !file.has_outlasted ? shm::kOutsideRests : 0);
}

void OutsideWaits::HasCome(const Subject& subject, HostTime now, VirtualTime at) {
  if (subject.index >= files_.size()) return;
  File& file = files_[subject.index];
  if (file.state != State::kAsked || !file.is_awaited || file.number != subject.number) return;
  HasCome(file, now, at);
}

void OutsideWaits::HasCome(File& file, HostTime now, VirtualTime at) {
  Unwatch(file);
  const VirtualDuration took = run_.IsFixed()
                                   ? SpecOf(*file.process).outside.takes
                                   : Passed(now - file.asked_real, SpeedOf(*file.process));
  file.state = State::kCame;
  file.seen_from = file.asked_at + took;
  // The answer was found at `at`; the rest is how long it took to find it.
  if (!run_.IsFixed() && file.seen_from > at && file.seen_from - at < kFound) file.seen_from = at;
  ShowFrom(file, std::max<std::int64_t>(file.seen_from.ns(), 1));
  if (Process* client = file.process->client; client != nullptr) {
    ++client->outside.answers;
    client->outside.waited += took;
  }
}

VirtualTime OutsideWaits::DueOf(const File& file, HostTime now) const {
  if (file.state == State::kCame) return file.seen_from;
  if (file.state != State::kAsked || !file.is_awaited) return VirtualTime::Never();
  if (run_.IsFixed()) return file.asked_at + SpecOf(*file.process).outside.takes;
  return file.asked_at + Passed(now - file.asked_real, SpeedOf(*file.process));
}

VirtualTime OutsideWaits::At(HostTime now) const {
  VirtualTime at = VirtualTime::Never();
  for (const File& file : files_) at = std::min(at, DueOf(file, now));
  return at;
}

VirtualTime OutsideWaits::Due(HostTime now) const {
  VirtualTime due = VirtualTime::Never();
  for (const File& file : files_) {
    VirtualTime its = DueOf(file, now);
    if (file.state == State::kAsked && !run_.IsFixed()) its = AtMostNever(its, kGrain);
    due = std::min(due, its);
  }
  return due;
}

HostDuration OutsideWaits::RealTimeUntil(VirtualTime until, HostTime now) const {
  HostDuration longest;
  for (const File& file : files_) {
    if (file.state != State::kAsked || !file.is_awaited) continue;
    const VirtualDuration left = until - std::min(until, DueOf(file, now));
    const double real_ns = static_cast<double>(left.ns()) / SpeedOf(*file.process);
    longest = std::max(longest, HostNs(std::llround(std::min(real_ns, 1e18))));
  }
  return longest;
}

void OutsideWaits::GiveUp(File& file) {
  const ClientSpec& spec = SpecOf(*file.process);
  run_.Warn(fmt::format(
      "{} has waited {:g} s, of real time, for {}, which is outside of the run; it is not waited "
      "for "
      "any more until something comes from there (its `outside: {{patience: TIME}}` sets how long)",
      file.process->name, spec.outside.patience.seconds(), file.name));
  file.has_outlasted = true;
  Rest(file);
}

// Whether the entry is a call whose thread has ended.
bool OutsideWaits::HasEnded(const File& file) const {
  return shm::IsOutsideCall(file.key) &&
         run_.table.Living(static_cast<pid_t>(file.key & ~shm::kOutsideCall)) == nullptr;
}

bool OutsideWaits::Show(VirtualTime at, HostTime now) {
  bool has_shown = false;
  for (File& file : files_) {
    if (file.state == State::kCame && file.seen_from <= at) {
      if (file.is_connecting || shm::IsOutsideCall(file.key)) {
        // There is nothing to be taken.
        Rest(file);
      } else {
        file.state = State::kShown;
        if (std::exchange(file.is_awaited, false)) --awaited_;
      }
      has_shown = true;
    } else if (file.state == State::kAsked && file.is_awaited) {
      const bool is_over = now - file.asked_real > SpecOf(*file.process).outside.patience;
      if (file.process->dead || HasEnded(file)) {
        Rest(file);
      } else if (is_over) {
        GiveUp(file);
      } else {
        continue;
      }
      has_shown = true;
    }
  }
  return has_shown;
}

}  // namespace tcs
