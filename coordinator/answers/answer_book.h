// How well clients kept up: fed with what happens, the book says for each client how long it took
// from its release to the end of its work, which deadlines it missed, and how old its data was
// (client_figures.h). Pure. Times are virtual nanoseconds.
//
// An activation is one of tasks/activations.h, but waits in its midst (Pause) do not end it here.
// The release is the time at which the activation's input was there: the expiry of its timer, or
// the arrival of the oldest datagram that the thread took at the activation's beginning, whether or
// not the thread was waiting by then. Activations for other causes (a start, another thread, a
// signal) are not judged. Helper threads are not judged either: a helper is not the first thread of
// its process, takes no samples and sends no commands.
//
// A deadline counts from the release: the client's own, or, for a client that is periodic or whose
// commands reach an actuator, the period of the sensor that released it, or of its timer: the time
// to the next expiry.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/answers/client_figures.h"
#include "coordinator/answers/core_waits.h"
#include "coordinator/answers/response.h"
#include "coordinator/trace/activation_log.h"
#include "shm/receipts.h"

namespace tcs {

class AnswerBook {
 public:
  struct Client {
    std::string name;
    int robot = 0;                 // the robot's number; several clients may share it
    std::int64_t deadline_ns = 0;  // 0: the period, if the client has to keep it
    bool is_periodic = false;
  };
  // The thread to which something happens, and its client.
  struct Who {
    int client = 0;        // the client's place in Open's list
    int thread = -1;       // unique among living threads, without gaps; -1: unknown
    bool is_first = true;  // of its process
  };
  // A datagram that a thread takes.
  struct Taken {
    std::int64_t arrived_ns = 0;
    // When the content was measured: the sample, or the newest one that the sender had taken; -1:
    // not known.
    std::int64_t sampled_ns = -1;
    std::int64_t period_ns = 0;  // of the sensor whose sample this is; 0: no sample
    int sensor = -1;             // the sensor's place in Open's list
    // The activation that the datagram belongs to: 0, the one that goes on; n, the one that the
    // n-th receipt since then began (shm/receipts.h).
    unsigned activation = 0;
  };

  // A wait of a thread in the midst of its work.
  struct Pause {
    enum class For { kLock, kRoom };  // the lock of another thread; room: others take what was sent
    For what = For::kLock;
    int client = -1;  // whose thread has the lock; -1: not known
  };

  // Sensors by the names of their channels.
  void Open(std::vector<Client> clients, std::vector<std::string> sensors);
  // `on_response` is told of each activation by time or input once its deadline is known. Null:
  // nobody is told.
  void Tell(std::function<void(const Response&)> on_response);

  void Took(const Who& who, const Taken& taken);
  // The thread sends something to a place from which actuators are driven.
  void Commanded(const Who& who, std::int64_t at_ns);
  // When the newest sample that the thread can know of was measured; -1: there is none.
  std::int64_t LastSampledOf(int thread) const;
  // The release of the activation that the n-th receipt began at `at_ns`; 0: of the activation that
  // goes on, if a receipt began it before the last stop.
  std::int64_t ReleaseOf(int thread, unsigned receipt, std::int64_t at_ns) const;
  // So many receipts have been told of: the last of them began the activation that goes on now.
  void ForgetReceipts(int thread, unsigned receipts);

  // A thread is ready from then on.
  void Ready(const Who& who, std::int64_t at_ns);
  // A thread of that client had that core of its robot.
  void Ran(const Who& who, int core, std::int64_t start_ns, std::int64_t end_ns);
  // An activation pauses: it goes on once the thread has what it waits for, and is ready. The rest
  // of the activation is told as another one, by a thread.
  void Pauses(const Who& who, const Activation& activation, unsigned receipt, std::int64_t at_ns,
              std::int64_t executed_ns, const Pause& pause);
  // An activation ends, or is cut off by the run's end. The activation began with that receipt, or
  // (0) with the end of a wait.
  void Ended(const Who& who, const Activation& activation, unsigned receipt, std::int64_t end_ns,
             std::int64_t executed_ns);

  void Dies(int thread);
  // The thread waits: a datagram that it takes from now on belongs to its next activation.
  void Idles(int thread);
  // At the run's end the datagram `waiting` is there, and the thread has not taken it.
  void NeverCameTo(const Who& who, const Taken& waiting, std::int64_t end_ns);

  // The run is over, then. By client, as Open was given them; without inputs.
  std::vector<ClientFigures> Conclude(std::int64_t end_ns);

 private:
  // The cause that released an activation, if that is known.
  struct Release {
    std::int64_t at_ns = INT64_MAX;
    std::int64_t period_ns = 0;
    int sensor = -1;
  };
  // The releases of the activation that goes on (0), and of the activations that began with a
  // receipt.
  class Releases {
   public:
    static constexpr std::size_t kMost = shm::Receipts::kMost + 1;
    const Release& operator[](std::size_t receipt) const {
      return by_receipt_[std::min(receipt, kMost - 1)];
    }
    // Of a receipt below kMost.
    Release& At(std::size_t receipt) {
      used_ = std::max(used_, receipt + 1);
      return by_receipt_[receipt];
    }
    void Clear() {
      std::fill_n(by_receipt_.begin(), used_, Release());
      used_ = 0;
    }

   private:
    std::array<Release, kMost> by_receipt_;
    std::size_t used_ = 0;  // no release from there on is known
  };
  // An activation that pauses, or has gone on since.
  struct Begun {
    Response response;  // until the pause
    Release release;
    Pause pause;
  };
  struct Thread {
    int client = 0;
    bool is_first = true, takes_samples = false, commands = false;
    std::int64_t last_sampled_ns = -1;
    Releases releases;
    bool is_by_receipt = false;  // the activation that goes on
    std::int64_t ended_ns = 0;   // the end of the last activation
    std::optional<Begun> begun;
    std::optional<Response> timed;     // to be judged once the next expiry is known
    std::int64_t timer_period_ns = 0;  // between the last two
  };
  // Deadlines that were periods of that.
  struct Source {
    std::int64_t judged = 0;
    // How often each period occurred, to three digits: a late client may leave expiries out.
    std::map<std::int64_t, std::int64_t> periods_ns;
  };
  // The times of an activation.
  struct Times {
    std::int64_t response_ns, start_delay_ns, execution_ns;
  };
  struct Kept {
    Client client;
    ClientFigures figures;
    ActivationTimes judged, others;
    // The times of the latest activations, which are added to the two above hundreds at once.
    std::vector<Times> new_judged, new_others;
    bool has_begun = false;
    std::int64_t in_a_row = 0;
    std::map<int, Source> sources;  // by sensor; kTimer: the client's timer
  };

  Kept& KeptOf(int client) { return clients_[static_cast<std::size_t>(client)]; }
  const Kept& KeptOf(int client) const { return clients_[static_cast<std::size_t>(client)]; }
  CoreWaits::Of OnCores(const Who& who) const;
  Thread& ThreadOf(const Who& who);
  // Null: nothing is known of it.
  Thread* Find(int thread);
  const Thread* Find(int thread) const;
  Response UntilNow(Thread& thread, const Who& who, const Activation& activation,
                    std::int64_t end_ns, std::int64_t executed_ns);
  static void AddCores(const CoreWaits::Times& times, std::int64_t charged_ns, Response& response);
  static void AddPause(const Pause& pause, std::int64_t ns, TimeParts& parts);
  void Add(const ByClient& part, std::map<std::string, std::int64_t>& to) const;
  void NoteWait(Kept& kept, const Response& response) const;
  void HasBegun(int client);
  static void Note(const Response& response, std::vector<Times>& news, ActivationTimes& times);
  static void Count(std::vector<Times>& news, ActivationTimes& times);
  void EndOf(Thread& thread, Response response, const Release& release);
  void EndPaused(Thread& thread, std::int64_t end_ns);
  static std::int64_t PeriodOf(const Source& source);
  void JudgeLast(Thread& thread);
  void Judge(Kept& kept, Response response, std::int64_t period_ns, int source);

  static constexpr int kTimer = -1;

  std::vector<Kept> clients_;
  std::vector<std::string> sensors_;
  std::vector<std::unique_ptr<Thread>> threads_;  // by their numbers; null: nothing is known of it
  CoreWaits cores_;
  std::function<void(const Response&)> on_response_;
};

}  // namespace tcs
